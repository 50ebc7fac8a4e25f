"""Whether the best effect stands in for another, which shows only once it is in the model.

Slopes are those of the model as it was fitted, and where much is missing that fit lies far from the
truth: a rudder in the race of a propeller had pushed the linear rudder's side force over to the
other side, there the race foretold 3 % of the squared error and a cubic rudder 16 %. Fitted, the
cubic takes 20 % off, and beside it the race stands out; fitted alone that takes 51 %. So what
explains much beside the best effect is fitted without it, and the better of the two is the best.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from trialid.diagnosis.search.augment import Augmented, Trace, augment
from trialid.diagnosis.search.carry_over import left_out
from trialid.diagnosis.search.refit import Progress, Refit, likeliest_refit, refit
from trialid.diagnosis.search.score import Candidate
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect

MOST: Final = 3
"""How often the best effect may give way: each takes the slopes of the whole catalogue anew."""


@dataclass(frozen=True)
class Beside:
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
    catalogue: Mapping[str, Effect],
    *,
    level: float,
    grown: bool,
    progress: Progress,
) -> Beside:
    """The refits, and what explains much beside the best of them fitted without it."""
    done = tuple(refits)
    for _ in range(MOST):
        best = likeliest_refit(fit, done, level, grown)
        if best is None:
            break
        progress(f"looking beside {best.candidate.effect.name}")
        augmented = augment(best.fit, catalogue)
        fitted = {r.candidate.effect.name for r in done}
        beside = _most_beside(augmented, [c for c in ranking if c.allowed])
        if beside is None or beside.effect.name in fitted:
            return Beside(done, best, augmented)
        del augmented  # of a long record there is no room for two
        more = refit(fit, [beside], progress)
        if not more:
            break
        done = (*done, *more)
    return Beside(done)


def _most_beside(augmented: Augmented, known: Sequence[Candidate]) -> Candidate | None:
    """The candidate that takes most off what is left of blocks left out, where that is much."""
    blocks = left_out(
        augmented.fit, augmented.residual, augmented.psi, augmented.S, augmented.stretches
    )
    by_name = {c.effect.name: c for c in known}

    def price(trace: Trace) -> float:
        return blocks.carried(trace.columns).price(len(trace.effect.parameters))

    tried = [t for t in augmented.traces if t.effect.name in by_name]
    most = min(tried, key=price, default=None)
    if most is None or not blocks.carried(most.columns).large:
        return None
    return by_name[most.effect.name]
