"""Rows of the standard measures: predicted, and measured in the trials."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from trialid.design.imo.trial_numbers import Manoeuvre, ManoeuvreNumber, Overshoot, TurnMeasure


@dataclass(frozen=True, kw_only=True)
class MeasureRow:
    """A standard measure of the fitted ship beside what is allowed.

    `remark` says why there is no value.
    """

    name: str
    unit: str
    value: float | None = None
    interval: tuple[float | None, float | None] | None = None
    allowed: float | None = None
    kept: bool | None = None
    manoeuvre: str = ""
    remark: str = ""


@dataclass(frozen=True, kw_only=True)
class ConditionRow:
    """What a signal of a trial was like, SI: its median, and where 95 % of its samples lie."""

    trial: str
    signal: str
    median: float
    interval: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class SailedPart:
    """How the fitted ship is sailed where she is predicted; SI.

    Attributes
    ----------
    speed
        Of the approach.
    rudder_rate
        As the trials show it; None where the model has a steering gear of its own.
    constants
        Recorded signals that stay as they were, by name.
    speed_lost
        By what numbers the logged speed fell in turns; empty where the model says itself what
        turning costs.
    rudders_zero
        What her rudder stands off its record by, over the trials; None where no trial has its own.
    """

    speed: float
    rudder_rate: float | None = None
    constants: Mapping[str, float] = field(default_factory=dict)
    speed_lost: Mapping[str, float] = field(default_factory=dict)
    rudders_zero: float | None = None


@dataclass(frozen=True, kw_only=True)
class SteeringRow:
    """One of Nomoto's numbers at the approach speed, of the ship as fitted, and its 95 % range."""

    name: str
    value: float
    unit: str
    likely: tuple[float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class ImoPart:
    """Standard measures of MSC.137(76), and overshoots and turning circles the trials hold.

    Attributes
    ----------
    sailed
        How the measures were come by, in a sentence.
    doubt
        Why they are not to be relied on; empty where nothing speaks against them.
    steering
        Nomoto's numbers; empty where no rudder steers her.
    """

    measures: tuple[MeasureRow, ...] = ()
    speed_simulated: bool = False
    overshoots: tuple[Overshoot, ...] = ()
    turns: tuple[TurnMeasure, ...] = ()
    conditions: tuple[ConditionRow, ...] = ()
    manoeuvres: tuple[Manoeuvre, ...] = ()
    measured: tuple[ManoeuvreNumber, ...] = ()
    sailed: str = ""
    doubt: str = ""
    steering: tuple[SteeringRow, ...] = ()
