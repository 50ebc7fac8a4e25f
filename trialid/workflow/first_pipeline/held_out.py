"""Which of several trials is held out: one that lies within what the others tried."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.alignment.held_roll import STEERED
from trialid.errors import UnitError
from trialid.names import units
from trialid.names.quantities import SIGNALS
from trialid.workflow.first_pipeline.choice import RUDDERS
from trialid.workflow.first_pipeline.chosen import Chosen, Signal

ENOUGH: Final = 3
"""Steered trials of which one is held out beside others: two are left to fit, as one of two may be
a turn. Of twice as many, four zig-zags beside five decays a decay would be held out."""


def held_out(trials: Sequence[Chosen]) -> int | None:
    """Place of the trial in the middle by how far she was steered; None where there is but one.

    The largest is fitted: it shows most of what a ship does, and a model of the smaller ones alone
    would be asked for more than it has seen. Of an even number it is the smaller of the middle two.
    Of two it is the one that excites her less: a steady turn alone tells how fast she turns, and
    not how she comes to it. What nothing steers, roll decays beside zig-zags, says nothing of how
    she steers: three that are steered are enough to hold one of them out.
    """
    if len(trials) < 2:
        return None
    measure = _variation if len(trials) == 2 else _travel
    order = sorted(_tell_most(trials), key=lambda place: measure(trials[place]))
    return order[(len(order) - 1) // 2]


def why_held_out(trials: Sequence[Chosen]) -> str:
    """What makes it that one, in words that follow its name."""
    steered = trials[0].signals[0].quantity
    name = "rudder" if steered in RUDDERS else steered
    if len(trials) == 2:
        return f"the one whose {name} varies less"
    of_these = " of those that are steered," * (len(_tell_most(trials)) < len(trials))
    return f"the middle one{of_these} by its {name}"


def _tell_most(trials: Sequence[Chosen]) -> Sequence[int]:
    """Places of the trials one of which is held out: those that are steered, where they do."""
    steered = [place for place, trial in enumerate(trials) if _is_steered(trial)]
    return steered if len(steered) >= ENOUGH else range(len(trials))


def _is_steered(trial: Chosen) -> bool:
    """Whether a rudder goes further to a side than to keep a course; by other means, yes."""
    return not _by_angle(trial.signals[0]) or _travel(trial) > STEERED / 2.0


def _variation(trial: Chosen) -> float:
    """Standard deviation of what steers her; in SI where its unit is known."""
    if trial.window is not None:
        return trial.window.variation
    return _si(trial.signals[0]) * float(np.std(trial.signals[0].source.sketch.y))


def _travel(trial: Chosen) -> float:
    """How far what steers her went; in SI where its unit is known.

    A rudder by its greatest angle and its mean, whatever its name: a turn at 20 deg takes a ship
    further than a zig-zag of 20, and one at 35 further than any.
    """
    if trial.window is not None:
        return trial.window.travel
    steering = trial.signals[0]
    source, factor = steering.source, _si(steering)
    if not _by_angle(steering):
        return factor * (source.high - source.low)
    return factor * (max(abs(source.high), abs(source.low)) + abs(float(np.mean(source.sketch.y))))


def _by_angle(steering: Signal) -> bool:
    """Whether it steers by its angle, as rudders, nozzles and pods do."""
    return steering.quantity in RUDDERS or _factor(steering, "rad") is not None


def _si(steering: Signal) -> float:
    """What to multiply it by; 1 where the unit is asked for with the pipeline, or is its own."""
    known = SIGNALS.get(steering.quantity)
    return _factor(steering, known.unit if known else "rad") or 1.0


def _factor(steering: Signal, unit: str) -> float | None:
    try:
        own = steering.unit or steering.source.unit or steering.source.unit_in_name
        return units.factor(own or "", unit)
    except UnitError:
        return None
