"""What the manoeuvres of a trial come to, as recorded and as the fitted model has them.

They are rows of a result as they stand; nothing heavy is imported with them.
"""

from dataclasses import dataclass

Range = tuple[float, float]
"""Ends of a 95 % interval."""


@dataclass(frozen=True, kw_only=True)
class Manoeuvre:
    """A manoeuvre recognised in a trial: order and end [s], angle held [rad], what it lacks."""

    trial: str
    kind: str
    t: float
    end: float
    rudder: float
    remark: str = ""


@dataclass(frozen=True, kw_only=True)
class ManoeuvreNumber:
    """A number of a zig-zag, pull-out or spiral in `unit`, and the fitted model's, each with 95 %.

    `predicted` is under the rudder as recorded; None where nothing is known to predict it from.
    """

    trial: str
    kind: str
    t: float
    rudder: float
    name: str
    unit: str
    measured: float
    interval: Range
    predicted: float | None = None
    predicted_interval: Range | None = None


@dataclass(frozen=True, kw_only=True)
class Overshoot:
    """How far the heading went on after a reversal of the rudder at `t` [s]; [rad].

    Both are integrals of the rate of turn, with the sensor's bias in it.
    """

    trial: str
    t: float
    rudder: float
    measured: float
    predicted: float


@dataclass(frozen=True, kw_only=True)
class TurnMeasure:
    """One measure of a turn [m]; None where there is nothing to know it from.

    Attributes
    ----------
    measured, interval
        As recorded, over the ground, with its 95 %: noise of position and heading, and half a
        sample of the order.
    corrected, corrected_interval
        The same through the water, by the current that the fit found, with its error.
    predicted, predicted_interval
        Of the fitted model through the water, under the rudder as recorded, and where the true
        ship's is likely to lie.
    """

    trial: str
    t: float
    rudder: float
    name: str
    measured: float
    interval: Range
    corrected: float | None = None
    corrected_interval: Range | None = None
    predicted: float | None = None
    predicted_interval: Range | None = None
