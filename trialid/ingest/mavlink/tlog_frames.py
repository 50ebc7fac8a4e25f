"""The frames of a telemetry log: a time stamp of the recorder, then a MAVLink frame, and so on.

Every frame that is passed on has a valid checksum. Where frames do not follow one another exactly,
each place in the gap that may be a frame is tried.
Source: mavlink.io, packet serialization; the stamp is microseconds since 1970, big endian.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.bounds import check_whole
from trialid.ingest.bytes.linked_records import Places, Stretch, linked_starts
from trialid.ingest.bytes.unaligned import numbers
from trialid.ingest.mavlink import mavlink_crc
from trialid.ingest.mavlink.mavlink_dialect import Definition

STAMP = 8
MAGIC_1, MAGIC_2 = 0xFE, 0xFD
SIGNED = 0x01
SIGNATURE = 13
LATEST_US = 4_200_000_000_000_000
"""Stamps beyond the year 2103 are none."""
OUT_OF_ORDER_NS = 500_000_000
PAUSE_NS = 3600 * 10**9
"""No recorder falls silent for an hour after its first frame, or before its last."""
BLOCK = 2**21
"""Bytes looked at in one go: what is found in them stays in the processor's cache."""
LONGEST = 280
"""Bytes of a signed MAVLink 2 frame with the longest payload."""


@dataclass(frozen=True)
class Frames:
    """Frames by place, (N,) each: of the first byte and behind the last.

    `header` and `length` are the bytes before the payload and of it.
    """

    at: Places
    end: Places
    header: NDArray[np.uint8]
    length: NDArray[np.uint8]
    message: NDArray[np.int32]
    system: NDArray[np.uint8]
    component: NDArray[np.uint8]

    @property
    def payload(self) -> Places:
        """Place of the payload of each; (N,)."""
        return self.at + self.header

    def __getitem__(self, rows: NDArray[np.bool_] | Places) -> "Frames":
        return Frames(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))

    def __len__(self) -> int:
        return len(self.at)


@dataclass(frozen=True)
class Found:
    """What a log gave.

    `unchecked` counts frames by the number of a message no dialect knows, `failed` frames by
    message whose checksum is wrong though frames lie before and after; `holes` are bytes
    `begin, end` that belong to no frame.
    """

    data: NDArray[np.uint8]
    frames: Frames
    stamp: NDArray[np.int64]
    unchecked: Mapping[int, int]
    failed: Mapping[int, int]
    holes: tuple[tuple[int, int], ...]


def content(path: Path) -> NDArray[np.uint8]:
    """The bytes of a log, and behind them LONGEST zeros; (N + LONGEST,)."""
    check_whole(path)
    size = path.stat().st_size
    data = np.zeros(size + LONGEST, np.uint8)
    with path.open("rb") as file:
        file.readinto(data[:size].data)
    return data


def find(data: NDArray[np.uint8], known: Mapping[int, Definition]) -> Found:
    """The good frames of a log, from its `content`."""
    size = len(data) - LONGEST
    candidates = _candidates(data, size)
    chain = linked_starts(
        candidates.at - STAMP, candidates.end, Stretch(0, size, size - STAMP, STAMP + 1)
    )
    kept = candidates[chain.kept]
    fine = _valid(data, kept, _extra(kept.message, known))
    if fine.all() and not _holes((kept,), size):
        return Found(data, kept, _stamps(data, kept.at), {}, {}, ())
    good = np.zeros(len(candidates), bool)
    good[chain.kept] = fine
    return _among_gaps(data, candidates, chain.kept, good, known)


def _among_gaps(
    data: NDArray[np.uint8],
    candidates: Frames,
    kept: NDArray[np.bool_],
    good: NDArray[np.bool_],
    known: Mapping[int, Definition],
) -> Found:
    """The good frames of a damaged log: those that are good in the chain, and between them."""
    extra = _extra(candidates.message, known)
    listed = extra >= 0
    unknown, failed = kept & ~listed, kept & listed & ~good
    tried = _uncovered(candidates, ~kept & listed, candidates[good])
    valid = tried[_valid(data, candidates[tried], extra[tried])]
    good[_apart(candidates, good, valid)] = True
    frames = candidates[good]
    covered = candidates[_uncovered(candidates, unknown, frames)]
    lost = candidates[_uncovered(candidates, failed, frames)]
    holes = _holes((frames, covered, lost), len(data) - LONGEST)
    stamp = _stamps(data, frames.at)
    return Found(data, frames, stamp, _counts(covered), _counts(lost), holes)


def _candidates(data: NDArray[np.uint8], size: int) -> Frames:
    """Every place behind a stamp at which a frame may begin that ends within the file."""
    begins = range(STAMP, max(size, STAMP + 1), BLOCK)
    parts = [_starting(data, begin, min(begin + BLOCK, size), size) for begin in begins]
    names = Frames.__dataclass_fields__
    return Frames(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def _starting(data: NDArray[np.uint8], begin: int, end_of_block: int, size: int) -> Frames:
    """Of these those that begin in one block."""
    at = np.flatnonzero(data[begin:end_of_block] - MAGIC_2 < 2) + begin  # the two are neighbours
    first = numbers(data, at, "<u8").view(np.uint8).reshape(-1, 8)
    second = first[:, 0] == MAGIC_2
    flags = np.where(second, first[:, 2], 0)
    header = np.where(second, 10, 6).astype(np.uint8)
    signed = flags & SIGNED
    end = at + header + first[:, 1] + (2 + SIGNATURE * signed)
    able = (end <= size) & (flags == signed)
    at, first, second = at[able], first[able], second[able]
    rest = numbers(data, at + 8, "<u2").astype(np.int32) << 8
    message = np.where(second, first[:, 7] | rest, first[:, 5])
    system = np.where(second, first[:, 5], first[:, 3])
    component = np.where(second, first[:, 6], first[:, 4])
    return Frames(
        at=at,
        end=end[able],
        header=header[able],
        length=first[:, 1].copy(),
        message=message,
        system=system,
        component=component,
    )


def _extra(messages: NDArray[np.int32], known: Mapping[int, Definition]) -> NDArray[np.int16]:
    """The byte that stands for each message's definition, -1 for messages not known; (N,)."""
    bytes_ = np.full(max(known) + 2, -1, np.int16)
    bytes_[list(known)] = [one.check for one in known.values()]
    return bytes_[np.minimum(messages, len(bytes_) - 1)]


def _valid(data: NDArray[np.uint8], frames: Frames, extra: NDArray[np.int16]) -> NDArray[np.bool_]:
    """Which frames have the checksum they state; (N,)."""
    end = frames.payload + frames.length
    stated = numbers(data, end, "<u2")
    found = mavlink_crc.checksums(data, frames.at + 1, end, (extra & 0xFF).astype(np.uint8))
    return (stated == found) & (extra >= 0)


def _covered(frames: Frames, good: Frames) -> NDArray[np.bool_]:
    """Which frames overlap one of the good ones, which do not overlap each other; (N,)."""
    if not len(good):
        return np.zeros(len(frames), bool)
    before = np.searchsorted(good.at, frames.at, "right") - 1
    inside = (before >= 0) & (good.end[np.maximum(before, 0)] > frames.at)
    after = np.minimum(before + 1, len(good) - 1)
    reaches = (before + 1 < len(good)) & (good.at[after] - STAMP < frames.end)
    return inside | reaches


def _uncovered(frames: Frames, which: NDArray[np.bool_], good: Frames) -> Places:
    """Of these frames those that lie where no good one does; indices."""
    rows = np.flatnonzero(which)
    return rows[~_covered(frames[rows], good)]


def _apart(frames: Frames, good: NDArray[np.bool_], valid: Places) -> list[int]:
    """Of the frames found in gaps those that do not overlap an earlier one."""
    taken, reached = [], 0
    for i, begin, end in zip(
        valid.tolist(), frames.at[valid].tolist(), frames.end[valid].tolist(), strict=True
    ):
        if begin - STAMP >= reached:
            taken.append(i)
            reached = end
    return taken


def _holes(frames: Sequence[Frames], size: int) -> tuple[tuple[int, int], ...]:
    """Bytes that belong to no frame, good, unknown or failed."""
    some = [one for one in frames if len(one)]
    begin = np.concatenate([*(one.at - STAMP for one in some), [size]])
    end = np.concatenate([[0], *(one.end for one in some)])
    if len(some) > 1:
        order = np.argsort(begin[:-1])
        begin[:-1], end[1:] = begin[order], end[1:][order]
    gaps = np.flatnonzero(begin > end)
    return tuple(zip(end[gaps].tolist(), begin[gaps].tolist(), strict=True))


def _counts(frames: Frames) -> dict[int, int]:
    numbers, counts = np.unique(frames.message, return_counts=True)
    return dict(zip(numbers.tolist(), counts.tolist(), strict=True))


def _stamps(data: NDArray[np.uint8], at: Places) -> NDArray[np.int64]:
    """Receive times [ns] since 1970; (N,).

    No checksum covers them. One that is out of order among its neighbours by more than recorders
    mix up is replaced by the median of five.
    """
    raw = np.ndarray((len(data) - STAMP + 1,), ">u8", data.data, 0, (1,))[at - STAMP]
    stamps = np.minimum(raw, LATEST_US).astype(np.int64) * 1000
    if len(stamps) < 3:
        return stamps
    for end, beside in ((0, 1), (-1, -2)):
        step = (stamps[beside] - stamps[end]) * (1 if end == 0 else -1)
        if not -OUT_OF_ORDER_NS <= step <= PAUSE_NS:
            stamps[end] = stamps[beside]
    leaps = np.flatnonzero(np.abs(np.diff(stamps)) > OUT_OF_ORDER_NS // 4)
    if len(leaps):  # where none is near, none is off
        near = np.unique(np.clip(leaps[:, None] + np.arange(-1, 3), 0, len(stamps) - 1))
        padded = np.pad(stamps, 2, mode="edge")
        middle = np.median(np.lib.stride_tricks.sliding_window_view(padded, 5)[near], axis=1)
        off = np.abs(stamps[near] - middle) > OUT_OF_ORDER_NS
        stamps[near[off]] = middle[off].astype(np.int64)
    return stamps


def payloads(found: Found, rows: Places, definition: Definition) -> NDArray[np.void]:
    """Payloads of frames of one message as a table, zeros that were cut off put back; (N,)."""
    size = definition.kind.itemsize
    frames = found.frames
    length = frames.length[rows]
    count = len(found.data) - size + 1
    everywhere: NDArray[np.uint8] = np.ndarray((count, size), np.uint8, found.data.data, 0, (1, 1))
    raw = everywhere[np.minimum(frames.at[rows] + frames.header[rows], count - 1)]
    for short in np.flatnonzero(np.bincount(length)[:size]).tolist():
        raw[length == short, short:] = 0
    return raw.view(definition.kind)[:, 0]


def by_message(frames: Frames) -> dict[tuple[int, int, int], Places]:
    """Indices of the frames of each system, component and message, by these; increasing."""
    source = frames.system.astype(np.uint16) << 8 | frames.component
    sources, numbers = (np.flatnonzero(np.bincount(x)) for x in (source, frames.message))
    kinds = len(sources) * len(numbers)
    place = np.zeros(max(numbers.max(initial=0), sources.max(initial=0)) + 1, np.int64)
    place[sources] = np.arange(len(sources)) * len(numbers)
    kind = place[source]
    place[numbers] = np.arange(len(numbers))
    kind += place[frames.message]
    order = np.argsort(kind.astype(np.min_scalar_type(kinds)), kind="stable")
    parts = np.split(order, np.cumsum(np.bincount(kind, minlength=kinds))[:-1])
    names = [(*divmod(one, 256), n) for one in sources.tolist() for n in numbers.tolist()]
    return {name: part for name, part in zip(names, parts, strict=True) if len(part)}
