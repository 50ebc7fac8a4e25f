"""Where each signal of a trial comes from, as the user states it, and finding it in the logs."""

import difflib
import itertools
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from trialid.errors import AlignmentError, LogError, nearest
from trialid.names.quantities import Quantity
from trialid.recording import Channel, Recording

Number = TypeVar("Number", np.int64, np.float64)


SEAM = 20
"""Samples that two files of one recorder may both hold where one ends and the next begins, ..."""
SEAM_SHARE = 0.05
"""... and their share of the shorter file."""


@dataclass(frozen=True)
class SignalSource:
    """One signal of a trial: which channel of the logs it is, and how to read it.

    Parameters
    ----------
    quantity
        Name in the dictionary of quantities: `delta`, `r`, `phi`.
    channel
        Name of the channel in the logs; with `as_`, of the quaternion whose fields are x, y, z, w,
        or of the velocity whose fields are x and y.
    unit
        Unit of the channel; None when the log states it, and with `as_` of an angle.
    positive
        Side the logged number is positive to; None where the quantity has no side, and where the
        log follows our own direction (starboard). The rudder's must be stated.
    as_
        Which angle of a quaternion, or speed or course of a velocity; None for a plain number.
    delay
        How much later than the motion the sensor stamps it [s].
    gain, offset
        The signal is gain times the logged number plus offset, in `unit`.
    curve
        In their place points of logged number and signal, straight lines between them, in `unit`;
        beyond the ends the signal is not known.
    combine
        "mean" where the quantity is the mean of several sources, each with this; else None.
    of
        What the quantity is, where it is in no dictionary: an actuator's signal, or one's own.
    """

    quantity: str
    channel: str
    unit: str | None = None
    positive: Literal["starboard", "port"] | None = None
    as_: Literal["roll", "pitch", "yaw", "speed", "course"] | None = None
    delay: float = 0.0
    gain: float = 1.0
    offset: float = 0.0
    curve: tuple[tuple[float, float], ...] | None = None
    combine: Literal["mean"] | None = None
    of: Quantity | None = None

    @property
    def name(self) -> str:
        """The quantity, with the channel where that alone does not tell which source it is."""
        return f"{self.quantity!r} ({self.channel})" if self.combine else f"{self.quantity!r}"


def find(channel: str, recordings: Sequence[Recording], where: str) -> Channel:
    """The channel of that name, from whichever log of the trial holds it.

    Logs of one trial that follow one another, as recorders split them by the hour, are joined; a
    few samples that two files of one recorder both hold at their seam are taken from the first.
    LogError when no log holds it, AlignmentError when two hold it for the same time.
    """
    logs = [recording for recording in recordings if channel in recording.channels]
    if not logs:
        raise LogError(
            f"{where}: no channel {channel!r} in {_files(recordings)}; {_like(channel, recordings)}"
        )
    logs = sorted(logs, key=lambda log: _first(log.channels[channel]))
    parts = [log.channels[channel] for log in logs]
    for early, late in itertools.pairwise(logs):
        if _overlap(early, late, channel) and not _seam(early, late, channel):
            raise AlignmentError(
                f"{where}: channel {channel!r} is in {_files(logs)} for the same time; "
                "name only one of these logs, or take the signal from another channel"
            )
    return parts[0] if len(parts) == 1 else _joined(parts, where)


def log_with(source: SignalSource, recordings: Sequence[Recording]) -> str:
    """Name of the first log that holds a signal's channel."""
    names = {source.channel, f"{source.channel}.w"}
    return next((r.path.name for r in recordings if names & r.channels.keys()), "a log")


def seams(channel: str, recordings: Sequence[Recording]) -> Iterator[str]:
    """Remarks on files of one recorder that hold a few samples of the other's time."""
    logs = [recording for recording in recordings if channel in recording.channels]
    logs = sorted(logs, key=lambda log: _first(log.channels[channel]))
    for early, late in itertools.pairwise(logs):
        if count := _overlap(early, late, channel):
            yield (
                f"{channel}: {early.path.name} and {late.path.name} overlap by {count} samples at "
                "the seam; joined, the first file's stay"
            )


def _overlap(early: Recording, late: Recording, channel: str) -> int:
    """Samples of the later file not after the end of the earlier one."""
    a, b = early.channels[channel], late.channels[channel]
    return int(np.sum(b.t <= a.t.max())) if len(a.t) and len(b.t) else 0


def _seam(early: Recording, late: Recording, channel: str) -> bool:
    """True of files that one recorder wrote one after the other."""
    a, b = early.channels[channel], late.channels[channel]
    behind = int(np.sum(a.t >= b.t.min()))
    longest = SEAM_SHARE * min(len(a.t), len(b.t))
    same = early.adapter == late.adapter and (a.unit, a.clock) == (b.unit, b.clock)
    return same and max(behind, _overlap(early, late, channel)) <= min(SEAM, longest)


def _first(channel: Channel) -> int:
    return int(channel.t.min()) if len(channel.t) else 0


def _joined(parts: Sequence[Channel], where: str) -> Channel:
    units = {part.unit for part in parts}
    if len(units) > 1:
        stated = " and ".join(str(unit) for unit in sorted(units, key=str))
        raise AlignmentError(
            f"{where}: the logs state different units for {parts[0].name!r}: {stated}; "
            "use logs of one recorder setting"
        )
    ends = itertools.accumulate((_last(part) for part in parts), max)
    after = [np.ones(len(parts[0].t), np.bool_)]
    after += [part.t > end for part, end in zip(parts[1:], ends, strict=False)]
    received = [part.received for part in parts]
    return replace(
        parts[0],
        t=_together([part.t for part in parts], after),
        y=_together([part.y for part in parts], after),
        clock=", ".join(dict.fromkeys(part.clock for part in parts)),
        received=_together([r for r in received if r is not None], after)
        if all(r is not None for r in received)
        else None,
    )


def _last(channel: Channel) -> int:
    return int(channel.t.max()) if len(channel.t) else np.iinfo(np.int64).min


def _together(
    parts: Sequence[NDArray[Number]], use: Sequence[NDArray[np.bool_]]
) -> NDArray[Number]:
    return np.concatenate([part[here] for part, here in zip(parts, use, strict=True)])


def _files(recordings: Sequence[Recording]) -> str:
    return " or ".join(recording.path.name for recording in recordings) or "any log: none is named"


def _like(channel: str, recordings: Sequence[Recording]) -> str:
    """The nearest names; of a log with a hundred channels not all the others."""
    names: Collection[str] = {name for r in recordings for name in r.channels}
    return nearest(channel, difflib.get_close_matches(channel, names, n=8, cutoff=0.0))
