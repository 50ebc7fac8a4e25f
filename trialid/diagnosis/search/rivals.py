"""What may be meant as well as the effect that is named."""

from collections.abc import Sequence
from typing import Final

from trialid.diagnosis.search.carried import Carried, as_good
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate

RIVAL: Final = 0.5
"""Share of the named effect's fall, as a logarithm, below which another explains too little to be
taken for it, and its own slope foretold too little to be believed. Stuck rudders had 0.05 and 0.10
by their slopes, a cubic yaw term of a real model 0.37, a weak thruster 0.66, most others 0.9 and
more. Half: of these only what is stuck is looked into. Twice: everything is fitted; tried on ships
with every coefficient off, a tiny fall then brought thirteen further fits and no better name."""


def to_fit(
    named: Refit, ranking: Sequence[Candidate], refits: Sequence[Refit]
) -> tuple[Candidate, ...]:
    """Candidates to fit before they are said to do as well, where slopes are not believed.

    A rudder that is stuck takes 40 % off by its slope, and 99 % when it is fitted; what the slopes
    of others say is then worth as little.
    """
    return () if _foretold(named) else _by_slope(named, ranking, refits)


def rivals(named: Refit, ranking: Sequence[Candidate], refits: Sequence[Refit]) -> tuple[str, ...]:
    """Effects that this record cannot tell from the named one: as good, or alike in trace.

    As good is what leaves no more of the blocks left out than chance would, and explains more than
    half of what the named one does, when it is fitted; by its slope where slopes are believed.
    """
    others = [r for r in refits if r is not named]
    good = {r.candidate.effect.name for r in others if _as_good(named.carried, r.carried)}
    apart = {r.candidate.effect.name for r in others} - good
    apart |= {c.effect.name for c in ranking if c.effect.bound_by_meaning and not c.allowed}
    if _foretold(named):
        good |= {c.effect.name for c in _by_slope(named, ranking, refits)}
    close = [c.effect.name for c in ranking if c.effect.name in good and c.allowed]
    alike = [n for n in named.candidate.family[1:] if n not in close and n not in apart]
    return (*close, *alike)


def _foretold(named: Refit) -> bool:
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
        and _as_good(named.candidate.carried, c.carried)
    )


def _as_good(mine: Carried, its: Carried) -> bool:
    """Whether another effect carries over as well as far as these blocks can tell."""
    return 0.0 < its.ratio < mine.ratio**RIVAL and as_good(mine.after, its.after)
