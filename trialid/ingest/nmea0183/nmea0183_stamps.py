r"""Time stamps that recorders write before NMEA 0183 sentences, as columns.

Known are ISO dates, seconds, milliseconds, microseconds and nanoseconds since 1970, and times of
day, in brackets or not, anywhere before the sentence; and tag blocks `\s:GP0001,c:1480000000*hh\`
(NMEA 0183 4.10, IEC 61162-450), whose time `c` counts seconds or milliseconds; `s` is the source.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.nmea0183.nmea0183_columns import alike, table
from trialid.ingest.nmea0183.nmea0183_sentences import Bytes, Mask, Places, Span, agrees

Ints = NDArray[np.int64]

NONE: Final = np.iinfo(np.int64).min
"""Where there is no stamp."""
NO_TIME, ZONED, LOCAL, TIME_OF_DAY = range(4)
"""What a stamp is: none; of a known zone; a date of an unstated zone; no date."""

SECOND = 1_000_000_000
HOUR = 3600 * SECOND
LONGEST = 128
"""Bytes before a sentence in which a stamp is looked for."""

# Digits are all shown as 0.
DATED = re.compile(
    rb"(?<![0])(?P<y>0000)(?P<dash>[-/.])(?P<mo>00)(?P=dash)(?P<d>00)[T :_]"
    rb"(?P<h>00):(?P<mi>00):(?P<s>00)(?:[.,](?P<f>0{1,9}))?\s?(?P<z>Z|UTC|(?P<sign>[+-])(?P<zh>00):?(?P<zm>00))?(?![0.])"
)
EPOCH = re.compile(
    rb"(?<![0-9.A-Za-z:/-])(?:(?P<s>0{10})(?:\.(?P<f>0{1,9}))?|(?P<ms>0{13})|(?P<us>0{16})"
    rb"|(?P<ns>0{19}))"
    rb"(?![0.A-Za-z/-]|:0)"
)
CLOCK = re.compile(rb"(?<![0:.])(?P<h>00):(?P<mi>00):(?P<s>00)(?:[.,](?P<f>0{1,9}))?(?![0:.])")
TAG_TIME = re.compile(rb"(?:^|,)c:(?:(?P<s>0{10})|(?P<ms>0{13}))(?=,|$)")
TAG_SOURCE = re.compile(rb"(?:^|,)s:(?P<source>[^,]*)")

EARLIEST, LATEST = 631_152_000, 4_102_444_800
"""1990 and 2100 [s]: a number of ten digits outside is a counter, not a time."""

Columns = Callable[[str], Ints]
"""A named group of a shape to the numbers that stand there."""


@dataclass(frozen=True)
class Tags:
    """Tag blocks of N sentences: where, which are whole, times [ns], source by text."""

    there: Mask
    sound: Mask
    t: Ints
    seconds_only: Mask
    sources: tuple[tuple[Places, str], ...]


def of_prefixes(data: Bytes, before: Span) -> tuple[Ints, NDArray[np.int8], Mask]:
    """Stamp of each stretch [ns], what it is, and whether it has whole seconds only; (N,) each."""
    t = np.full(len(before.a), NONE)
    kind = np.zeros(len(before.a), np.int8)
    coarse = np.zeros(len(before.a), np.bool_)
    for rows, cells, shape in _shapes(data, before):
        for pattern, reading in ((DATED, _dated), (EPOCH, _epoch), (CLOCK, _clock)):
            found = pattern.search(shape)
            if found is None:
                continue
            t[rows], what = reading(found, _reader(cells, found))
            kind[rows] = np.where(t[rows] == NONE, NO_TIME, what)
            coarse[rows] = _coarse(found)
            break
    return t, kind, coarse


def of_tags(data: Bytes, before: Span) -> tuple[Tags, Span]:
    """The tag block that ends right before each sentence, and what stands before that."""
    slashes = np.flatnonzero(data == 92)
    last = np.searchsorted(slashes, before.b) - 1
    close = np.append(slashes, -1)[last]
    opening = np.append(slashes, -1)[np.maximum(last - 1, -1)]
    there = (last >= 1) & (close == before.b - 1) & (opening >= before.a) & (close - opening > 4)
    sound = np.zeros(len(there), np.bool_)
    rows = np.flatnonzero(there)
    inside = Span(opening[rows] + 1, close[rows] - 3)
    sound[rows] = (data[inside.b] == 42) & agrees(data, inside)
    t = np.full(len(there), NONE)
    coarse = np.zeros(len(there), np.bool_)
    sources: list[tuple[Places, str]] = []
    rows, inside = np.flatnonzero(sound), inside.of(sound[rows])
    for part, cells, shape in _shapes(data, inside):
        _tag(rows[part], cells, shape, t, coarse, sources)
    rest = Span(before.a, np.where(there, opening, before.b))
    return Tags(there, sound, t, coarse, tuple(sources)), rest


def _tag(
    rows: Places,
    cells: Bytes,
    shape: bytes,
    t: Ints,
    coarse: Mask,
    sources: list[tuple[Places, str]],
) -> None:
    time = TAG_TIME.search(shape)
    if time is not None:
        t[rows], _ = _epoch(time, _reader(cells, time))
        coarse[rows] = time["s"] is not None
    source = TAG_SOURCE.search(shape)
    if source is not None and source["source"]:
        for same, text in alike(cells[:, slice(*source.span("source"))]):
            sources.append((rows[same], text.decode("ascii", "replace")))


def _shapes(data: Bytes, span: Span) -> Iterator[tuple[Places, Bytes, bytes]]:
    """Stretches of one shape: which, their bytes (n, length), and the shape: digits are 0."""
    length = span.b - span.a
    short = np.where((length > 0) & (length <= LONGEST), length, 0)
    for width in np.flatnonzero(np.bincount(short, minlength=1)[1:]) + 1:
        rows = np.flatnonzero(short == width)
        cells = table(data, span.of(rows), int(width))
        digits = (cells >= 48) & (cells <= 57)
        for same, shape in alike(np.where(digits, np.uint8(48), cells)):
            yield rows[same], cells[same], shape


def _reader(cells: Bytes, found: re.Match[bytes]) -> Columns:
    def number(name: str) -> Ints:
        value = np.zeros(len(cells), np.int64)
        for column in range(*found.span(name)):
            value = value * 10 + (cells[:, column].astype(np.int64) - 48)
        return value

    return number


def _coarse(found: re.Match[bytes]) -> bool:
    names = found.groupdict()
    return names.get("s") is not None and names.get("f") is None


def _fraction(found: re.Match[bytes], number: Columns) -> Ints | int:
    if found["f"] is None:
        return 0
    return number("f") * 10 ** (9 - len(found["f"]))


def _clock(found: re.Match[bytes], number: Columns) -> tuple[Ints, int]:
    h, m, s = number("h"), number("mi"), number("s")
    t = ((h * 60 + m) * 60 + s) * SECOND + _fraction(found, number)
    return np.where((h < 24) & (m < 60) & (s <= 60), t, NONE), TIME_OF_DAY


def _dated(found: re.Match[bytes], number: Columns) -> tuple[Ints, int]:
    time, _ = _clock(found, number)
    days, sound = days_of(number("y"), number("mo"), number("d"))
    t = np.where(sound & (time != NONE), days * 24 * HOUR + time, NONE)
    if found["sign"] is not None:
        east = (number("zh") * 60 + number("zm")) * 60 * SECOND
        t = np.where(t != NONE, t + east if found["sign"] == b"-" else t - east, NONE)
    return t, LOCAL if found["z"] is None else ZONED


def _epoch(found: re.Match[bytes], number: Columns) -> tuple[Ints, int]:
    name = next(name for name, text in found.groupdict().items() if text is not None)
    scale = {"s": 1, "ms": 1000, "us": 1_000_000, "ns": SECOND}[name]
    count = number(name)
    sound = (count >= EARLIEST * scale) & (count < LATEST * scale)
    t = count * (SECOND // scale)
    if name == "s" and found.groupdict().get("f") is not None:
        t = t + _fraction(found, number)
    return np.where(sound, t, NONE), ZONED


def days_of(year: Ints, month: Ints, day: Ints) -> tuple[Ints, Mask]:
    """Days since 1970, and which dates exist; (N,) each.

    >>> days, exists = days_of(np.array([1970, 2023]), np.array([1, 2]), np.array([2, 29]))
    >>> days.tolist()[0], exists.tolist()
    (1, [True, False])
    """
    months = ((year - 1970) * 12 + month - 1).astype("datetime64[M]")
    first = months.astype("datetime64[D]").astype(np.int64)
    after = (months + 1).astype("datetime64[D]").astype(np.int64)
    sound = (month >= 1) & (month <= 12) & (day >= 1) & (day <= after - first)
    sound &= (year >= 1970) & (year < 2200)
    return np.where(sound, first + day - 1, first), sound
