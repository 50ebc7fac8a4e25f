"""Whether a rate that is fitted is the slope of its angle: a hull takes up what a sensor does.

A rate of turn that comes 4 s late, or reads 0.9 of what it is, fits a hull that is another: of two
strangers' ships effects of the rudder were named, and half of the overshoots that were foretold
missed the truth, while the heading beside it told the delay to 0.1 s. No sensor is early, so that
of two the later one is late; and over whole turns no compass is wrong by a factor.
"""

from typing import Final

import numpy as np

from trialid.diagnosis.found_values import SLOW
from trialid.diagnosis.records.rudder_jumps import own_time
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect
from trialid.trial import Contradiction

MOSTLY: Final = 0.5
"""Share of the trials in which it has to be seen: in a single one it may be of that trial. Half of
it and twice say the same of those two ships, whose trials all show it."""


def contradictions(fit: Fit, named: Effect | None = None) -> tuple[Contradiction, ...]:
    """What rates and angles of most trials contradict each other in, by enough to be a hull's.

    Nothing of an output whose sensor has an effect in the model, or one that is `named`.
    """
    effects = (*fit.model.effects, *filter(None, [named]))
    measured = {s for e in effects for s in e.measures}
    outputs = {*fit.problem.outputs} - measured
    found = [c for t in fit.trials for c in t.contradictions if _wrong(c) in outputs]
    able = [c for c in found if c.factor != 1.0 or c.drift or abs(c.late) > SLOW * own_time(fit)]
    alike = ([c for c in able if _kind(c) == kind] for kind in dict.fromkeys(map(_kind, able)))
    return tuple(_middle(some) for some in alike if len(some) >= MOSTLY * len(fit.trials))


def rate_in_doubt(fit: Fit, named: Effect | None = None) -> str | None:
    """What the rates and angles leave open, and how to settle it; None where they agree."""
    found = contradictions(fit, named)
    return "; ".join(c.sentence for c in found) or None


def _kind(one: Contradiction) -> tuple[str, bool, bool]:
    """Which of the two it is, and whether by a factor or a drift."""
    return _wrong(one), one.factor == 1.0, one.drift == 0.0


def _wrong(one: Contradiction) -> str:
    """Which of the two it is: the later one, or the rate where it is wrong by a factor."""
    return one.angle if one.late < 0.0 else one.rate


def _middle(some: list[Contradiction]) -> Contradiction:
    """Of the same contradiction in several trials the one in the middle."""
    order = np.argsort([(c.late + c.drift) * c.factor for c in some], kind="stable")
    return some[int(order[len(order) // 2])]
