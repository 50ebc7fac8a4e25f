"""Where each signal of a trial comes from, as the user states it, and finding it in the logs."""

import difflib
import itertools
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from trialid.errors import AlignmentError, LogError, nearest
from trialid.recording import Channel, Recording


@dataclass(frozen=True)
class SignalSource:
    """One signal of a trial: which channel of the logs it is, and how to read it.

    Parameters
    ----------
    quantity
        Name in the dictionary of quantities: `delta`, `r`, `phi`.
    channel
        Name of the channel in the logs; with `as_`, of the quaternion whose fields are x, y, z, w.
    unit
        Unit of the channel; None when the log states it, and with `as_`.
    positive
        Side the logged number is positive to; None where the quantity has no side, and where the
        log follows our own direction (starboard). The rudder's must be stated.
    as_
        Which angle of a quaternion is meant; None for a plain number.
    delay
        How much later than the motion the sensor stamps it [s].
    gain, offset
        The signal is gain times the logged number plus offset, in `unit`.
    """

    quantity: str
    channel: str
    unit: str | None = None
    positive: Literal["starboard", "port"] | None = None
    as_: Literal["roll", "pitch", "yaw"] | None = None
    delay: float = 0.0
    gain: float = 1.0
    offset: float = 0.0


def find(channel: str, recordings: Sequence[Recording], where: str) -> Channel:
    """The channel of that name, from whichever log of the trial holds it.

    Logs of one trial that follow one another, as recorders split them by the hour, are joined.
    LogError when no log holds it, AlignmentError when two hold it for the same time.
    """
    holding = [recording for recording in recordings if channel in recording.channels]
    if not holding:
        raise LogError(
            f"{where}: no channel {channel!r} in {_files(recordings)}; {_like(channel, recordings)}"
        )
    parts = sorted((r.channels[channel] for r in holding), key=_first)
    for early, late in itertools.pairwise(parts):
        if len(early.t) and len(late.t) and late.t.min() <= early.t.max():
            raise AlignmentError(
                f"{where}: channel {channel!r} is in {_files(holding)} for the same time; "
                "name only one of these logs, or take the signal from another channel"
            )
    return parts[0] if len(parts) == 1 else _joined(parts, where)


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
    clocks = ", ".join(dict.fromkeys(part.clock for part in parts))
    t = np.concatenate([part.t for part in parts])
    y = np.concatenate([part.y for part in parts])
    return Channel(parts[0].name, t, y, parts[0].unit, clocks)


def _files(recordings: Sequence[Recording]) -> str:
    return " or ".join(recording.path.name for recording in recordings) or "any log: none is named"


def _like(channel: str, recordings: Sequence[Recording]) -> str:
    """The nearest names; of a log with a hundred channels not all the others."""
    names: Collection[str] = {name for r in recordings for name in r.channels}
    return nearest(channel, difflib.get_close_matches(channel, names, n=8, cutoff=0.0))
