"""What a log holds: channels, each on its own clock, as they were logged."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from trialid.errors import printable

OF_TEXT: Final = "holds text, left out"
"""How a recording's remark says that a column is no signal, as a rudder in words is none."""

ZONELESS: Final = "taken as UTC"
"""How the words of a clock say that its dates may be of any zone."""


@dataclass(frozen=True)
class Channel:
    """One logged column on its own clock.

    Parameters
    ----------
    name
        What a pipeline writes as `channel`: `/imu:angular_velocity.z`, `rudder`.
    t
        Time stamps [ns], any origin, in the order of the log; (N,) int64.
    y
        Values as logged, no unit conversion, NaN where the log says `not available`; (N,).
    unit
        The unit the log itself states, or None when it states none.
    clock
        Which of a message's times `t` is, in words for the report: `header stamp`, `column t`.
    description
        What the format says it is, in words: `PGN 127245 rudder, source 11, instance 0, position`.
    quantity
        Name in the dictionary of quantities, where the format itself defines which it is.
    positive
        The side the format's own convention counts as positive, where it has one. What boats
        really send is another matter: the pipeline states the side.
    received
        When the recorder got the samples [ns], where `t` is another time; (N,).
    """

    name: str
    t: NDArray[np.int64]
    y: NDArray[np.float64]
    unit: str | None = None
    clock: str = ""
    description: str = ""
    quantity: str | None = None
    positive: Literal["starboard", "port"] | None = None
    received: NDArray[np.int64] | None = None

    def __post_init__(self) -> None:
        for array in (self.t, self.y, self.received):
            if array is not None:
                array.setflags(write=False)


@dataclass(frozen=True)
class Recording:
    """All channels read from one log file, with remarks on what was found while reading."""

    path: Path
    adapter: str
    sha256: str
    channels: Mapping[str, Channel]
    remarks: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        """Remarks quote what the log holds, which anybody may have written."""
        object.__setattr__(self, "remarks", tuple(printable(one) for one in self.remarks))
