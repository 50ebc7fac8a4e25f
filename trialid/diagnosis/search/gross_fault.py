"""A fault so large that nothing can be told from a fit without it: an actuator dead, or reversed.

Slopes at such a fit say nothing, so each fault that is bound by its meaning is put into the model
and fitted from where the first fit began, and the one that alone explains the record is named.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.diagnosis.noise.thinning import on_every_sample, with_means
from trialid.diagnosis.search.carried import as_good
from trialid.diagnosis.search.carry_over import carried_between
from trialid.diagnosis.search.refit import Refit, first_model, settings_with
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.search.together import Together
from trialid.errors import StepsTooLong, TrialidError
from trialid.identification.adequacy import why_no_fit
from trialid.identification.fit import Fit, identify
from trialid.identification.one_search import left_by_one
from trialid.identification.output_error import linearise, ranges
from trialid.progress import Progress
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Departure

WHOLE: Final = 0.1
"""Error from which on faults are fitted that are there whole or not at all: rudders of two screws
exchanged left 18 to 29 % of the motion, one of them stuck 18 to 25 %, and slopes at a ship that has
no such fault lead elsewhere. Half of it costs time where nothing is found, twice misses some."""

GROSS: Final = 0.3
"""Error from which on slopes are not trusted: a thruster of two that is 20 % weak left 12 to 20 %
of the motion, one that is dead or reversed 70 % and more."""

EXPLAINS: Final = 0.5
"""Share of the error that may be left with a fault that is named, and never more than `GROSS` that
is not noise: a ferry modelled without any resistance was explained, to an error of 1, by two pods
exchanged; a ship whose only tunnel is stuck hardly moves, and noise alone is 0.30 to 0.32; ..."""

EXPLAINED: Final = 0.3
"""Share of the error that another effect leaves from which on no whole fault is sought: a thruster
a fifth weak left 0.21 with its name, the wrong two of four exchanged 0.48."""

SOON: Final = 20
"""Iterations in which a whole fault that is the right one arrives; it took 13 to 15."""

ASTRAY: Final = 1.0
"""Share of the error without a fault that one search may leave for it to be searched further, which
took 76 of 124 s of growing a boat's model. Of 33 faults named in studies of other ships one
search leaves 0.05 to 0.67 of it; of 820 searches for one that is not there 115 leave less than all
of it. Half of it would lose two names, twice none."""

ALIKE: Final = 1.2
"""... and by how much another leaves more, to be told from it."""

INSIDE: Final = 1e-3
"""Share of its range by which a fault's value lies inside of it: at its end it is another."""

UNSEEN: Final = 1.01
"""... unless with all of the fault no more is left: then a gain of the actuator's own makes up for
any value (the only tunnel of a ship, reversed, ended at either end of three in six). A number that
lowers the error by no more says nothing either: a thruster that is dead is also one that is stuck
where it gives no thrust."""


OTHER_THAN_A_GAIN: Final = 0.01
"""Share of a fault's trace that no free parameter can leave: the only engine of a boat, whose gain
is free, is weak by 1e-7 of it, one thruster of two with a gain in common by 0.5."""


LeavesNoise = Callable[[Fit], bool]
"""Whether what a fit leaves is no more than noise."""


def gross_faults(
    fit: Fit,
    candidates: Mapping[str, Effect],
    progress: Progress,
    leaves_noise: LeavesNoise,
) -> tuple[Refit, ...]:
    """Faults that explain a record which the fit does not, the best first; mostly none.

    Nor does a fit whose coefficients are of no such ship: a rudder that sticks is no hull.
    """
    follows = np.isfinite(fit.eps_rmsn) and fit.eps_rmsn < GROSS and fit.converged
    if follows and why_no_fit(fit) is None:
        return ()
    found = _of_these(fit, _absent(fit, candidates), progress)
    return found if found and _explains(found[0], fit.eps_rmsn, leaves_noise) else ()


def whole_faults(
    fit: Fit,
    candidates: Mapping[str, Effect],
    ranking: Sequence[Candidate],
    others: Sequence[Refit],
    progress: Progress,
    leaves_noise: LeavesNoise,
) -> tuple[Refit, ...]:
    """Faults that explain what none of the others does, by slopes or whole; mostly none.

    They leave half of what the best of the others leaves, or nothing but noise where each block
    says that the others leave more, so much that it is worth a name. A fault that is there whole is
    far from the ship without it, and so are the parameters fitted there; of the rest those are
    tried that by their slopes leave less than all others, whatever blocks left out say of them,
    which go by slopes too. Where one of the others explains the record none is tried.
    """
    others = [r for r in others if not r.candidate.effect.is_whole]
    least = min((r.fit.eps_rmsn for r in others), default=fit.eps_rmsn)
    if fit.eps_rmsn < WHOLE or least < EXPLAINED * fit.eps_rmsn:
        return ()
    able = {c.effect.name for c in ranking if c.allowed and c.eps_predicted < least}
    faults = [e for e in _absent(fit, candidates) if e.is_whole or e.name in able]
    soon = replace(fit, settings=replace(fit.settings, max_iterations=SOON))
    found = _of_these(soon, faults, progress)
    if not found or _explains(found[0], min(least, fit.eps_rmsn), leaves_noise):
        return found
    first = found[0].carried
    rest = [r.carried.after for r in others] or [first.before]
    unlike = first.falls and not any(as_good(first.after, after) for after in rest)
    if not unlike or not leaves_noise(found[0].fit):
        return ()
    return tuple(r for r in found if as_good(first.after, r.carried.after))


def with_other_fault(
    fit: Fit, found: Together, candidates: Mapping[str, Effect], progress: Progress
) -> Together:
    """Two effects at once, an actuator's fault chosen anew where the model has the other already.

    Slopes at a fit that lacks both do not tell one fault from another: of a boat without sway whose
    port thruster gives 0.6 of its push one that is misaligned had been added, at 19.1 %; weak, it
    leaves 15.1.
    """
    of_one = tuple(f"{one.name}_" for one in fit.model.ship.actuators)
    hers = [e for e in found.effects if not e.name.startswith(of_one)]
    if len(hers) != 1:
        return found
    try:
        model, settings = fit.model + hers[0], settings_with(fit, hers)
        beside = identify(fit.trials, model, settings, near=found.fit.estimates)
    except TrialidError:  # it arrives beside that fault alone
        return found
    tried = [e for e in _absent(beside, candidates) if e.name not in found.names]
    better = (
        Together((*hers, one.candidate.effect), one.fit, carried_between(fit, one.fit))
        for one in _of_these(beside, tried, progress)
    )
    return min((found, *better), key=lambda one: one.cost)


def _absent(fit: Fit, candidates: Mapping[str, Effect]) -> list[Effect]:
    present = {e.name for e in fit.model.effects}
    return [e for n, e in candidates.items() if e.bound_by_meaning and n not in present]


def _of_these(fit: Fit, faults: Sequence[Effect], progress: Progress) -> tuple[Refit, ...]:
    """Those of which the fit can be trusted, the best first, and what leaves hardly more."""
    fit = with_means(fit) if faults else fit
    found = [r for e in faults if (r := _fitted(fit, e, progress)) is not None]
    found.sort(key=lambda r: r.fit.eps_rmsn)
    close = [r for r in found if r.fit.eps_rmsn < ALIKE * found[0].fit.eps_rmsn]
    return tuple(r for r in close if not any(_says_as_much(one, r) for one in close))


def _says_as_much(one: Refit, other: Refit) -> bool:
    """Whether a fault does with fewer numbers what another does to the same signals."""
    few, many = one.candidate.effect, other.candidate.effect
    alike = set(few.signals) == set(many.signals) and len(few.parameters) < len(many.parameters)
    return alike and one.fit.eps_rmsn < UNSEEN * other.fit.eps_rmsn


def _explains(fault: Refit, error: float, leaves_noise: LeavesNoise) -> bool:
    """Whether a fault leaves so little of this error that it alone explains the record."""
    left = fault.fit.eps_rmsn
    if left > EXPLAINS * error:  # an error may be no number
        return False
    return left <= GROSS or leaves_noise(fault.fit)


def _fitted(fit: Fit, effect: Effect, progress: Progress) -> Refit | None:
    """The model with a fault, fitted; None where that fails or the fault is at its range's end."""
    progress(f"trying {effect.name}", 0.68)
    start = {n: p.start if effect.is_whole else 0.9 * p.high for n, p in effect.parameters.items()}
    model = (first_model(fit) + effect).with_values(start)
    try:
        fitted = _arrived(fit.examined, model, effect)
    except TrialidError:  # it cannot act on this record: it is not the one
        return None
    if fitted is None or fitted.eps_rmsn > ALIKE * GROSS or why_no_fit(fitted):
        return None
    if not effect.is_whole and _is_a_gain(fitted, effect):
        return None
    carried = carried_between(fit.examined, fitted)
    candidate = Candidate(
        effect=effect,
        expected=start,
        eps_predicted=fitted.eps_rmsn,
        score=0.0,
        p_value=np.nan,  # it was fitted, not tested
        visibility=1.0,
        family=(effect.name,),
        allowed=True,
        carried=carried,
    )
    return Refit(candidate, on_every_sample(fit, fitted), carried)


def _is_a_gain(fit: Fit, effect: Effect) -> bool:
    """Whether free parameters do the same, or nothing moves: another value, and not missing."""
    own = np.array([x.name in effect.parameters for x in fit.problem.unknowns])
    psi = _slopes_inside(fit, own)
    rest, trace = psi[:, ~own], psi[:, own]
    sizes = np.linalg.norm(rest, axis=0)
    rest = rest[:, sizes > 0.0] / sizes[sizes > 0.0]
    left = trace - rest @ np.linalg.lstsq(rest, trace, rcond=None)[0]
    return bool(np.linalg.norm(left) <= OTHER_THAN_A_GAIN * np.linalg.norm(trace))


def _slopes_inside(fit: Fit, own: Mask) -> Vector:
    """Slopes of all unknowns; of a fault at its end, where it has none, those beside it."""
    _, low, high = (x[own] for x in ranges(fit.problem.unknowns))
    theta, margin = fit.theta.copy(), INSIDE * (high - low)
    theta[own] = np.clip(theta[own], low + margin, high - margin)
    point = linearise(fit.problem, theta)
    return fit.psi if isinstance(point, Departure) else point[1]


def _arrived(fit: Fit, model: ShipModel, effect: Effect) -> Fit | None:
    """A fault with the value found, or all of it where any value does; None at its range's end."""
    freed = _searched(fit, model, effect.parameters)
    if freed and _inside(freed, effect):
        return freed
    if not effect.is_whole:
        return None
    whole = _searched(fit, model, [n for n, p in effect.parameters.items() if not p.by_meaning])
    most = UNSEEN * freed.eps_rmsn if freed else np.inf
    return whole if whole and whole.eps_rmsn < most else None


def _searched(fit: Fit, model: ShipModel, names: Iterable[str]) -> Fit | None:
    """The model with a fault, these of its numbers free; None where one search leads nowhere."""
    settings = replace(fit.settings, free=(*fit.settings.free, *names))
    try:
        first = left_by_one(fit.trials, model, settings)
    except StepsTooLong:  # `identify` takes finer ones
        first = 0.0
    return identify(fit.trials, model, settings) if first < ASTRAY * fit.eps_rmsn else None


def _inside(fit: Fit, effect: Effect) -> bool:
    """Whether the fault is what it is called: dead is the end of weak, and belongs to it."""
    for name, p in effect.parameters.items():
        value, margin = fit.value(name), INSIDE * (p.high - p.low)
        if value < p.low + margin or (effect.is_whole and value > p.high - margin):
            return False
    return True
