"""What may be meant as well as the effect that is named, said only of what was fitted."""

from collections.abc import Sequence
from typing import Final

from trialid.diagnosis.search.carried import Carried, as_good
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate

RIVAL: Final = 0.5
"""Share of the named effect's fall, as a logarithm, below which another explains too little to be
taken for it."""


def to_fit(
    named: Refit, ranking: Sequence[Candidate], refits: Sequence[Refit]
) -> tuple[Candidate, ...]:
    """Candidates unlike the named one that by their slopes do as well, and were never fitted.

    Slopes foretell little where the error is large: a rudder that is stuck takes 40 % off by its
    slope, and 99 % when it is fitted.
    """
    fitted = {r.candidate.effect.name for r in refits}
    return tuple(
        c
        for c in ranking
        if c.allowed
        and c.effect.name not in {*fitted, *named.candidate.family}
        and _as_good(named.candidate.carried, c.carried)
    )


def rivals(named: Refit, ranking: Sequence[Candidate], refits: Sequence[Refit]) -> tuple[str, ...]:
    """Effects that this record cannot tell from the named one: as good when fitted, or alike.

    As good is what leaves no more of the blocks left out than chance would, and explains more than
    half of what the named one does. Alike in trace and not fitted is what the slopes alone say.
    """
    others = [r for r in refits if r is not named]
    good = {r.candidate.effect.name for r in others if _as_good(named.carried, r.carried)}
    apart = {r.candidate.effect.name for r in others} - good
    apart |= {c.effect.name for c in ranking if c.effect.bound_by_meaning and not c.allowed}
    close = [c.effect.name for c in ranking if c.effect.name in good and c.allowed]
    alike = [n for n in named.candidate.family[1:] if n not in close and n not in apart]
    return (*close, *alike)


def _as_good(mine: Carried, its: Carried) -> bool:
    """Whether another effect carries over as well as far as these blocks can tell."""
    if not 0.0 < its.ratio < mine.ratio**RIVAL:
        return False
    return as_good(mine.after, its.after)
