"""What numbers, names and texts of a file may be, each checked where it stands."""

from datetime import datetime
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, AllowInfNan, Field, Strict

from trialid.errors import nearest
from trialid.ingest.times.local_time import known_zone
from trialid.names import units
from trialid.pipeline_file.section import Number, Positive


def _rising(interval: tuple[float, float]) -> tuple[float, float]:
    low, high = interval
    if not low < high:
        raise ValueError(f"[{low:g}, {high:g}] runs backwards; write [low, high]")
    return interval


def _unit_text(unit: str) -> str:
    if unit == "?":
        raise ValueError("is still open; write the unit, like deg/s, m/s or kn")
    if units.TEXT.fullmatch(unit) is None:
        raise ValueError(f"{unit!r} is not a unit; write it like deg/s, m/s or kg*m^2")
    return unit


def with_value(given: Any) -> Any:
    """Give a bare number as a value without a unit."""
    return given if isinstance(given, dict) else {"value": given}


def with_path(given: Any) -> Any:
    """Give a bare path as a log with nothing else said of it."""
    return {"path": given} if isinstance(given, str) else given


def not_zero(number: float) -> float:
    """Give a gain that leaves something of the signal."""
    if number == 0.0:
        raise ValueError("a gain of zero leaves nothing of the signal")
    return number


def _through_points(points: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    """Give a curve that tells one value for each logged number, and not the same for all."""
    logged = [x for x, _ in points]
    if any(after <= x for x, after in pairwise(logged)):
        raise ValueError("the logged numbers must rise from point to point; write [logged, signal]")
    if len({y for _, y in points}) < 2:
        raise ValueError("two points or more of different signals make a curve")
    return points


def _countable(period: float) -> float:
    if period < 1e-12:
        raise ValueError(f"{period:g} s are less than any clock tells apart")
    return period


def candidate_names(given: Any) -> Literal["all", "none"] | tuple[str, ...]:
    """Give a word for many effects, or their names."""
    if given in ("all", "none"):
        return given
    if isinstance(given, list) and all(isinstance(name, str) for name in given):
        return tuple(given)
    hint = nearest(str(given), ("all", "none"))
    raise ValueError(f'must be "all", "none" or a list of effects, got {given!r} ({hint})')


Count = Annotated[int, Strict(), Field(ge=1)]
Rounds = Annotated[Count, Field(le=10_000)]
"""Of searches, steps or shares of a sample; ten thousand of any take hours."""
Seconds = Annotated[Number, Field(ge=-1e10, le=1e10)]
"""Three hundred years either way: a clock that was never set lies fifty off."""
Delay = Annotated[Number, Field(ge=-3600.0, le=3600.0)]
"""An hour: no sensor is later, and a clock that is has an offset."""
Period = Annotated[Positive, Field(le=1e6), AfterValidator(_countable)]
"""So that samples can be counted; whether there are too many or too few is said with the record."""
Factor = Annotated[Number, Field(ge=-1e15, le=1e15)]
"""Of counts of any width to a unit; beyond, the square of a value overflows in a sum."""
Curve = Annotated[tuple[tuple[Factor, Factor], ...], AfterValidator(_through_points)]
Whole = Annotated[int, Strict(), Field(ge=0)]
Unit = Annotated[str, AfterValidator(_unit_text)]
Names = tuple[str, ...]
SomeNames = Annotated[Names, Field(min_length=1)]
Zone = Annotated[str, AfterValidator(known_zone)]
Instant = Number | datetime
NotEmpty = Annotated[str, Field(min_length=1)]
Window = Annotated[tuple[Seconds, Seconds], AfterValidator(_rising)]
Limit = Annotated[Number, AllowInfNan(True)]
Bounds = Annotated[tuple[Limit, Limit], AfterValidator(_rising)]
Fault = Literal["range", "dropouts", "spikes", "saturation", "stuck"]
Nuisance = Literal["initial_state", "bias", "rudder_offset", "delay", "current"]
