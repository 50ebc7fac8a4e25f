"""Whether a rate that is fitted is the slope of its angle: a hull takes up what a sensor does.

A rate of turn that comes 4 s late, or reads 0.9 of what it is, fits a hull that is another: of two
strangers' ships effects of the rudder were named, and half of the overshoots that were foretold
missed the truth, while the heading beside it told the delay to 0.1 s. No sensor is early, so that
of two the later one is late; and over whole turns no compass is wrong by a factor.
"""

from collections.abc import Sequence

import numpy as np

from trialid.diagnosis.found_values import SLOW
from trialid.diagnosis.records.rudder_jumps import own_time
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect
from trialid.trial import Contradiction


def rate_in_doubt(fit: Fit, named: Effect | None = None, held: str | None = None) -> str | None:
    """What rates and angles of fitted trials contradict each other in, and how to settle it.

    None where they agree, by all that a hull would take up. Of a single trial, too: where one gyro
    of three read 1.1 and 1.2 of what it is, or came 4 s late, a rudder's effect was named. Nothing
    of an output whose sensor has an effect in the model, or one that is `named`. Of a trial that is
    `held` out in place of them, where one is given.
    """
    effects = (*fit.model.effects, *filter(None, [named]))
    measured = {s for e in effects for s in e.measures}
    outputs = {*fit.problem.outputs} - measured
    trials = [t for t in fit.trials if (t.name == held if held else t.use == "fit")]
    found = [(c, t.name) for t in trials for c in t.contradictions]
    able = [(c, name) for c, name in found if _wrong(c) in outputs and _is_a_hulls(fit, c)]
    kinds = dict.fromkeys(_kind(c) for c, _ in able)
    alike = ([one for one in able if _kind(one[0]) == kind] for kind in kinds)
    everywhere = 0 if held else len(trials)
    return "; ".join(_told(some, everywhere) for some in alike) or None


def _is_a_hulls(fit: Fit, one: Contradiction) -> bool:
    """Whether it is by so much that a hull would be another for it."""
    return one.factor != 1.0 or one.drift != 0.0 or abs(one.late) > SLOW * own_time(fit)


def _told(alike: Sequence[tuple[Contradiction, str]], everywhere: int) -> str:
    """The one in the middle, and where it is seen if not in so many trials, which are all."""
    sentence, names = _middle([one for one, _ in alike]).sentence, [name for _, name in alike]
    return sentence if len(names) == everywhere else f"in {', '.join(names)} {sentence}"


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
