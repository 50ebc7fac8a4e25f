"""Fields of the lines of a text, taken apart and read as numbers in columns.

A log of lines is cut into blocks of whole lines, the lines of a block into fields at the
separators, and a column of fields becomes numbers by going through their characters side by side:
some ten times as fast as one line after the other.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

BLOCK = 1 << 20
"""Bytes read at once."""
LONGEST_LINE = 1 << 16
"""A line that is longer is no line of a log."""

NEWLINE = 10
SECOND_NS = 1_000_000_000
DAY_NS = 86_400 * SECOND_NS
LATEST_S = 9_000_000_000
"""More seconds than this do not fit 64 bits of nanoseconds."""

DIGITS = np.full(256, 99, np.int64)
"""Value of a character as a hexadecimal digit; 99 for any other."""
for _value, _character in enumerate(b"0123456789abcdef"):
    DIGITS[_character] = _value
for _value, _character in enumerate(b"ABCDEF", 10):
    DIGITS[_character] = _value
NIBBLES = np.minimum(DIGITS, 0x80).astype(np.uint8)
"""The same in bytes; 128 for any other."""


@dataclass(frozen=True)
class Fields:
    """The fields of L lines: line i has `count[i]` of them, the first at `start[first[i]]`.

    `start` and `end` are places in `text`; `begin` and `stop` those of the lines.
    """

    text: NDArray[np.uint8]
    begin: Ints
    stop: Ints
    start: Ints
    end: Ints
    first: Ints
    count: Ints

    def __len__(self) -> int:
        return len(self.begin)

    def at(self, rows: Ints, field: Ints | int) -> tuple[Ints, Ints]:
        """Places of the field of that number in these lines, which must have it."""
        index = self.first[rows] + field
        return self.start[index], self.end[index]

    def character(self, place: Ints) -> NDArray[np.uint8]:
        """Characters at these places; behind the text a newline."""
        inside = place < len(self.text)
        return np.where(inside, self.text[np.where(inside, place, 0)], NEWLINE).astype(np.uint8)


def blocks(path: Path) -> Iterator[NDArray[np.uint8]]:
    """The file in blocks of whole lines; the last line may lack its end."""
    with path.open("rb") as file:
        rest = b""
        while chunk := file.read(BLOCK):
            cut = chunk.rfind(b"\n") + 1
            if cut:
                yield np.frombuffer(rest + chunk[:cut], np.uint8)
                rest = chunk[cut:]
            else:
                rest = (rest + chunk)[: 2 * LONGEST_LINE]
        if rest:
            yield np.frombuffer(rest, np.uint8)


def fields(text: NDArray[np.uint8], separators: bytes) -> Fields:
    """The lines of a block taken apart at the separators; blank lines are none."""
    parts = np.zeros(256, np.bool_)
    parts[list(separators + b"\r\n")] = True
    solid = np.zeros(len(text) + 2, np.bool_)
    np.logical_not(parts[text], out=solid[1:-1])
    edge = np.flatnonzero(solid[1:] != solid[:-1])
    start, end = edge[::2], edge[1::2]
    newline = np.flatnonzero(text == NEWLINE)
    begin = np.concatenate([[0], newline + 1])
    stop = np.concatenate([newline, [len(text)]])
    first = np.searchsorted(start, np.append(begin, len(text)))
    count = np.diff(first)
    some = (count > 0) & (stop - begin < LONGEST_LINE)
    return Fields(
        text=text,
        begin=begin[some],
        stop=stop[some],
        start=start,
        end=end,
        first=first[:-1][some],
        count=count[some],
    )


def integers(text: NDArray[np.uint8], start: Ints, end: Ints, base: int) -> tuple[Ints, Bools]:
    """Whole numbers without sign in these places, and which of them are; up to 60 bits."""
    value = np.zeros(len(start), np.int64)
    width = end - start
    good = (width > 0) & (width <= (15 if base == 16 else 18))
    if not good.any():
        return value, good
    for i in range(int(width[good].max())):
        if i < width.min():
            digit = DIGITS[text[start + i]]
            good &= digit < base
            value = value * base + digit
        else:
            within = i < width
            digit = DIGITS[text[np.where(within, start + i, 0)]]
            good &= ~within | (digit < base)
            value = np.where(within & good, value * base + digit, value)
    return np.where(good, value, 0), good


def seconds(text: NDArray[np.uint8], start: Ints, end: Ints) -> tuple[Ints, Bools]:
    """Seconds with decimals in these places, in whole nanoseconds, and which of them are.

    Where the point stands differs from line to line only when numbers gain a digit, so the lines
    are read in groups that have it at the same place.
    """
    t, good = np.zeros(len(start), np.int64), np.zeros(len(start), np.bool_)
    width = np.where((end > start) & (end - start <= 21), end - start, 0)
    point = _points(text, start, width)
    layout = width * 32 + point
    for value in np.unique(layout[width > 0]).tolist():
        rows = np.flatnonzero(layout == value)
        wide, before = divmod(value, 32)
        decimals = min(wide - before - 1, 9) if before < wide else 0
        if before > 10 or before + decimals == 0:
            continue
        at = start[rows]
        whole, is_whole = integers(text, at, at + before, 10)
        part, is_part = integers(text, at + before + 1, at + before + 1 + decimals, 10)
        _, is_rest = integers(text, at + before + 10, at + wide, 10)  # beyond the nanoseconds
        good[rows] = (
            (is_whole | (before == 0)) & (is_part | (decimals == 0)) & (whole < LATEST_S)
            & (is_rest | (wide <= before + 10))
        )  # fmt: skip
        t[rows] = whole * SECOND_NS + part * 10 ** (9 - decimals)
    return np.where(good, t, 0), good


def _points(text: NDArray[np.uint8], start: Ints, width: Ints) -> Ints:
    """How many characters stand before the point; the whole width where there is none."""
    point = width.copy()
    if not width.any():
        return point
    likely = int(np.argmax(text[start[0] : start[0] + width[0]] == ord("."))) if width[0] else 0
    sure = (likely < width) & (text[np.minimum(start + likely, len(text) - 1)] == ord("."))
    point[sure] = likely
    rest = np.flatnonzero(~sure & (width > 0))
    for i in reversed(range(int(width[rest].max(initial=0)))):
        within = rest[i < width[rest]]
        point[within[text[start[within] + i] == ord(".")]] = i
    return point


def date(text: NDArray[np.uint8], start: Ints) -> tuple[Ints, Bools]:
    """Dates `2016-02-28` in nanoseconds since 1970, and which are dates."""
    (year, month, day), good = _groups(text, start, (4, 2, 2), b"--")
    good &= (year >= 1970) & (year < 2250) & (month >= 1) & (month <= 12) & (day >= 1)
    months = np.where(good, (year - 1970) * 12 + month - 1, 0).astype("M8[M]")
    first, following = months.astype("M8[D]"), (months + 1).astype("M8[D]")
    days = first.astype(np.int64) + day - 1
    good &= days < following.astype(np.int64)
    return np.where(good, days, 0) * DAY_NS, good


def time_of_day(text: NDArray[np.uint8], start: Ints, end: Ints) -> tuple[Ints, Bools]:
    """Times `19:57:02.364` in nanoseconds since midnight, and which are times of the day."""
    (hour, minute), good = _groups(text, start, (2, 2), b":")
    after = np.minimum(start + 5, len(text) - 1)
    second, is_second = seconds(text, start + 6, np.maximum(end, start + 6))
    good &= is_second & (text[after] == ord(":")) & (hour < 24) & (minute < 60)
    good &= second < 61 * SECOND_NS
    return np.where(good, (hour * 60 + minute) * 60 * SECOND_NS + second, 0), good


def _groups(
    text: NDArray[np.uint8], start: Ints, widths: tuple[int, ...], marks: bytes
) -> tuple[list[Ints], Bools]:
    """Whole numbers of fixed widths with these marks between them."""
    inside = start + sum(widths) + len(marks) <= len(text)
    place = np.where(inside, start, 0)
    good, values = inside & (len(text) >= sum(widths) + len(marks)), []
    if not good.any():
        return [np.zeros(len(start), np.int64) for _ in widths], good
    for i, width in enumerate(widths):
        value, is_number = integers(text, place, place + width, 10)
        values.append(value)
        good &= is_number
        place = place + width
        if i < len(marks):
            good &= text[place] == marks[i]
            place = place + 1
    return values, good


def octets(text: NDArray[np.uint8], start: Ints) -> tuple[NDArray[np.uint8], Bools]:
    """Bytes written as two hexadecimal digits at these places, and which are; any shape."""
    start = np.minimum(start, max(len(text) - 2, 0))
    high, low = NIBBLES[text[start]], NIBBLES[text[np.minimum(start + 1, len(text) - 1)]]
    return (high << 4 | low).astype(np.uint8), (high | low) < 16
