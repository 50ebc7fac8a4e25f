"""What is recognised in a record: the kind of a manoeuvre, and the samples it spans."""

from dataclasses import dataclass
from typing import Literal

Steered = Literal["turning circle", "turn", "zig-zag", "pull-out", "spiral", "Williamson turn"]
Kind = Steered | Literal["stop"]


@dataclass(frozen=True, kw_only=True)
class Recognised:
    """A manoeuvre: samples from the order on, `end` one past the last.

    Attributes
    ----------
    reversals
        Samples at which the rudder was ordered over, of a zig-zag or Williamson turn; else empty.
    steady
        The sample from which she kept the new course, of a Williamson turn; else None.
    rudder
        First angle held [rad], zero for a stop.
    course
        Mean heading before the order [rad].
    remark
        What it lacks; empty where it is whole.
    """

    kind: Kind
    execute: int
    end: int
    rudder: float
    course: float
    reversals: tuple[int, ...] = ()
    steady: int | None = None
    remark: str = ""
