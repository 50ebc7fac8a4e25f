"""Frames to channels by a DBC file, the user's own description of a CAN bus, in columns.

A channel is `Message:signal` with the unit the file states; where frames of several buses are
described it is `Message/can1:signal`. A multiplexed signal has samples where its multiplexer says
so. Every number the file lets a signal have is one: DBC knows no code for `not available`.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError, reason_of
from trialid.ingest.adapter import Wanted, is_wanted
from trialid.ingest.can.can_frames import Frames, select_frames
from trialid.recording import Channel

if TYPE_CHECKING:
    from cantools.database.can import Message, Signal

Raw = NDArray[np.int64]

MOST_BYTES = 16_000_000
"""Of a DBC file; those of whole truck fleets have a few."""
FLOATS = {16: "<f2", 32: "<f4", 64: "<f8"}
"""Kinds of floating point numbers by their bits."""


def channels(
    frames: Frames, dbc: Path, clock: str, wanted: Wanted
) -> tuple[dict[str, Channel], list[str]]:
    """Channels of the frames the file describes, and remarks.

    Raises LogError when the file is missing or no DBC, when cantools is not installed, and when
    the file describes none of the frames.
    """
    messages = _messages(dbc)
    order = np.argsort(frames.can_id, kind="stable")
    parts = [
        (message, part) for message in messages if len(part := _frames_of(message, frames, order))
    ]
    if not parts:
        raise LogError(
            f"{dbc}: describes none of the log's {len(frames)} frames (identifiers "
            f"{_some(frames)}); is it the file of another bus?"
        )
    several = len(np.unique(np.concatenate([part.bus for _, part in parts]))) > 1
    found: dict[str, Channel] = {}
    remarks: list[str] = []
    for message, part in parts:
        for bus in np.unique(part.bus).tolist() if several else [0]:
            one = select_frames(part, part.bus == bus) if several else part
            place = f"{message.name}/{part.buses[bus]}" if several else message.name
            for channel in _of_message(message, one, place, clock, wanted, remarks):
                found[channel.name] = channel
    described = sum(len(part) for _, part in parts)
    if described < len(frames):
        rest = len(frames) - described
        remarks.append(f"{rest} of {len(frames)} frames are not described in {dbc.name}")
    return found, remarks


def _messages(dbc: Path) -> Sequence["Message"]:
    try:
        import cantools
    except ImportError as error:
        raise LogError(
            f"{dbc}: reading frames by a DBC file needs cantools; pip install 'trialid[dbc]'"
        ) from error
    try:
        size = dbc.stat().st_size
        if size > MOST_BYTES:
            raise LogError(
                f"{dbc}: {size / 1e6:.0f} MB; a description of a bus of up to "
                f"{MOST_BYTES / 1e6:.0f} MB is read: leave out what the log does not hold"
            )
        raw = dbc.read_bytes()
    except OSError as error:
        raise LogError(f"{dbc}: cannot be read as a DBC file, {error.strerror}") from error
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("cp1252", "replace")
    try:
        database = cantools.database.load_string(text, "dbc", strict=False)
    except cantools.Error as error:
        raise LogError(
            f"{dbc}: is no DBC file that can be read: {reason_of(error)}; export it anew"
        ) from error
    return getattr(database, "messages", ())


def _frames_of(message: "Message", frames: Frames, order: NDArray[np.int64]) -> Frames:
    """The frames of a message, as logged."""
    ids = message.frame_id
    first, last = np.searchsorted(frames.can_id, [ids, ids + 1], sorter=order)
    rows = order[first:last]
    return select_frames(frames, rows[frames.extended[rows] == message.is_extended_frame])


def _some(frames: Frames) -> str:
    ids = [f"0x{one:X}" for one in np.unique(frames.can_id)[:4].tolist()]
    return ", ".join(ids)


def _of_message(
    message: "Message", frames: Frames, place: str, clock: str, wanted: Wanted, remarks: list[str]
) -> Iterator[Channel]:
    short = int(np.sum(frames.length < message.length))
    if short and is_wanted(place, wanted):
        words = f"{short} of {len(frames)} frames are shorter than its {message.length} bytes"
        remarks.append(f"{place}: {words}, the signals they lack are left out")
    for signal in message.signals:
        name = f"{place}:{signal.name}"
        if not is_wanted(name, wanted):
            continue
        if not _fits(signal):
            remarks.append(f"{name}: {signal.length} bits from bit {signal.start} are no number")
            continue
        rows = np.flatnonzero(_holds(signal, message, frames))
        if not len(rows):
            continue
        y = _numbers(signal, select_frames(frames, rows))
        comment = f", {signal.comment}" if signal.comment else ""
        words = f"frame 0x{message.frame_id:X} {message.name}, signal {signal.name}{comment}"
        unit = signal.unit or None
        yield Channel(name, frames.t[rows], y, unit, clock, " ".join(words.split()))


def _fits(signal: "Signal") -> bool:
    """True when the signal lies within 8 bytes and, with floating point, has a length it can."""
    sized = signal.length in FLOATS if signal.is_float else signal.length > 0
    return sized and signal.start >= 0 and _last_byte(signal) < 8


def _holds(
    signal: "Signal", message: "Message", frames: Frames, depth: int = 0
) -> NDArray[np.bool_]:
    """Which frames are long enough for the signal and, by the multiplexer, hold it."""
    there = frames.length >= _last_byte(signal) + 1
    if signal.multiplexer_signal is None or not signal.multiplexer_ids:
        return there
    switches = {one.name: one for one in message.signals if _fits(one)}
    switch = switches.get(signal.multiplexer_signal)
    if switch is None or depth > len(switches):  # the file names one that is not, or itself
        return np.zeros(len(frames), np.bool_)
    there &= _holds(switch, message, frames, depth + 1)
    return there & np.isin(_raw(switch, frames), signal.multiplexer_ids)


def _last_byte(signal: "Signal") -> int:
    if signal.byte_order == "little_endian":
        return (signal.start + signal.length - 1) // 8
    before = 8 * (signal.start // 8) + 7 - signal.start % 8
    return (before + signal.length - 1) // 8


def _raw(signal: "Signal", frames: Frames) -> Raw:
    """Whole numbers as they stand in the frames; (n,)."""
    table = np.ascontiguousarray(frames.table)
    if signal.byte_order == "little_endian":
        word, low = table.view("<u8")[:, 0], signal.start
    else:
        word = table.view(">u8")[:, 0].astype(np.uint64)
        low = 64 - (8 * (signal.start // 8) + 7 - signal.start % 8) - signal.length
    high = np.uint64(64 - low - signal.length)
    moved = word << high  # the highest bit of the signal is now that of the word
    if signal.is_signed and not signal.is_float:
        return moved.view(np.int64) >> np.int64(64 - signal.length)
    return (moved >> np.uint64(64 - signal.length)).view(np.int64)


def _numbers(signal: "Signal", frames: Frames) -> NDArray[np.float64]:
    """Physical numbers; (n,)."""
    raw = _raw(signal, frames)
    if signal.is_float:
        kind = np.dtype(FLOATS[signal.length])
        y = raw.astype(f"<u{kind.itemsize}").view(kind).astype(np.float64)
    elif signal.is_signed:
        y = raw.astype(np.float64)
    else:
        y = raw.view(np.uint64).astype(np.float64)
    return y * float(signal.scale) + float(signal.offset)
