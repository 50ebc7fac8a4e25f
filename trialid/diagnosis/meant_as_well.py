"""What a named effect may stand in for: two others at once, or numbers that the model holds.

Single effects are its rivals by `search.rivals`. An effect of several coefficients can do what two
plain ones do together, and what any can do numbers may that are held at what a file says of them.
Of a made model of a ferry, decays beside zig-zags, `heel_yaw_cubic` was named, four coefficients,
not told from `heel_drift` alone. She has neither: her roll is damped at rest, too, her rudders'
flow goes by the screws, and her added masses lie one to two standard deviations off their formulas.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import gap_with, tried_effects
from trialid.diagnosis.found_values import comes_from_outside, her_own
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.noise.thinning import with_means
from trialid.diagnosis.search.augment import fixed_coefficients
from trialid.diagnosis.search.carried import EACH, Carried, does_as_well
from trialid.diagnosis.search.carry_over import carried_between
from trialid.diagnosis.search.completeness import Completeness
from trialid.diagnosis.search.falls import fall
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.together import Pair, Together, fit_pairs
from trialid.diagnosis.verdict import Verdict
from trialid.diagnosis.verdict_sentences import by_herself
from trialid.errors import TrialidError
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings, pose_problem
from trialid.identification.weighing import Weighing
from trialid.ship.effect import Effect

Progress = Callable[[str], None]

PAIR: Final = 2
"""Coefficients that two effects have at least."""

WITHIN: Final = 2.0
"""Standard deviations that a number that is held may be off. Of four made ships with nine names, at
2 what is held did as much as three of them; free to go anywhere as much as all nine, one added mass
eight deviations off. At half of it the two that a ship of these lies off are shut out."""

FORETOLD: Final = 0.5
"""Share of the named effect's fall that slopes must foretell of what is held, before it is fitted:
1.2 and 1.6 of it where that does as much, at most 0.2 where not (`test_meant_as_well.py` and the
shipped sample, whose fit of it took a second), so that half and twice change none of them."""

MOST: Final = 0.9
"""Share of what slopes foretell of all that is held, from which on fewer of it are fitted alone. At
half and at twice as far from all of it the same are told of the five of `test_meant_as_well.py`."""

NOTHING: Final = 0.01
"""Share of the residual below which a number that is held moves nothing, as one of roll beside a
yaw that is fitted alone. Of two ships of an outsider's eight of the 17 that were to be freed move
nothing at all, the others 0.7 of it and more: half and twice tell the same."""

TOLD: Final = 2
"""Numbers that are held, those moved most, that a sentence tells of."""


@dataclass(frozen=True)
class Freed:
    """The model with what is held sought, and which numbers those are, moved most first."""

    fit: Fit
    moved: tuple[str, ...]
    carried: Carried


@dataclass(frozen=True)
class Slopes:
    """Residual and slopes where what is held would begin to move; what each column is of."""

    residual: Vector
    psi: Vector
    rows: int
    names: tuple[str, ...]

    def still(self, known: Mapping[str, tuple[float, float]]) -> set[str]:
        """Which of these move nothing that is fitted, off by as much as is known of each."""
        moves = dict(zip(self.names, np.linalg.norm(self.psi[: self.rows], axis=0), strict=True))
        least = NOTHING * float(np.linalg.norm(self.residual[: self.rows]))
        return {n for n, (_, off) in known.items() if not moves[n] * off > least}

    def foretold(self, still: Collection[str] = ()) -> float:
        """Share of the squared error that they say goes, these held; one linear solve."""
        psi = self.psi[:, [name not in still for name in self.names]]
        sizes = np.maximum(np.linalg.norm(psi, axis=0), 1e-300)
        by = np.linalg.lstsq(psi / sizes, self.residual, rcond=1e-9)[0]
        left = self.residual - psi @ (by / sizes)
        before, after = self.residual[: self.rows], left[: self.rows]
        return 1.0 - float(after @ after) / float(before @ before)


def beside_others(
    fit: Fit,
    verdict: Verdict,
    named: Refit | None,
    parts: Split,
    whole: Completeness | None,
    *,
    asked: DiagnoseSettings,
    progress: Progress,
) -> Verdict:
    """The verdict beside two effects at once, and what is held, which leaves it no name.

    Nor is anything outside the catalogue where what is held does all that it does not.
    """
    if not (named or verdict.kind == "not in catalogue"):
        return verdict
    if named is None:
        freed = held_alone(fit, parts, progress) if asked.coefficients else None
        known = freed and not gap_with(whole, freed.fit, asked)
        return held_before(fit, None, freed) if freed and known else verdict
    adds = named.candidate.effect.held is None  # what is freed itself is not a rival of the rest
    if asked.coefficients and adds and (freed := held_instead(fit, named, progress)):
        return held_before(fit, named, freed)
    tried = tried_effects(fit, asked)
    two = two_instead(fit, named, verdict.family, tried, asked.refit, progress)
    if (
        two is not None
        and comes_from_outside(named.candidate.effect)
        and all(map(her_own, two.effects))
    ):
        said = by_herself(fit, named, two)
        return Verdict("cannot tell", None, (), said, pair_as_well=two.names)
    return also_from(verdict, two)


def also_from(found: Verdict, two: Together | None) -> Verdict:
    """The verdict with two effects that its name is not told from, beside what it says already."""
    if two is None:
        return found
    begin = "nor" if len(found.family) > 1 else "this record cannot tell it"
    sentence = f"{found.sentence}; {begin} from {' and '.join(two.names)} together"
    return replace(found, sentence=sentence, pair_as_well=two.names)


def held_before(fit: Fit, named: Refit | None, freed: Freed) -> Verdict:
    """The verdict where what is held does as well, or as all that is missing."""
    first, count = " and ".join(freed.moved[:TOLD]), len(freed.moved)
    which = f"{first} most of {count}" if count > TOLD else first
    before, other = (f"{x.eps_rmsn:.2%}" for x in (fit, freed.fit))
    begun = (
        f"{named.candidate.effect.name} takes the error from {before} to "
        f"{named.fit.eps_rmsn:.2%}, and numbers that are held do as well"
        if named
        else f"no effect of the catalogue explains what is left of {before}, and numbers that are "
        "held do"
    )
    said = (
        f"{begun}, off by at most twice what is known of each: to {other}, by {which}. "
        "Free all of them before any effect is added, and look again"
    )
    return Verdict("cannot tell", None, (), said, held_as_well=freed.moved)


def two_instead(
    fit: Fit,
    named: Refit,
    told: Sequence[str],
    catalogue: Mapping[str, Effect],
    most: int,
    progress: Progress,
) -> Together | None:
    """Two effects, neither of them told already, that do as well with no more coefficients."""
    coefficients = len(named.candidate.effect.parameters)
    if coefficients < PAIR:
        return None

    def as_plain(pair: Pair) -> bool:
        new = all(trace.effect.name not in told for trace in pair)
        return new and sum(len(trace.parameters) for trace in pair) <= coefficients

    done = fit_pairs(fit, catalogue, most, progress, as_plain)
    able = [p for p in done if p.arrives and does_as_well(named.carried, p.carried)]
    return min(able, key=lambda one: one.cost, default=None)


def held_instead(fit: Fit, named: Refit, progress: Progress) -> Freed | None:
    """The model with what is held freed, where that does as well as a named effect.

    But for what the effect's parameters have to be worth, of the whole error or of each output's
    own: of a linear ship in whom nothing was missing an added mass had a name by 0.0007, although
    freed with all else it is what moved.
    """
    own = named.candidate.effect.parameters  # a coefficient that is freed is no rival of itself

    def as_well(freed: Freed) -> bool:
        return not _goes_beyond(named, freed)

    return _freed(fit, FORETOLD * fall(fit, named), as_well, progress, own)


def _goes_beyond(named: Refit, freed: Freed) -> bool:
    """Whether an effect does what its parameters cost beyond what is held does."""
    worth = named.carried.beyond(freed.carried).worth
    return bool(np.log(worth) > EACH * len(named.candidate.effect.parameters))


def held_alone(fit: Fit, parts: Split, progress: Progress) -> Freed | None:
    """The model with what is held freed, where that leaves no more than noise may be.

    And is worth what a name is; None where nothing says how much of the error is no noise.
    """
    sure = parts.undermodelling_interval[0] if parts.undermodelling_interval else 0.0
    if not sure > 0.0:
        return None
    share = (sure / fit.examined.eps_rmsn) ** 2  # of the squared error, that cannot be noise

    def enough(freed: Freed) -> bool:
        return freed.carried.falls and fall(fit.examined, freed) >= share

    return _freed(fit, FORETOLD * share, enough, progress)


def _freed(
    fit: Fit,
    least: float,
    able: Callable[[Freed], bool],
    progress: Progress,
    own: Collection[str] = (),
) -> Freed | None:
    """The fewest of what is held that are `able`, all where no fewer are, each about its value.

    None where slopes foretell too little. They are in the model, and off by some of that in any
    ship: no more is counted for them, as for an effect's coefficients.
    """
    fit = with_means(fit).examined
    known = _as_known(fit, own)
    slopes = _slopes(fit, known) if known else None
    if slopes is not None and (still := slopes.still(known)):
        known = {n: each for n, each in known.items() if n not in still}
        slopes = _slopes(fit, known) if known else None
    if slopes is None or slopes.foretold() < least:
        return None
    progress("freeing what is held")
    freed = _sought(fit, known)
    if freed is None or not able(freed):
        return None
    count = _enough(slopes, freed.moved)
    alone = _sought(fit, {n: known[n] for n in freed.moved[:count]}) if count < len(known) else None
    return alone if alone and able(alone) else freed


def _enough(slopes: Slopes, moved: Sequence[str]) -> int:
    """How many of them, the first, slopes foretell `MOST` of all by; two at least."""
    least = MOST * slopes.foretold()
    counts = range(TOLD, len(moved))
    return next((n for n in counts if slopes.foretold(moved[n:]) >= least), len(moved))


def _sought(fit: Fit, known: Mapping[str, tuple[float, float]]) -> Freed | None:
    """The model with these sought, each about its value; None where that cannot be, or is lost."""
    try:
        freed = identify(fit.trials, fit.model, _wider(fit.settings, known), near=_near(fit, known))
    except TrialidError:  # they cannot be sought on this record
        return None
    if not freed.converged:
        return None
    moved = {n: abs(freed.value(n) - x) / off for n, (x, off) in known.items()}
    return Freed(freed, tuple(sorted(known, key=lambda n: -moved[n])), carried_between(fit, freed))


def _as_known(fit: Fit, own: Collection[str]) -> dict[str, tuple[float, float]]:
    """What is held, with its standard deviation by the ship's file where that says one."""
    model = fit.problem.simulator.model
    held = {n: model.value(n) for n in fixed_coefficients(fit) if n not in own}
    known = {n: (x, abs(x) * model.ship.share_off(n)) for n, x in held.items()}
    return {n: each for n, each in known.items() if each[1] > 0.0}


def _near(fit: Fit, known: Mapping[str, tuple[float, float]]) -> dict[str, float]:
    """Where the fit ended, and what her file says of these."""
    return {**fit.estimates, **{n: x for n, (x, _) in known.items()}}


def _wider(asked: Settings, known: Mapping[str, tuple[float, float]]) -> Settings:
    """The same question with these numbers sought, by their values and standard deviations."""
    ends = {n: (x - WITHIN * off, x + WITHIN * off) for n, (x, off) in known.items()}
    return replace(
        asked,
        free=(*asked.free, *known),
        priors={**asked.priors, **known},
        bounds={**asked.bounds, **ends},
    )


def _slopes(fit: Fit, known: Mapping[str, tuple[float, float]]) -> Slopes | None:
    """With all of these sought; None where nothing can be simulated."""
    wider = _wider(fit.settings, known)
    problem = pose_problem(fit.trials, fit.model, wider, _near(fit, known))
    weighing = Weighing(problem)
    if (point := weighing(problem.start)) is None:
        return None
    return Slopes(*point, weighing.rows, tuple(x.column for x in problem.unknowns))
