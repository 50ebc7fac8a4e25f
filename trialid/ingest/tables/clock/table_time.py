"""The clock of a table: stamps [ns] from seconds, sample numbers or times of day."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, time, timedelta
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError, UnitError
from trialid.ingest.tables.clock import table_stamps
from trialid.ingest.tables.table import Head, Table, numbers
from trialid.ingest.tables.table_names import unit_of_time
from trialid.ingest.tables.templates.template import Time
from trialid.names import units
from trialid.signal_arrays import SLOWEST

TIME_NAMES = ("t", "time", "timestamp", "zeit")
LATEST_S = 9e9
"""More seconds than this do not fit 64 bits of nanoseconds, and are no seconds."""
SINCE = (946_684_800.0, 4_102_444_800.0)
"""[s] From 1970 to the years 2000 and 2100: what is logged now and fits no other unit."""
DAY_NS = 86_400 * 10**9
DAYS = ((30_000.0, 60_000.0), (693_962.0, 767_010.0))
"""What Excel and MATLAB count between 1982 and 2064, and in the years 1900 to 2100."""
PART = 1 << 20
"""Rows of a column that are gone through at once."""
QUICKEST = 1e-3
"""[s] Seconds that step by less, among such numbers, are rather days."""
TOLD = "or say in a template how the time is written (trialid inspect LOG --template FILE)"
OF_DAY = re.compile(r"(\d{1,2}):(\d\d)(?::(\d\d(?:[.,]\d+)?))?")


@dataclass(frozen=True)
class Clock:
    """Stamps [ns] (N,), the columns they were taken from, words for the report."""

    t: NDArray[np.int64]
    columns: tuple[int, ...]
    words: str
    remarks: tuple[str, ...] = ()


def bare(head: Head) -> str:
    """The column's own name, without the group it is in."""
    return head.name.rpartition(".")[2]


def no_zone(table: Table, zone: str | None) -> None:
    """LogError for a zone that is given to a time which is no date."""
    if zone:
        raise LogError(
            f"{table.path}: its time is no date, so that zone {zone!r} says nothing; leave it out"
        )


def in_seconds(table: Table, column: int, unit: str | None, *, sure: bool = False) -> Clock:
    """Numbers in a unit of time: the one told, else that of the header or of its name.

    `sure` where somebody said that they are seconds, if nothing else is stated.
    """
    head = table.heads[column]
    y = time_numbers(table, column)
    stated = unit or head.unit or unit_of_time(bare(head))
    if stated is None:
        _not_days(table, column, y)
    by_size = None if stated else _since_1970(y)
    if stated is None and by_size is None and not sure:
        _not_thousandths(table, column, y)
    scale = _seconds_per(table, stated or by_size or "s")
    for part in _parts(y):
        wrong = ~(np.abs(y[part] * scale) < LATEST_S)
        if wrong.any():
            row = part.start + int(np.argmax(wrong))
            raise LogError(
                f"{table.where(row, column)}: {show_value(table, row, column)!r} is no time in "
                "seconds; state the unit in the header, as in 't[ms]', or delete the line"
            )
    remarks = _resolution(table, column, y, scale)
    if by_size:
        remarks = (*remarks, f"its times are {by_size} since 1970 by their size: no unit is stated")
    t = y.view(np.int64) if table.own else np.empty(len(y), np.int64)
    for part in _parts(y):
        t[part] = np.rint(y[part] * scale * 1e9)
    return Clock(t, (column,), f"column {head.name}", remarks)


def _not_thousandths(table: Table, column: int, y: NDArray[np.float64]) -> None:
    """LogError for whole numbers that may count thousandths of a second, or less, as well."""
    whole = len(y) > 2 and all((y[part] == np.rint(y[part])).all() for part in _parts(y))
    if not whole or (SINCE[0] < y.min() and y.max() < SINCE[1]):
        return
    if (step := float(np.quantile(np.abs(np.diff(y)), 0.5, method="lower"))) >= SLOWEST:
        raise LogError(
            f"{table.where(0, column)}: whole numbers that step by {step:.10g} may be seconds, "
            f"milliseconds or less; state the unit in the header, as in "
            f"'{table.heads[column].name}[ms]', {TOLD}"
        )


def _since_1970(y: NDArray[np.float64]) -> str | None:
    """The unit in which numbers too large for seconds are dates since 1970; None for others."""
    within = [
        unit
        for unit, of_one in (("ms", 1e3), ("us", 1e6), ("ns", 1e9))
        if len(y) and (of_one * SINCE[0] < y).all() and (y < of_one * SINCE[1]).all()
    ]
    return within[0] if within else None


def in_two_parts(table: Table, whole: int, part: int) -> Clock:
    """Whole seconds in one column and nanoseconds in another, as stamps of ROS are written."""
    seconds, beside = (time_numbers(table, column) for column in (whole, part))
    for column, wrong, what in (
        (whole, ~(np.abs(seconds) < LATEST_S) | (seconds % 1.0 != 0.0), "whole seconds"),
        (part, ~((beside >= 0.0) & (beside < 1e9)), "nanoseconds of one second"),
    ):
        if wrong.any():
            row = int(np.argmax(wrong))
            shown = show_value(table, row, column)
            raise LogError(
                f"{table.where(row, column)}: {shown!r} are no {what}; mend or delete the line"
            )
    t = seconds.astype(np.int64) * 10**9 + np.rint(beside).astype(np.int64)
    named = " and ".join(table.heads[column].name for column in (whole, part))
    return Clock(t, (whole, part), f"columns {named}, seconds and nanoseconds")


def _parts(y: NDArray[np.float64]) -> Iterator[slice]:
    """A long column part by part, as what is made of it on the way is as long again."""
    return (slice(at, at + PART) for at in range(0, len(y), PART))


def time_numbers(table: Table, column: int) -> NDArray[np.float64]:
    """The numbers of a column of times; LogError at the first that is none."""
    try:
        y = numbers(table, column)
    except LogError as error:
        # A stray text among stamps: told as a stamp, for a line without time cannot stay.
        row = _first_text(table, column)
        _no_time(table, row, column, error)
    if y is None:
        _no_time(table, 0, column, None)
    return y


def _first_text(table: Table, column: int) -> int:
    for row, value in enumerate(table.columns[column]):
        try:
            table.number(value)
        except (ValueError, TypeError):
            return row
    return 0


def _no_time(table: Table, row: int, column: int, cause: LogError | None) -> NoReturn:
    text = show_value(table, row, column)
    place = f"{table.where(row, column)}: {text!r} is no time"
    if either := table_stamps.day_or_month(text):
        raise LogError(f"{table.where(row, column)}: {either}; write ISO-8601 dates, {TOLD}")
    if re.match(r"\d{1,2}[./-]\d{1,2}[./-]\d{2,4}", text):
        raise LogError(f"{place} that can be read in one way only; write ISO-8601 dates, {TOLD}")
    raise LogError(
        f"{place}; write seconds or ISO-8601 dates (2023-11-05T14:00:00Z), {TOLD}"
    ) from cause


def show_value(table: Table, row: int, column: int) -> str:
    """A value as an error shows it."""
    value = table.columns[column][row]
    if isinstance(value, float | np.floating):
        return "" if np.isnan(value) else f"{value:.17g}"
    return str(value).strip()


def _not_days(table: Table, column: int, y: NDArray[np.float64]) -> None:
    """LogError for numbers that are seconds at an unlikely rate, and days at a likely one."""
    if len(y) < 2:
        return
    within = any(low < y.min() and y.max() < high for low, high in DAYS)  # not with NaN
    if within and 0.0 < np.median(np.abs(np.diff(y))) < QUICKEST:
        raise LogError(
            f"{table.where(0, column)}: {y[0]:.10g} may be seconds or days; state the unit in the "
            f"header, {TOLD}"
        )


def _resolution(table: Table, column: int, y: NDArray[np.float64], scale: float) -> tuple[str, ...]:
    """Remark on stamps that went through 32 bits; LogError where those cannot tell them apart."""
    narrow = table.columns[column].dtype == np.float32
    exact = all((y[part] == y[part].astype(np.float32)).all() for part in _parts(y))
    if len(y) < 3 or not (narrow or exact):
        return ()
    most = np.float32(max(abs(y.min()), abs(y.max())))
    finest = float(np.spacing(most)) * scale
    step = float(np.ptp(y)) * scale / (len(y) - 1)
    if finest > 0.5 * step and (narrow or len(np.unique(y)) < len(y)):
        raise LogError(
            f"{table.path}: column {table.heads[column].name!r} went through 32 bits, which tell "
            f"times {finest:.3g} s apart where samples are {step:.3g} s apart; export the time in "
            "64 bits, or as seconds from the start"
        )
    if narrow and finest > 0.01 * step:
        return (f"stamps of 32 bits, good to {finest:.2g} s",)
    return ()


def _seconds_per(table: Table, unit: str) -> float:
    try:
        return 1.0 if unit == "s" else units.factor(unit, "s")
    except UnitError as error:
        raise LogError(f"{table.path}, header of the time column: {error}") from error


def in_samples(table: Table, columns: Sequence[int], spec: Time) -> Clock:
    """Sample numbers of a column, or the rows counted, at the template's rate."""
    rows = len(table.columns[0])
    count = time_numbers(table, columns[0]) if columns else np.arange(rows, dtype=np.float64)
    rate = spec.rate or 1.0
    seconds = count / rate
    wrong = ~(np.abs(seconds) < LATEST_S)
    if wrong.any():
        row = int(np.argmax(wrong))
        place = table.where(row, columns[0]) if columns else str(table.path)
        raise LogError(f"{place}: is no sample number; mend or delete the line")
    what = f"column {table.heads[columns[0]].name}" if columns else "row number"
    t = np.rint(seconds * 1e9).astype(np.int64)
    return Clock(t, tuple(columns), f"{what}, {rate:g} a second")


def of_day(table: Table, column: int, spec: Time) -> Clock:
    """Nanoseconds since the midnight before the first row; the clock runs on through others."""
    t = np.empty(len(table.columns[column]), np.int64)
    for row, value in enumerate(table.columns[column]):
        found = _since_midnight(value, spec.format)
        if found is None:
            shown = show_value(table, row, column)
            raise LogError(
                f"{table.where(row, column)}: {shown!r} is no time of day "
                f"({spec.format or '14:30:05.25'}); mend or delete the line"
            )
        t[row] = found
    days = np.cumsum(np.diff(t, prepend=t[:1]) < -DAY_NS // 2)
    words = f"column {table.heads[column].name}, time of day without a date"
    said = (
        f"the time of day passes midnight at {table.place(int(np.argmax(days > 0)))}, "
        "stamps run on from there"
    )
    return Clock(t + days * DAY_NS, (column,), words, (said,) if days[-1] else ())


def _since_midnight(value: Any, form: str | None) -> int | None:
    """[ns], or None for what is no time of day."""
    if isinstance(value, datetime):
        value = value.time()
    if isinstance(value, timedelta):
        return value // timedelta(microseconds=1) * 1000
    if not isinstance(value, time):
        text = str(value).strip()
        if form is None:
            return _hours(text)
        try:
            value = datetime.strptime(text.replace(",", "."), form).time()
        except ValueError:
            return None
    seconds = (value.hour * 60 + value.minute) * 60 + value.second
    return (seconds * 1_000_000 + value.microsecond) * 1000


def _hours(text: str) -> int | None:
    found = OF_DAY.fullmatch(text)
    if found is None:
        return None
    hours, minutes, seconds = found.groups()
    within = int(hours) < 24 and int(minutes) < 60
    past = float((seconds or "0").replace(",", "."))
    if not within or past >= 61.0:
        return None
    return (int(hours) * 60 + int(minutes)) * 60 * 10**9 + round(past * 1e9)
