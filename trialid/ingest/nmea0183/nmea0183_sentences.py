"""NMEA 0183 sentences in a block of bytes: where each begins and ends, and its fields as columns.

A sentence is `$` or `!`, an address, comma and field again and again, and `*hh`: the exclusive or
of all bytes between `$` and `*`, in hexadecimal (NMEA 0183, IEC 61162-1). Between them stand
printable characters of ASCII, no `$` and no `!`: what holds one is two sentences run together.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
Places = NDArray[np.intp]
Mask = NDArray[np.bool_]

FIRST = 1 << 15
"""Bytes in which a log that has checksums mostly shows it."""

_HEX = np.full(256, -1, np.int16)
_HEX[np.frombuffer(b"0123456789", np.uint8)] = np.arange(10)
_HEX[np.frombuffer(b"ABCDEF", np.uint8)] = np.arange(10, 16)
_HEX[np.frombuffer(b"abcdef", np.uint8)] = np.arange(10, 16)


@dataclass(frozen=True)
class Span:
    """Stretches of the block, from `a` up to `b`; (N,) each."""

    a: Places
    b: Places

    def of(self, rows: NDArray[np.intp] | Mask) -> "Span":
        """Some of them."""
        return Span(self.a[rows], self.b[rows])


@dataclass(frozen=True, kw_only=True)
class Sentences:
    """The N sound sentences of a block.

    Parameters
    ----------
    data
        The block.
    body
        From the byte after `$` up to `*`.
    before
        What stands before `$`: from the line's beginning, or the end of the sentence before on
        the same line, or the beginning of one that was cut.
    joined
        True where the sentence before, which is sound, ends right before `$`.
    comma
        Places of all commas of the block; `first` is the index in it of each sentence's first, and
        `fields` how many fields follow the address.
    wrong, foreign, bare
        How many sentences had a wrong checksum, held what no sentence holds though it was right,
        and had none or were cut.
    """

    data: Bytes
    body: Span
    before: Span
    joined: Mask
    comma: Places
    first: Places
    fields: Places
    wrong: int
    foreign: int
    bare: int

    def field(self, rows: Places, number: int | Places) -> Span:
        """Field `number` of some sentences, the address is 0; empty where it is missing."""
        last = self.fields[rows]
        at = self.first[rows] + number
        if isinstance(number, int) and 0 < number < last.min(initial=0):
            return Span(self.comma[at - 1] + 1, self.comma[at])
        there = number <= last
        left = self.comma[np.where(there, at - 1, -1)] + 1
        a = np.where(np.equal(number, 0), self.body.a[rows], left)
        b = np.where(number < last, self.comma[np.where(there, at, -1)], self.body.b[rows])
        return Span(np.where(there, a, 0), np.where(there, b, 0))

    def letter(self, rows: Places, number: int | Places) -> Bytes:
        """A field of one character; 0 where it is empty, 255 where it is longer; (n,)."""
        span = self.field(rows, number)
        length = span.b - span.a
        letters = np.where(length == 1, self.data[span.a], np.uint8(255))
        return np.where(length < 1, np.uint8(0), letters).astype(np.uint8)


def sentences(data: Bytes, checked: bool = True) -> Sentences:
    """The sentences of a block; with `checked` False those of a log that knows no checksums."""
    lines = np.flatnonzero((data == 10) | (data == 13))
    marks = _marks(data)
    if not checked:
        return _unchecked(data, lines, marks)
    stars = _checksums(data)
    stars = stars[_last(marks, stars) > _last(np.flatnonzero(data == 92), stars)]
    ended = np.concatenate([[-1], stars[:-1] + 2]) if len(stars) else stars
    low, start = np.maximum(_last(lines, stars), ended), _last(marks, stars)
    found = start > low
    first, body = _next(marks, low[found], len(data)), Span(start[found] + 1, stars[found])
    right, plain = agrees(data, body), _plain(data, body)
    sound, cut = right & plain, first < body.a - 1
    doubled = _agree(data, Span(first + 1, body.b), cut & ~right)
    wrong, foreign = ~right & ~doubled, (right & ~plain) | doubled
    bare = int((cut & ~doubled).sum()) + _lines_with_none(lines, marks, stars, len(data))
    low = np.maximum(low[found], _last(marks, body.a - 1))[sound] + 1
    return _indexed(data, body.of(sound), low, (int(wrong.sum()), int(foreign.sum()), bare))


def has_checksums(data: Bytes) -> bool:
    """True when any sentence of the block carries a checksum, right or wrong."""
    for part in (data[:FIRST], data):
        marks = np.flatnonzero((part == 36) | (part == 33))
        lines = np.flatnonzero((part == 10) | (part == 13) | (part == 92))
        stars = _checksums(part)
        if (_last(marks, stars) > _last(lines, stars)).any():
            return True
    return False


def checksum(data: Bytes, span: Span) -> Bytes:
    """Exclusive or of the bytes of each stretch, none of them empty; (N,)."""
    if not len(span.a):
        return np.zeros(0, np.uint8)
    edges = np.column_stack([span.a, span.b]).ravel()
    return np.bitwise_xor.reduceat(data, edges)[::2]


def agrees(data: Bytes, span: Span) -> Mask:
    """True where a stretch has the checksum that stands behind the `*` it ends at."""
    stated = _HEX[data[span.b + 1]] * 16 + _HEX[data[span.b + 2]]
    return (checksum(data, span) == stated) & (span.b > span.a)


def _checksums(data: Bytes) -> Places:
    """Places of `*` with two hexadecimal digits behind."""
    stars = np.flatnonzero(data[:-2] == 42) if len(data) > 2 else np.zeros(0, np.intp)
    return stars[(_HEX[data[stars + 1]] >= 0) & (_HEX[data[stars + 2]] >= 0)]


def _last(places: Places, before: Places) -> Places:
    """The last of the places before each; -1 where there is none."""
    return np.concatenate([[-1], places])[np.searchsorted(places, before)].astype(np.intp)


def _next(places: Places, after: Places, none: int) -> Places:
    return np.concatenate([places, [none]])[np.searchsorted(places, after, "right")].astype(np.intp)


def _agree(data: Bytes, span: Span, asked: Mask) -> Mask:
    """True where a stretch that is asked has the checksum stated behind."""
    right, rows = np.zeros(len(asked), np.bool_), np.flatnonzero(asked)
    right[rows] = agrees(data, span.of(rows))
    return right


def _lines_with_none(lines: Places, marks: Places, stars: Places, size: int) -> int:
    """How many lines have a `$` and no checksum at all."""
    edges = np.concatenate([lines, [size]])
    cut = np.zeros(len(edges), np.bool_)
    cut[np.searchsorted(edges, marks)] = True
    cut[np.searchsorted(edges, stars)] = False
    return int(cut.sum())


def _marks(data: Bytes) -> Places:
    """Places of `$` and `!` with the first letter of an address behind."""
    marks = np.flatnonzero((data[:-1] == 36) | (data[:-1] == 33))
    return marks[(data[marks + 1] >= ord("A")) & (data[marks + 1] <= ord("Z"))]


def _plain(data: Bytes, body: Span) -> Mask:
    """True where nothing stands that no sentence holds: control characters, bytes past ASCII, `$`.

    None of them may come into the name of a device.
    """
    foreign = np.flatnonzero((data < 32) | (data > 126) | (data == 36) | (data == 33))
    return np.searchsorted(foreign, body.a) == np.searchsorted(foreign, body.b)


def _unchecked(data: Bytes, lines: Places, marks: Places) -> Sentences:
    """One sentence a line; a last line without an end is cut."""
    begin = np.concatenate([[-1], lines[:-1]]) if len(lines) else lines
    start = _next(marks, begin, len(data))
    found = start < lines
    body, low = Span(start[found] + 1, lines[found]), begin[found] + 1
    plain = _plain(data, body)
    cut = int(len(marks) > 0 and marks[-1] > (lines[-1] if len(lines) else -1))
    return _indexed(data, body.of(plain), low[plain], (0, int((~plain).sum()), cut))


def _indexed(data: Bytes, body: Span, low: Places, lost: tuple[int, int, int]) -> Sentences:
    """With the index of its commas; `low` is where what stands before begins."""
    joined = np.zeros(len(low), np.bool_)
    joined[1:] = body.a[1:] - 1 == body.b[:-1] + len("*hh")
    comma = np.flatnonzero(data == 44)
    first = np.searchsorted(comma, body.a)
    fields = np.searchsorted(comma, body.b) - first
    comma = np.append(comma, len(data))  # what stands behind the last
    before = Span(low, body.a - 1)
    wrong, foreign, bare = lost
    return Sentences(
        data=data,
        body=body,
        before=before,
        joined=joined,
        comma=comma,
        first=first,
        fields=fields,
        wrong=wrong,
        foreign=foreign,
        bare=bare,
    )
