"""What the manoeuvres of a trial come to, as recorded and as the fitted model has them.

They are rows of a result as they stand; nothing heavy is imported with them.
"""

from dataclasses import dataclass

Range = tuple[float, float]
"""Ends of a 95 % interval."""


@dataclass(frozen=True, kw_only=True)
class Manoeuvre:
    """A manoeuvre recognised in a trial: order and end [s], angle held [rad], what it lacks.

    Attributes
    ----------
    course, speed
        Heading [rad] and speed [m/s] over the length before the order; None where not recorded.
    speed_by
        What tells the speed: its log, or the track over the ground, or either less the current.
    """

    trial: str
    kind: str
    t: float
    end: float
    rudder: float
    course: float | None = None
    speed: float | None = None
    speed_by: str = ""
    remark: str = ""


@dataclass(frozen=True, kw_only=True)
class ManoeuvreNumber:
    """A number of a manoeuvre that is no turning circle, in `unit`, and the fitted model's.

    Each with its 95 %. `predicted` is under the rudder as recorded; None where nothing is known to
    predict it from. What is read from the track is corrected as that of a turn is; overshoots for
    wind alone, as a current turns no ship; rates of pull-outs and spirals for nothing.
    """

    trial: str
    kind: str
    t: float
    rudder: float
    name: str
    unit: str
    measured: float
    interval: Range
    corrected: float | None = None
    corrected_interval: Range | None = None
    corrected_for: str = ""
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
        The same without what `corrected_for` names: through the water by the current that the fit
        found, and less what the fitted model drifts by the wind, where it has one.
    predicted, predicted_interval
        Of the fitted model through the water, without the wind where it has one, under the rudder
        as recorded, and where that of a single run of the true ship is likely to lie.
    """

    trial: str
    t: float
    rudder: float
    name: str
    measured: float
    interval: Range
    corrected: float | None = None
    corrected_interval: Range | None = None
    corrected_for: str = ""
    predicted: float | None = None
    predicted_interval: Range | None = None
