"""ZDA, RMC and fixes of a receiver as the clock of a log whose lines have no stamps."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.nmea0183.nmea0183_columns import numbers
from trialid.ingest.nmea0183.nmea0183_sentences import Mask, Places, Sentences, Span
from trialid.ingest.nmea0183.nmea0183_stamps import NONE, SECOND, days_of

Ints = NDArray[np.int64]

CLOCKS = {"ZDA": 1, "RMC": 1, "GGA": 1, "GNS": 1, "GLL": 5}
"""In which field a sentence states its time of day; the first two have a date, too."""
DAY = 86_400 * SECOND
JUMP = 5.0
"""Times further apart than this many usual steps are not interpolated between."""
CENTURY = 80
"""Two digits of a year from here on are of the last century: GPS began in 1980."""


@dataclass(frozen=True)
class Ticks:
    """Sentences that state the time; (N,) each.

    Which of the log, date and time [ns] or NONE, time of day [ns], and whether the receiver calls
    it valid.
    """

    rows: Places
    dated: Ints
    of_day: Ints
    valid: Mask


@dataclass(frozen=True)
class Clock:
    """A time for every sentence of the log, NONE where there is none, and words on it.

    `tick` is the usual time between those that state one [ns].
    """

    t: Ints
    words: str
    remarks: tuple[str, ...]
    tick: int


def ticks(block: Sentences, rows: Places, sentence: str, offset: int) -> Ticks:
    """Times that some sentences of one kind state; rows count from `offset`."""
    of_day = _time_of_day(block, block.field(rows, CLOCKS[sentence]))
    sound, days = np.zeros(len(rows), np.bool_), np.zeros(len(rows), np.int64)
    if sentence == "ZDA":
        days, sound = _date_of_zda(block, rows)
        valid = np.ones(len(rows), np.bool_)
    elif sentence == "RMC":
        days, sound = _date_of_rmc(block, rows)
        valid = block.letter(rows, 2) == ord("A")
    else:  # a quality, a mode or a status; without a fix 0, N or V
        valid = ~np.isin(block.letter(rows, 6), [ord(no) for no in "0NV"])
    timed = of_day != NONE
    dated = np.where(sound & timed, days * DAY + of_day, NONE)
    return Ticks(rows[timed] + offset, dated[timed], of_day[timed], valid[timed])


def join_ticks(parts: list[Ticks]) -> Ticks:
    """The ticks of one sentence and talker from all blocks."""
    return Ticks(
        np.concatenate([part.rows for part in parts]),
        np.concatenate([part.dated for part in parts]),
        np.concatenate([part.of_day for part in parts]),
        np.concatenate([part.valid for part in parts]),
    )


def clock(total: int, by_name: dict[str, Ticks]) -> Clock | None:
    """Times of all sentences, interpolated by their place between those that state one.

    Dates are better than times of day, valid ones better than others, many better than few; None
    where no sentence states a time twice.
    """
    best: tuple[tuple[bool, int, int], str, Ticks] | None = None
    for name, one in by_name.items():
        dated = int((one.dated != NONE).sum())
        rank = (dated > 1, int((one.valid & (one.dated != NONE)).sum()), max(dated, len(one.rows)))
        if len(one.rows) > 1 and (best is None or rank > best[0]):
            best = rank, name, one
    if best is None:
        return None
    (has_dates, _, _), name, one = best
    if has_dates:
        keep = one.dated != NONE
        rows, times, valid = one.rows[keep], one.dated[keep], one.valid[keep]
    else:
        rows, times, valid = one.rows, unwrap_midnights(one.of_day), one.valid
    return _between(total, name, rows, times, valid, has_dates)


def unwrap_midnights(of_day: Ints) -> Ints:
    """Times of day that go on counting over midnight; steps of half a day and more are midnights.

    >>> unwrap_midnights(np.array([23, 1, 2]) * 3600 * SECOND) // (3600 * SECOND)
    array([23, 25, 26])
    """
    step = np.diff(of_day)
    days = np.cumsum((step < -DAY // 2).astype(np.int64) - (step > DAY // 2))
    return of_day + np.concatenate([[0], days]).astype(np.int64)[: len(of_day)] * DAY


def _between(
    total: int, name: str, rows: Places, times: Ints, valid: Mask, has_dates: bool
) -> Clock | None:
    fresh = np.concatenate([[True], np.diff(times) != 0])
    rows, times, valid = rows[fresh], times[fresh], valid[fresh]
    step = np.diff(times)
    forward = step[step > 0]
    if not len(forward):
        return None
    usual = float(np.median(forward))
    good = (step > 0) & (step <= JUMP * usual)
    back = np.flatnonzero(step <= 0)
    good[back[back > 0] - 1] = False
    good &= _trusted(good, valid)
    t = _interpolated(total, rows, times, good)
    words = f"times of {name}, interpolated by place in the log"
    words += "" if has_dates else "; time of day, no date"
    remarks = [f"no stamps on the lines; {words}: good to about {usual / SECOND:g} s"]
    jumps = int(((step <= 0) | (step > JUMP * usual)).sum())
    if jumps:
        remarks.append(f"the times of {name} jump {jumps} times; what lies there has no time")
    return Clock(t, words, tuple(remarks), round(usual))


def _trusted(good: Mask, valid: Mask) -> Mask:
    """Steps of the stretches in which the receiver called at least one time valid, if it ever did.

    A receiver without a fix may count on from a date of its own making.
    """
    if not valid.any():
        return np.ones(len(good), np.bool_)
    stretch = np.cumsum(np.concatenate([[0], ~good]))
    return np.isin(stretch, np.unique(stretch[valid]))[1:]


def _interpolated(total: int, rows: Places, times: Ints, good: Mask) -> Ints:
    place = np.arange(total)
    tick = np.clip(np.searchsorted(rows, place, "right") - 1, 0, len(rows) - 2)
    share = (place - rows[tick]) / (rows[tick + 1] - rows[tick])
    inside = good[tick] & (share >= 0) & (share <= 1)
    t = times[tick] + np.rint(share * np.diff(times)[tick]).astype(np.int64)
    return np.where(inside, t, NONE)


def _time_of_day(block: Sentences, span: Span) -> Ints:
    """`hhmmss` or `hhmmss.ss` [ns], NONE where it is none."""
    value, bad = numbers(block.data, span)
    sound = ~bad & np.isfinite(value) & (value >= 0) & (span.b - span.a >= 6)
    whole = np.where(sound, value, 0).astype(np.int64)
    h, m, s = whole // 10_000, whole // 100 % 100, whole % 100
    sound &= (h < 24) & (m < 60) & (s <= 60)
    micros = np.rint((np.where(sound, value, 0) - whole) * 1e6).astype(np.int64)
    return np.where(sound, ((h * 60 + m) * 60 + s) * SECOND + micros * 1000, NONE)


def _whole(block: Sentences, span: Span, length: int) -> Ints:
    """Whole numbers of so many digits; -1 where there is none."""
    value, _ = numbers(block.data, span)
    sound = (span.b - span.a == length) & (value >= 0) & (value == np.floor(value))
    return np.where(sound, value, -1).astype(np.int64)


def _date_of_zda(block: Sentences, rows: Places) -> tuple[Ints, Mask]:
    """The year has four digits by the standard; two are no date."""
    day, month = (_whole(block, block.field(rows, at), 2) for at in (2, 3))
    return days_of(_whole(block, block.field(rows, 4), 4), month, day)


def _date_of_rmc(block: Sentences, rows: Places) -> tuple[Ints, Mask]:
    date = _whole(block, block.field(rows, 9), 6)
    year = date % 100
    return days_of(
        np.where(date < 0, -1, year + np.where(year < CENTURY, 2000, 1900)),
        date // 100 % 100,
        date // 10_000,
    )
