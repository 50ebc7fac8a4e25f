"""Lines of a candump that are laid out alike, read side by side.

Most lines of a log differ in nothing but their digits, so the first of them says in which columns
the numbers of all stand, and what lies between them has only to be compared. Whatever is laid out
in another way, is no frame of data or is damaged is left to the reading field by field.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.text_fields import LATEST_S, NEWLINE, NIBBLES, SECOND_NS, Bools, Ints
from trialid.ingest.can.can_frames import EXTENDED_ID, Frames, join_frames, select_frames

Octets = NDArray[np.uint8]

ZERO = np.uint8(ord("0"))
WIDEST = 96
"""Characters of a line; with eight bytes, spaced, it has some 70."""
LAYOUTS = 6
"""Of lines of one width: interfaces whose names are as long, short identifiers; more are rare."""
NOT_DATA = 0x6000_0000
"""Bits of an identifier that say the frame is none of data."""

_HEAD = (
    rb"[ \t]*\((?P<whole>\d{1,10})\.(?P<part>\d{1,9})\)[ \t]+(?P<bus>\w[\w.-]{0,14})"
    rb"[ \t]+(?P<name>[0-9A-Fa-f]{8}|[0-9A-Fa-f]{3})"
)
COMPACT = re.compile(_HEAD + rb"#(?P<data>([0-9A-Fa-f]{2}){0,8})[ \t\r]*")
SPACED = re.compile(
    _HEAD + rb"[ \t]+\[(?P<length>[0-8])\](?P<data>([ \t]+[0-9A-Fa-f]{2}){0,8})[ \t\r]*"
)


@dataclass(frozen=True)
class Layout:
    """Columns of the numbers in lines of one width; in all others they are like `line`.

    `stamp` are the digits of the stamp, of which `whole` stand before the point, `name` those of
    the identifier, `data` the first digit of each byte.
    """

    line: Octets
    fixed: Ints
    stamp: Ints
    whole: int
    name: Ints
    data: Ints
    bus: str


@dataclass(frozen=True)
class Alike:
    """Frames read side by side and the lines they stood on, and the other lines, as text.

    Lines are numbered within their block, blank ones too; of the text these are left out.
    """

    frames: Frames
    lines: Ints
    rest: Octets
    rest_lines: Ints


def read(text: Octets) -> Alike:
    """The frames of a block of whole lines that are laid out alike, and the lines that are left."""
    newline = np.flatnonzero(text == NEWLINE)
    begin = np.concatenate([[0], newline + 1])
    stop = np.concatenate([newline, [len(text)]])
    width = np.minimum(stop - begin, WIDEST + 1)
    found = [
        one
        for wide in np.flatnonzero(np.bincount(width)[: WIDEST + 1]).tolist()
        for one in _of_width(text, begin, np.flatnonzero(width == wide), wide)
    ]
    lines = np.concatenate([np.zeros(0, np.int64), *(lines for lines, _ in found)])
    frames = join_frames([part for _, part in found])
    if len(found) > 1:
        frames, lines = in_order(frames, lines)
    left = width > 0
    left[lines] = False
    if not left.any():
        return Alike(frames, lines, text[:0], lines[:0])
    size = np.minimum(stop + 1, len(text)) - begin
    return Alike(frames, lines, text[np.repeat(left, size)], np.flatnonzero(left))


def in_order(frames: Frames, lines: Ints) -> tuple[Frames, Ints]:
    """Frames by the line they stood on."""
    order = np.argsort(lines)
    return select_frames(frames, order), lines[order]


def layout(line: bytes) -> Layout | None:
    """How a line is laid out; None for what is no frame of data with a stamp.

    >>> layout(b"(1665920455.193000) can0 09F10D05#FF07").data.tolist()
    [34, 36]
    """
    found = COMPACT.fullmatch(line) or SPACED.fullmatch(line)
    if found is None:
        return None
    octets = re.finditer(rb"\S\S", found["data"])
    data = np.array([found.start("data") + one.start() for one in octets], np.int64)
    if found.re is SPACED and int(found["length"]) != len(data):
        return None
    whole, part, name = (np.arange(*found.span(one)) for one in ("whole", "part", "name"))
    stamp = np.concatenate([whole, part])
    fixed = np.setdiff1d(np.arange(len(line)), np.concatenate([stamp, name, data, data + 1]))
    bus = found["bus"].decode("ascii")
    return Layout(
        line=np.frombuffer(line, np.uint8),
        fixed=fixed,
        stamp=stamp,
        whole=len(whole),
        name=name,
        data=data,
        bus=bus,
    )


def _of_width(text: Octets, begin: Ints, lines: Ints, width: int) -> Iterator[tuple[Ints, Frames]]:
    """Numbers and frames of the lines of one width, layout by layout."""
    every: Octets = np.ndarray((len(text) - width + 1, width), np.uint8, text, 0, (1, 1))
    for _ in range(LAYOUTS):
        if not len(lines):
            return
        by = layout(every[begin[lines[0]]].tobytes())
        if by is None:
            lines = lines[1:]
            continue
        columns = np.ascontiguousarray(every[begin[lines]].T)
        alike = (columns[by.fixed] == by.line[by.fixed, None]).all(axis=0)
        good, frames = _frames(columns if alike.all() else columns[:, alike], by)
        yield lines[alike][good], frames
        lines = lines[~alike]


def _frames(columns: Octets, by: Layout) -> tuple[Bools, Frames]:
    """Which of the lines, given column by column, are frames of data, and these frames."""
    t, is_time = _stamps(columns, by)
    digits = NIBBLES.take(columns[np.concatenate([by.name, by.data, by.data + 1])])
    high, low = np.split(digits[len(by.name) :], 2)
    can_id = _number(digits[: len(by.name)], 16)
    good = is_time & (digits.max(axis=0) < 16) & (can_id & NOT_DATA == 0)
    count = columns.shape[1]
    table = np.zeros((count, 8), np.uint8)
    table[:, : len(by.data)] = (high << 4 | low).T
    length, bus = np.full(count, len(by.data)), np.zeros(count, np.int64)
    extended = np.full(count, len(by.name) > 3)
    frames = Frames(
        t=t,
        can_id=can_id & EXTENDED_ID,
        extended=extended,
        table=table,
        length=length,
        bus=bus,
        buses=(by.bus,),
    )
    return good, frames if good.all() else select_frames(frames, good)


def _stamps(columns: Octets, by: Layout) -> tuple[Ints, Bools]:
    """Stamps [ns], and which are."""
    digits = columns[by.stamp] - ZERO  # what is below it wraps to above nine
    whole, part = _number(digits[: by.whole], 10), _number(digits[by.whole :], 10)
    decimals = len(by.stamp) - by.whole
    t = whole * SECOND_NS + part * 10 ** (9 - decimals)
    return t, (digits.max(axis=0) < 10) & (whole < LATEST_S)


def _number(digits: Octets, base: int) -> Ints:
    """Whole numbers of their digits; (digits, n) to (n,)."""
    value = digits[0].astype(np.int64)
    for digit in digits[1:]:
        value = value * base + digit
    return value
