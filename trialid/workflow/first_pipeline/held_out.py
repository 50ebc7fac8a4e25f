"""Which of several trials is held out: one that lies within what the others tried."""

from collections.abc import Sequence

import numpy as np

from trialid.errors import UnitError
from trialid.names import units
from trialid.names.quantities import SIGNALS
from trialid.workflow.first_pipeline.choice import RUDDERS, Chosen


def held_out(trials: Sequence[Chosen]) -> int | None:
    """Place of the trial in the middle by how far she was steered; None where there is but one.

    The largest is fitted: it shows most of what a ship does, and a model of the smaller ones alone
    would be asked for more than it has seen. Of an even number it is the smaller of the middle two.
    """
    if len(trials) < 2:
        return None
    order = sorted(range(len(trials)), key=lambda place: _travel(trials[place]))
    return order[(len(trials) - 1) // 2]


def middle_by(trials: Sequence[Chosen]) -> str:
    """What trials are put in order by, in words."""
    steered = trials[0].signals[0].quantity
    return "its rudder" if steered in RUDDERS else f"its {steered}"


def _travel(trial: Chosen) -> float:
    """How far what steers her went; in SI where its unit is known.

    A rudder by its greatest angle and its mean: a turn at 20 deg takes a ship further than a
    zig-zag of 20, and one at 35 further than any.
    """
    steering = trial.signals[0]
    source = steering.source
    unit = steering.unit or source.unit or source.unit_in_name
    try:
        factor = units.factor(unit or "", SIGNALS[steering.quantity].unit)
    except (UnitError, KeyError):  # asked for with the pipeline, or one of an actuator's own
        factor = 1.0
    if steering.quantity not in RUDDERS:
        return factor * (source.high - source.low)
    return factor * (max(abs(source.high), abs(source.low)) + abs(float(np.mean(source.sketch.y))))
