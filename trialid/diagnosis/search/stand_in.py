"""Whether the best effect stands in for another, which shows only once it is in the model.

Slopes are those of the model as it was fitted, and where much is missing that fit lies far from the
truth. A rudder that stands in the race of a propeller, fitted by one in free flow, has its side
force over on the other side; there the race foretells 12 % of the squared error and a cubic rudder
14 %. Fitted, the cubic takes 16 % off, and beside it the race stands out; fitted alone that takes
49 % (`tests/diagnosis/test_stand_in.py`, seed 31). So what explains much beside the best effect is
fitted without it, and the better of the two is the best.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.diagnosis.best_refit import best_of
from trialid.diagnosis.objections import HARDLY_FALLS, likeliest_refit, objection
from trialid.diagnosis.search.augment import Augmented, augment
from trialid.diagnosis.search.carried import is_far
from trialid.diagnosis.search.carry_over import left_out
from trialid.diagnosis.search.falls import fall, fall_of_all
from trialid.diagnosis.search.refit import Progress, Refit, moves_rudder, refit
from trialid.diagnosis.search.score import Candidate
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect
from trialid.trial import WIND

MOST: Final = 3
"""How often the best effect may give way: each takes the slopes of the whole catalogue anew."""


@dataclass(frozen=True)
class Tried:
    """All refits, the best of them, and the slopes of the catalogue with it in the model.

    `best` and `augmented` are None where no refit stands every check.
    """

    refits: tuple[Refit, ...]
    best: Refit | None = None
    augmented: Augmented | None = None


def look_beside(
    fit: Fit,
    ranking: Sequence[Candidate],
    refits: Sequence[Refit],
    catalogue: Callable[[Fit], Mapping[str, Effect]],
    *,
    most: int,
    level: float,
    grown: bool,
    progress: Progress,
) -> Tried:
    """The refits, and what explains much beside the best of them fitted without it.

    Parameters
    ----------
    catalogue
        What can be tried on a fit: an effect in the place of another has other coefficients.
    most
        How many are fitted beside one effect.
    """
    done = tuple(refits)
    for _ in range(MOST):
        best = likeliest_refit(fit, done, level, grown)
        if best is None:
            break
        progress(f"looking beside {best.candidate.effect.name}")
        augmented = augment(best.fit, catalogue(best.fit))
        fitted = {r.candidate.effect.name for r in done}
        able = [c for c in ranking if c.allowed and c.effect.name not in fitted]
        large = _large_beside(augmented, able)[:most]
        if not large:
            return Tried(done, best, augmented)
        del augmented  # of a long record there is no room for two
        done = (*done, *refit(fit, large, progress))
        if likeliest_refit(fit, done, level, grown) is best:
            break
    return Tried(done)


def foretell_far_more(
    fit: Fit, ranking: Sequence[Candidate], refits: Sequence[Refit]
) -> list[Candidate]:
    """The candidate that foretells far more than all that were fitted took off, if there is one.

    However its slope carries over: in a fit far from the truth slopes of the right effect do not.
    """
    fitted = {r.candidate.effect.name for r in refits}
    able = [c for c in ranking if c.allowed and c.effect.name not in fitted]
    most = max(able, key=lambda c: _foretold(fit, c), default=None)
    done = max((fall(fit, r) for r in refits if r.fit.converged), default=0.0)
    return [most] if most is not None and is_far(_foretold(fit, most), done) else []


def further_ones(
    fit: Fit, named: Refit | None, ranking: Sequence[Candidate], refits: Sequence[Refit]
) -> list[Candidate]:
    """Candidates to fit whatever their slopes say."""
    return [*further_gears(fit, named, ranking, refits), *further_winds(fit, ranking, refits)]


def further_gears(
    fit: Fit, named: Refit | None, ranking: Sequence[Candidate], refits: Sequence[Refit]
) -> list[Candidate]:
    """Steering gears that were not fitted, where orders alone are recorded and the model has none.

    And none is to be named.

    No rudder stands where it is told at once, so that a hull fitted as if it did may be none: of an
    outsider's tanker the rudder turned her the wrong way, and `yaw_memory` stood alone.
    """
    if any(map(moves_rudder, (*fit.model.effects, *(named.effects if named else ())))):
        return []
    fitted = {r.candidate.effect.name for r in refits}
    able = (c for c in ranking if c.allowed and moves_rudder(c.effect))
    return [c for c in able if c.effect.name not in fitted]


def further_winds(
    fit: Fit, ranking: Sequence[Candidate], refits: Sequence[Refit]
) -> list[Candidate]:
    """Forces of the wind that an anemometer logged, where the model has none.

    Whatever their slopes say: without the wind that heels her a yacht of an outsider had a GM of
    0.0005 m, from which 38.3 % of an error of 38.8 % were foretold with a lever beyond what is
    physical. Fitted, the wind left 10.1 %.
    """
    if any({*WIND} & {*e.signals} for e in fit.model.effects):
        return []
    fitted = {r.candidate.effect.name for r in refits}
    able = (c for c in ranking if {*WIND} & {*c.effect.signals})
    return [replace(c, allowed=True) for c in able if c.effect.name not in fitted]


def far_ahead(
    fit: Fit, named: Refit, refits: Sequence[Refit], level: float, *, grown: bool
) -> Refit | None:
    """The refit that takes far more off than the one to be named, though something denies it."""
    far = [r for r in refits if r.fit.converged and is_far(fall(fit, r), fall(fit, named))]
    denied = [r for r in far if objection(fit, r, level, grown)]
    return max(denied, key=lambda r: fall(fit, r), default=None)


def _foretold(fit: Fit, candidate: Candidate) -> float:
    """Share of the squared error that would go by the slopes."""
    told = 1.0 - (candidate.eps_predicted / fit.eps_rmsn) ** 2
    return told if np.isfinite(told) else 0.0


def _large_beside(augmented: Augmented, able: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that take much off what is left of blocks left out, most first."""
    blocks = left_out(
        augmented.fit, augmented.residual, augmented.psi, augmented.S, augmented.stretches
    )
    by_name = {c.effect.name: c for c in able}
    found = dict[str, float]()
    for trace in augmented.traces:
        carried, name = blocks.carried(trace.columns), trace.effect.name
        if name in by_name and carried.large:
            price = carried.price(len(trace.effect.parameters))
            found[name] = min(price, found.get(name, price))
    return [by_name[name] for name in sorted(found, key=lambda name: found[name])]


def shown_in_few(fit: Fit, against: Refit, refits: Sequence[Refit], level: float) -> Refit | None:
    """The one that stands out and takes far more off, of trials held out too, in few blocks.

    Of a made catamaran with a weak jet that showed where the shafts were set apart, a nozzle's zero
    was told of, which trials held out deny, and not the shafts.
    """
    able = [
        r
        for r in refits
        if objection(fit, r, level) == HARDLY_FALLS
        and r.candidate.p_value < level
        and r.carried.better > 0
        and not r.carried.in_most
        and is_far(fall_of_all(fit, r), fall(fit, against))
    ]
    return best_of(able, level)
