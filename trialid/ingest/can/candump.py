"""Text of `candump` and its kin to frames: every form the tool writes.

`(1665920455.193000) can0 09F10D05#FF07` and, spaced, `(..) can0  09F10D05   [8]  FF 07 ..`; stamps
from 1970 (-ta, -l), as a local date (-tA), since the first frame (-tz) or since the frame before
(-td); also `<0x09f8027f> [8] 00 FC ..`. Lines beginning with `#` are comments. Frames without any
stamp have no time, and no trial can be made of them.
"""

import dataclasses
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest.bytes import text_fields
from trialid.ingest.bytes.text_fields import NEWLINE, Bools, Fields, Ints
from trialid.ingest.can import can_alike
from trialid.ingest.can.can_alike import Alike
from trialid.ingest.can.can_frames import EXTENDED_ID, Frames, Tally, join_frames
from trialid.ingest.times import local_time
from trialid.recording import ZONELESS

REMOTE_FLAG, ERROR_FLAG = 0x4000_0000, 0x2000_0000
"""Bits of an identifier that say the frame is none of data."""
LONGEST_NAME = 15
"""Characters of the name of an interface."""
BEGAN_NS = 100_000_000 * 1_000_000_000
"""Stamps below (three years from 1970) count from the start of the log, or the frame before."""
STEPS_BACK = 0.05
"""A larger share of stamps that step back: each counts from the frame before."""

DATA, REMOTE, ERROR, FLEXIBLE = range(4)
"""Kinds of frames."""

BRACKETS = (2, 1, 5)
"""How many fields after the stamp the `[8]` stands: usually, without interface, with -x."""


@dataclass(frozen=True)
class Shape:
    """How lines are written: (L,) each.

    `stamp` is the number of fields of the stamp, `name` the field of the identifier, `bracket` that
    of the `[8]`, 0 where the data follow behind a `#`; `good` is False for what is no frame.
    """

    stamp: Ints
    name: Ints
    bracket: Ints
    good: Bools


@dataclass(frozen=True)
class Block:
    """Data frames of a block, and where the line of each begins; (n,).

    `dated` are stamped with dates; `untimed`, which are not among them, not at all.
    """

    frames: Frames
    begin: Ints
    dated: int
    untimed: int


def frames(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of the file, and words for their clock; LogError when none has a time."""
    parts: list[Frames] = []
    dated = untimed = 0
    for text in text_fields.blocks(path):
        alike = can_alike.read(text)
        tally.lines += len(alike.lines)
        parts.append(alike.frames)
        if len(alike.rest):
            other = _block(text_fields.fields(alike.rest, b" \t#"), tally)
            parts[-1] = _together(alike, other)
            dated += other.dated
            untimed += other.untimed
    whole = join_frames(parts)
    if not len(whole):
        if untimed:
            raise LogError(
                f"{path}: its {untimed} frames have no time stamp, and a trial needs one; record "
                "with `candump -l` or `candump -ta`"
            )
        raise LogError(f"{path}: none of its {tally.lines} lines is a CAN frame; copy it again")
    if dated and dated < len(whole):
        raise LogError(f"{path}: some stamps are dates and some are seconds; split the log")
    t, clock = _clock(whole.t, dated > 0, zone, tally)
    return dataclasses.replace(whole, t=t), clock


def _clock(t: Ints, dated: bool, zone: str | None, tally: Tally) -> tuple[Ints, str]:
    """Stamps on one clock, and words for it."""
    if dated:
        if zone is not None:
            return local_time.utc(t, zone), f"line stamps (dates in {zone})"
        tally.remarks.append(
            "stamps are dates of a local clock, the log does not say of which time zone: taken as "
            "UTC; `zone` can state it"
        )
        return t, f"line stamps (local dates, zone not stated, {ZONELESS})"
    if t.max(initial=0) >= BEGAN_NS:
        return t, "line stamps"
    if len(t) > 2 and np.mean(np.diff(t) < 0) > STEPS_BACK:
        return np.cumsum(t), "line stamps (each since the frame before, added up; no date)"
    return t, "line stamps (since the start of the log; no date)"


def _together(alike: Alike, other: Block) -> Frames:
    """Frames of both in the order of their lines."""
    newline = np.flatnonzero(alike.rest == NEWLINE)
    lines = alike.rest_lines[np.searchsorted(newline, other.begin)]
    frames = join_frames([alike.frames, other.frames])
    return can_alike.in_order(frames, np.concatenate([alike.lines, lines]))[0]


def _block(lines: Fields, tally: Tally) -> Block:
    """Data frames of a block of lines."""
    first = lines.start[lines.first]
    comment = lines.text[np.minimum(lines.begin, first)] == ord("#")
    shape = _shape(lines, first)
    t, timed = _stamps(lines, shape)
    can_id, digits, is_id = _identifiers(lines, shape)
    good = shape.good & timed & is_id & ~comment
    kind = _kind(lines, shape, can_id, good)
    places, length, whole = _data(lines, shape, good & (kind == DATA))
    table, is_hex = text_fields.octets(lines.text, places)
    used = np.arange(8) < length[:, None]
    data = whole & (is_hex | ~used).all(axis=1)
    tally.lines += int(np.sum(~comment))
    tally.strange += int(np.sum(~comment & ~data & ~(good & (kind != DATA))))
    tally.remote += int(np.sum(good & (kind == REMOTE)))
    tally.errors += int(np.sum(good & (kind == ERROR)))
    tally.flexible += int(np.sum(good & (kind == FLEXIBLE)))
    untimed = data & (shape.stamp == 0)
    tally.strange += int(untimed.sum())
    rows = np.flatnonzero(data & ~untimed)
    bus, buses = _buses(lines, shape, rows)
    table = np.where(used, table, 0)[rows].astype(np.uint8)
    extended = digits[rows] > 3
    made = Frames(
        t=t[rows],
        can_id=can_id[rows] & EXTENDED_ID,
        extended=extended,
        table=table,
        length=length[rows],
        bus=bus,
        buses=buses,
    )
    dated = int(np.sum(shape.stamp[rows] == 2))
    return Block(made, lines.begin[rows], dated, int(untimed.sum()))


def _shape(lines: Fields, first: Ints) -> Shape:
    stamped = lines.text[first] == ord("(")
    dated = stamped & (lines.character(first + 5) == ord("-"))
    stamp = np.where(dated, 2, np.where(stamped, 1, 0))
    name = stamp + 1
    compact = _there(lines, name) & (lines.character(_end(lines, name)) == ord("#"))
    bracket = np.zeros(len(lines), np.int64)
    for offset in BRACKETS:
        place = stamp + offset
        opens = lines.character(_start(lines, place)) == ord("[")
        bracket = np.where((bracket == 0) & _there(lines, place) & opens, place, bracket)
    bracket[compact] = 0
    return Shape(stamp, np.where(compact, name, bracket - 1), bracket, compact | (bracket > 0))


def _there(lines: Fields, field: Ints) -> Bools:
    """Which lines have a field of that number."""
    return field < lines.count


def _start(lines: Fields, field: Ints) -> Ints:
    return lines.start[lines.first + np.clip(field, 0, lines.count - 1)]


def _end(lines: Fields, field: Ints) -> Ints:
    return lines.end[lines.first + np.clip(field, 0, lines.count - 1)]


def _stamps(lines: Fields, shape: Shape) -> tuple[Ints, Bools]:
    """Stamps of the lines [ns], and which lines have one or are of the form without."""
    t, good = np.zeros(len(lines), np.int64), shape.stamp == 0
    for width in (1, 2):
        rows = np.flatnonzero((shape.stamp == width) & shape.good)
        if not len(rows):
            continue
        start, end = lines.at(rows, width - 1)
        closed = lines.text[end - 1] == ord(")")
        if width == 1:
            t[rows], fine = text_fields.seconds(lines.text, start + 1, end - 1)
        else:
            day, is_day = text_fields.date(lines.text, lines.at(rows, 0)[0] + 1)
            hour, fine = text_fields.time_of_day(lines.text, start, end - 1)
            t[rows], fine = day + hour, fine & is_day
        good[rows] = fine & closed
    return t, good


def _identifiers(lines: Fields, shape: Shape) -> tuple[Ints, Ints, Bools]:
    """Identifiers with their flags, their digits, and which are one; also `<0x09f8027f>`."""
    start, end = _start(lines, shape.name), _end(lines, shape.name)
    framed = lines.text[start] == ord("<")
    start, end = start + 3 * framed, end - framed
    can_id, good = text_fields.integers(lines.text, start, end, 16)
    digits = end - start
    return can_id, digits, good & ((digits == 8) | (digits == 3))


def _kind(lines: Fields, shape: Shape, can_id: Ints, good: Bools) -> Ints:
    """What kind of frame each is."""
    end = _end(lines, shape.name)
    behind = lines.character(end + 1)
    after = lines.character(_start(lines, shape.bracket + 1))
    compact = shape.bracket == 0
    more = _there(lines, shape.bracket + 1)
    wide = _end(lines, shape.bracket) - _start(lines, shape.bracket) > 3
    remote = np.where(compact, behind == ord("R"), more & (after == ord("r")))
    flexible = np.where(compact, behind == ord("#"), wide)
    kind = np.where(flexible, FLEXIBLE, DATA)
    kind = np.where(remote | (can_id & REMOTE_FLAG > 0), REMOTE, kind)
    return np.where(good & (can_id & ERROR_FLAG > 0), ERROR, kind)


def _data(lines: Fields, shape: Shape, good: Bools) -> tuple[Ints, Ints, Bools]:
    """Places of the data bytes (L, 8), how many there are, and which lines have them right."""
    compact = shape.bracket == 0
    start, field = _end(lines, shape.name) + 1, shape.name + 1
    follows = _there(lines, field) & (_start(lines, field) == start)
    digits = np.where(follows, _end(lines, field) - start, 0)
    stated = text_fields.DIGITS[lines.character(_start(lines, shape.bracket) + 1)]
    length = np.where(compact, digits // 2, stated)
    fits = np.where(compact, digits % 2 == 0, shape.bracket + stated < lines.count)
    good = good & fits & (length <= 8)
    length = np.where(good, length, 0)
    places = start[:, None] + 2 * np.arange(8)
    rows = np.flatnonzero(good & ~compact)
    if len(rows):
        k = np.arange(8)
        last = len(lines.start) - 1
        index = np.minimum((lines.first + shape.bracket)[rows, None] + 1 + k, last)
        places[rows] = lines.start[index]
        pairs = (lines.end[index] - lines.start[index] == 2) | (k >= length[rows, None])
        good[rows] = pairs.all(axis=1)
    return places, length, good


def _buses(lines: Fields, shape: Shape, rows: Ints) -> tuple[Ints, tuple[str, ...]]:
    """Interface of each of these lines, and the names of them."""
    named = (shape.bracket[rows] == 0) | (shape.bracket[rows] - shape.stamp[rows] > 1)
    start, end = lines.at(rows, shape.stamp[rows])
    width = np.where(named, np.minimum(end - start, LONGEST_NAME), 0)
    names = np.zeros((len(rows), LONGEST_NAME + 1), np.uint8)
    for i in range(int(width.max(initial=0))):
        names[:, i] = np.where(i < width, lines.character(start + i), 0)
    if not len(rows) or (names == names[0]).all():
        bus, different = np.zeros(len(rows), np.int64), names[:1]
    else:
        different, bus = np.unique(names, axis=0, return_inverse=True)
    texts = [bytes(one).rstrip(b"\0").decode("ascii", "replace") for one in different]
    return bus.reshape(-1).astype(np.int64), tuple(texts)
