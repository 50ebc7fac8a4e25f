"""What may be meant as well as the effect that is named."""

from collections.abc import Sequence

import numpy as np

from trialid.accuracy.parameter_table import prior_shares
from trialid.diagnosis.found_values import gives_way, her_own, is_force, of_a_sensor
from trialid.diagnosis.search.carried import FALL, RIVAL, does_as_well
from trialid.diagnosis.search.carry_over import prior_rows
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate
from trialid.identification.weighing import CONTRADICTS
from trialid.least_squares.fold import triangle
from trialid.ship.effect import Effect


def to_fit(
    named: Refit, ranking: Sequence[Candidate], refits: Sequence[Refit], grown: bool
) -> tuple[Candidate, ...]:
    """Candidates to fit before they are said to do as well, where slopes are not believed.

    A rudder that is stuck takes 40 % off by its slope, and 99 % when it is fitted; what the slopes
    of others say is then worth as little. A name that gives way to what is of the ship and does as
    well (a sensor's in a grown model): what would, or is alike in trace, is fitted first.
    """
    found = _by_slope(named, ranking, refits)
    if not gives_way(named.candidate.effect, grown):
        return () if foretold(named) else found
    fitted = {r.candidate.effect.name for r in refits}
    alike = {*named.candidate.family} - fitted
    more = [c for c in ranking if c.allowed and (c in found or c.effect.name in alike)]
    return tuple(c for c in more if her_own(c.effect) or not foretold(named))


def rivals(named: Refit, ranking: Sequence[Candidate], refits: Sequence[Refit]) -> tuple[str, ...]:
    """Effects that this record cannot tell from the named one: as good, or alike in trace.

    As good is what leaves no more of the blocks left out than chance would, and explains more than
    half of what the named one does, when it is fitted; by its slope where slopes are believed. What
    is held back by what was known of it might be, where its slope would: of a model whose eddies
    damped her by ten times the estimate, damping by the cube had the name, of which nothing was
    known. And as good as a sensor's effect is what of the ship is alike and does half of it.
    """
    others = [r for r in refits if r is not named]
    as_well = (
        r
        for r in others
        if does_as_well(named.carried, r.carried) or _might(named, r) or _is_twin(named, r)
    )
    good = {r.candidate.effect.name for r in as_well}
    apart = {r.candidate.effect.name for r in others} - good
    apart |= {c.effect.name for c in ranking if _has_ends(c.effect) and not c.allowed}
    if foretold(named):
        good |= {c.effect.name for c in _by_slope(named, ranking, refits)}
    close = [c.effect.name for c in ranking if c.effect.name in good and c.allowed]
    alike = [n for n in named.candidate.family[1:] if n not in close and n not in apart]
    return (*close, *alike)


def unlike_in_trace(
    named: Refit, others: Sequence[str], ranking: Sequence[Candidate]
) -> tuple[Candidate, ...]:
    """Those of its rivals whose traces are not like its own."""
    unlike = {*others} - {*named.candidate.family}
    return tuple(c for c in ranking if c.effect.name in unlike)


def is_open(named: Refit, unlike: Sequence[Candidate], level: float, *, most: bool) -> bool:
    """Whether effects `unlike` it may be meant, and nothing says that it is this one.

    It does not stand out against the noise, and another does, or it takes less than `most` of the
    squared error; or it takes less, is no force, and a force leaves less where it was not fitted,
    by what is worth a name: a sensor, a clock or a gear that is late mends any hull a little, so
    that it stands out says that something is missing, and not which. Where this was found forces
    leave 5 and 20 % less, beside a gear that has such a fault 0.1 at most: half and twice say the
    same.
    """
    if named.candidate.p_value >= level:
        return any(c.p_value < level or not most for c in unlike)
    worth = named.candidate.price + np.log(FALL)
    none = not most and not is_force(named.candidate.effect)
    return none and any(is_force(c.effect) and c.price < worth for c in unlike)


def _has_ends(effect: Effect) -> bool:
    """Whether a value beyond its range says that it is not this, as of a coefficient."""
    return effect.bound_by_meaning or effect.held is not None


def _is_twin(named: Refit, other: Refit) -> bool:
    """Whether what is of the ship, alike in trace, does more than half of what a sensor's does.

    Which of them leaves less is then decided by what else is missing. Of a stranger's boat without
    drag by her speed in her model, and more beside, her log was named as 0.16 m/s off in 14 of 20
    voyages (cosines 0.97 to 0.99), in six of them without a word of that drag.
    """
    sensor = of_a_sensor(named.candidate.effect) and her_own(other.candidate.effect)
    alike = sensor and other.candidate.effect.name in named.candidate.family
    return alike and 0.0 < other.carried.ratio < named.carried.ratio**RIVAL


def _might(named: Refit, other: Refit) -> bool:
    """Whether another does as well by its slope, and was held back when it was fitted."""
    return does_as_well(named.carried, other.candidate.carried) and _held_back(other)


def _held_back(refit: Refit) -> bool:
    """Whether what was known of a parameter that was added keeps it from where the record has it.

    By how far the prior moves it over its standard error: with `share` the variance that is left
    over the prior's, (value - mean) / std sqrt(share) / (1 - share).
    """
    fit, added = refit.fit, refit.candidate.effect.parameters
    known = {i: x.prior for i, x in enumerate(fit.problem.unknowns) if x.prior and x.name in added}
    if not known:
        return False
    shares = prior_shares(triangle(fit.psi), prior_rows(fit)[:, 0])
    assert shares is not None
    moved = (
        abs(float(fit.theta[i]) - mean) / deviation * float(np.sqrt(shares[i])) / _told(shares[i])
        for i, (mean, deviation) in known.items()
    )
    return any(x > CONTRADICTS for x in moved)


def _told(share: float) -> float:
    """What the record tells of a parameter, where so much of what is known is its prior's."""
    return max(1.0 - share, 1e-9)


def foretold(named: Refit) -> bool:
    """Whether the slope of the named effect foretold half of its fall, as a logarithm."""
    return named.candidate.carried.ratio < named.carried.ratio**RIVAL


def _by_slope(
    named: Refit, ranking: Sequence[Candidate], refits: Sequence[Refit]
) -> tuple[Candidate, ...]:
    """Candidates unlike the named one that by their slopes do as well, and were not fitted."""
    fitted = {r.candidate.effect.name for r in refits}
    return tuple(
        c
        for c in ranking
        if c.allowed
        and c.effect.name not in {*fitted, *named.candidate.family}
        and does_as_well(named.candidate.carried, c.carried)
    )
