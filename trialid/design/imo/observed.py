"""Overshoots of the zig-zags that a record holds, measured beside those of the fitted model."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.design.imo.trial_numbers import Overshoot
from trialid.identification.fit import Fit
from trialid.identification.trial_score import Score

PLATEAU: Final = 0.7
"""Share of the largest rudder angle that both sides of a reversal must reach."""
LEAVES: Final = 0.9
"""Share of its angle below which the rudder has left it: the order was given."""
FEWEST: Final = 2
"""Reversals from which a record is a zig-zag."""


def overshoots(fit: Fit) -> tuple[Overshoot, ...]:
    """Every overshoot in every trial that is a zig-zag; none where r is no output."""
    if "r" not in fit.problem.outputs:
        return ()
    place = fit.problem.outputs.index("r")
    return tuple(one for score in fit.scores for one in _of_trial(score, place))


def _of_trial(score: Score, place: int) -> Iterator[Overshoot]:
    trial = score.trial
    rudder = trial.signals.get("delta", trial.signals.get("delta_order"))
    if rudder is None:
        return
    reversals = _reversals(rudder)
    if len(reversals) < FEWEST:
        return
    ends = [*(k for k, _ in reversals[1:]), len(rudder) - 1]
    for (k, angle), end in zip(reversals, ends, strict=True):
        compared = score.compared[k : end + 1, place]
        recorded = _beyond(trial.signals["r"][k : end + 1], angle, trial.period, compared)
        simulated = _beyond(score.response.y[k : end + 1, place], angle, trial.period, compared)
        if recorded is not None and simulated is not None:
            yield Overshoot(
                trial=trial.name,
                t=k * trial.period,
                rudder=angle,
                measured=recorded,
                predicted=simulated,
            )


def _reversals(rudder: Vector) -> list[tuple[int, float]]:
    """Samples at which the rudder leaves an angle for the other side, and that angle [rad]."""
    largest = float(np.quantile(np.abs(rudder), 0.95))
    high = np.flatnonzero(np.abs(rudder) >= PLATEAU * largest)
    if largest <= 0.0 or not len(high):
        return []
    turns = np.flatnonzero(rudder[high][1:] * rudder[high][:-1] < 0.0)
    found = []
    for i in turns:
        last = int(high[i])
        begin = last
        while (
            begin > 0
            and rudder[begin - 1] * rudder[last] > 0.0
            and (abs(rudder[begin]) < LEAVES * largest)
        ):
            begin -= 1
        found.append((begin, float(rudder[begin])))
    return found


def _beyond(r: Vector, angle: float, period: float, compared: Mask) -> float | None:
    """Largest change of the heading to the side of the old rudder; None where it is not seen."""
    if len(r) < 3 or not compared.all():
        return None
    turned = np.concatenate([[0.0], np.cumsum((r[1:] + r[:-1]) / 2.0) * period]) * np.sign(angle)
    peak = int(np.argmax(turned))
    return float(turned[peak]) if 0 < peak < len(turned) - 1 else None
