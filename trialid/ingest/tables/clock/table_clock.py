"""The clock of a table as its template has it, or as the table leaves no doubt of it."""

import dataclasses
import re
from collections.abc import Sequence
from datetime import time, timedelta
from typing import Any

import numpy as np

from trialid.errors import LogError, list_names
from trialid.ingest.tables.clock import durations, table_stamps
from trialid.ingest.tables.clock.table_dates import date_clock, join_columns
from trialid.ingest.tables.clock.table_time import (
    TIME_NAMES,
    TOLD,
    Clock,
    bare,
    in_samples,
    in_seconds,
    in_two_parts,
    no_zone,
    of_day,
)
from trialid.ingest.tables.table import Head, Table
from trialid.ingest.tables.table_names import is_date, is_time, two_parts
from trialid.ingest.tables.templates.template import Time

UNNAMED = ("", "Unnamed: 0", "column 1", "column A", "__index_level_0__")
"""What stands above the rows' own labels in a table that pandas saved."""
FEWEST = 3
"""Rows that two clocks are compared in at least."""
SECOND_NS = 10**9
YEAR_NS = 366 * 86_400 * SECOND_NS


def clock(table: Table, spec: Time | None, zone: str | None) -> Clock:
    """The table's clock as the template has it, else as the table leaves no doubt of.

    Several columns that tell the same time are one clock; several that do not are refused.

    Raises LogError for what is no time or stands still, and for what may be read in two ways.
    """
    found = _alone(table, zone) if spec is None else _by_template(table, spec, zone)
    if len(found.t) >= FEWEST and found.t[0] == found.t[-1] and np.ptp(found.t) == 0:
        named = list_names([table.heads[column].name for column in found.columns])
        raise LogError(
            f"{table.path}: its time stands still: {named} tells one time in all {len(found.t)} "
            "rows; say in a template which columns tell it, date and time of day where they stand "
            "apart (trialid inspect LOG --template FILE)"
        )
    return found


def _by_template(table: Table, spec: Time, zone: str | None) -> Clock:
    """The table's clock as the template has it; LogError for what is no time."""
    if spec.zone and zone and spec.zone != zone:
        raise LogError(
            f"{table.path}: the log is given zone {zone!r} and its template says {spec.zone!r}; "
            "leave one out"
        )
    columns = tuple(_index(table, name) for name in spec.columns)
    if spec.kind in ("datetime", "excel days", "matlab datenum"):
        return date_clock(table, columns, spec, spec.zone or zone)
    no_zone(table, spec.zone or zone)
    if spec.kind == "index":
        return in_samples(table, columns, spec)
    if spec.kind == "time of day":
        return of_day(table, columns[0], spec)
    return in_seconds(table, columns[0], spec.unit, sure=True)


def _index(table: Table, name: str) -> int:
    return [head.text for head in table.heads].index(name)


def columns_of_time(heads: Sequence[Head]) -> tuple[int, ...]:
    """The columns that are a time or a date by their names, else those that label the rows."""
    named = [i for i, head in enumerate(heads) if is_time(bare(head)) or is_date(bare(head))]
    parts = two_parts([head.name for head in heads]) or ()
    unnamed = [i for i, head in enumerate(heads) if head.name in UNNAMED]
    return tuple(dict.fromkeys((*named, *parts))) or tuple(unnamed)


def _alone(table: Table, zone: str | None) -> Clock:
    times = [i for i, head in enumerate(table.heads) if is_time(bare(head))]
    dates = [i for i, head in enumerate(table.heads) if is_date(bare(head))]
    parts = two_parts([head.name for head in table.heads])
    if parts and not dates and {*times} <= {*parts}:
        no_zone(table, zone)
        return in_two_parts(table, *parts)
    if not times and len(dates) == 1 and _is_dated(table, dates):
        return _plain(table, dates[0], zone)
    if len(times) == 1 and dates:
        return _apart(table, dates, times[0], zone)
    if len(times) == 1:
        return _plain(table, times[0], zone)
    unnamed = [i for i, head in enumerate(table.heads) if head.name in UNNAMED]
    if not times and len(unnamed) == 1 and _is_dated(table, unnamed):
        return _plain(table, unnamed[0], zone)
    same = _same_time(table, times, zone) if len(times) > 1 and not dates else None
    if same is not None:
        return same
    what = "several time columns" if times else "no time column"
    names = list_names([head.name for head in table.heads])
    raise LogError(
        f"{table.path}: {what} among {names}; name exactly one of them "
        + " or ".join(f"{name!r}" for name in TIME_NAMES)
        + f", {TOLD}"
    )


def _apart(table: Table, dates: Sequence[int], clock_at: int, zone: str | None) -> Clock:
    """Date and time in columns of their own, or a time that has its date in itself."""
    if _is_dated(table, [clock_at]):
        return _plain(table, clock_at, zone)
    columns = (dates[0], clock_at)
    if len(dates) == 1 and _is_dated(table, columns):
        return date_clock(table, columns, _spec(table, columns), zone)
    if len(dates) == 1 and (found := _of_one_day(table, columns, zone)) is not None:
        return found
    if len(dates) == 1 and (either := table_stamps.day_or_month(str(table.columns[dates[0]][0]))):
        raise LogError(f"{table.path}: {either}; write ISO-8601 dates, {TOLD}")
    raise LogError(
        f"{table.path}: date and time stand in separate columns, {table.heads[dates[0]].name!r} "
        f"and {table.heads[clock_at].name!r}; write one column of ISO-8601 dates, {TOLD}"
    )


def _is_dated(table: Table, columns: Sequence[int]) -> bool:
    """Whether these columns together are dates that can be read in one way."""
    if len(columns) == 1 and table.columns[columns[0]].dtype.kind == "M":
        return True
    if any(table.columns[i].dtype.kind not in "OM" for i in columns):
        return False
    texts = join_columns(table, columns, None)
    if not texts or not table_stamps.has_a_date(texts[0]):
        return False
    found = table_stamps.as_iso(texts)
    return found is not None and any(len(text) > len("2026-06-03") for text in found)


def _of_one_day(table: Table, columns: tuple[int, ...], zone: str | None) -> Clock | None:
    """Times of one day, whatever its date is: what may be read in two ways is left out."""
    if any(table.columns[i].dtype.kind not in "OM" for i in columns):
        return None
    texts = join_columns(table, columns, None)
    of_day_alone = table_stamps.of_one_day(texts)
    if of_day_alone is None:
        return None
    no_zone(table, zone)
    at = columns[-1]
    held = (*table.columns[:at], np.array(of_day_alone, object), *table.columns[at + 1 :])
    found = of_day(dataclasses.replace(table, columns=held), at, _spec(table, [at]))
    said = f"{table_stamps.day_or_month(texts[0])}: read without its date, {TOLD}"
    return dataclasses.replace(found, columns=columns, remarks=(*found.remarks, said))


def _same_time(table: Table, columns: Sequence[int], zone: str | None) -> Clock | None:
    """One of several columns that tell the same time, dated and fine ones first; None else."""
    found = []
    for column in columns:
        try:
            found.append(_plain(table, column, zone if _is_dated(table, [column]) else None))
        except LogError:
            continue
    if not found or len(found[0].t) < FEWEST:
        return None
    best = max(found, key=lambda one: (abs(one.t[0]) > YEAR_NS, len(np.unique(one.t))))
    step = np.median(np.diff(best.t))
    since = best.t - best.t[0]
    if any(np.abs(one.t - one.t[0] - since).max() > max(step, SECOND_NS) for one in found):
        return None
    others = [table.heads[one.columns[0]].name for one in found if one is not best]
    said = f"{list_names(others)} tell the same time and are left out" if others else ""
    left_out = tuple(c for one in found for c in one.columns if one is not best)
    remarks = (*best.remarks, said) if said else best.remarks
    return dataclasses.replace(best, columns=(*best.columns, *left_out), remarks=remarks)


def _spec(table: Table, columns: Sequence[int]) -> Time:
    return Time(columns=tuple(table.heads[column].text for column in columns))


def _plain(table: Table, column: int, zone: str | None) -> Clock:
    """Seconds, another stated unit of time, dates, or times of day."""
    values = table.columns[column]
    shown = str(values[0]).strip()
    if values.dtype.kind == "M" or re.match(r"\d{4}-\d\d", shown) or _is_dated(table, [column]):
        return date_clock(table, (column,), _spec(table, [column]), zone)
    if (of_one := _of_one_day(table, (column,), zone)) is not None:
        return of_one
    no_zone(table, zone)
    if values.dtype.kind == "O" and _is_clock(values[0]):
        return of_day(table, column, _spec(table, [column]))
    if (written := _durations(table, column)) is not None:
        return written
    return in_seconds(table, column, None)


def _durations(table: Table, column: int) -> Clock | None:
    """The clock of a column of durations that are written in words or with colons."""
    values = table.columns[column]
    if values.dtype.kind != "O" or (found := durations.in_seconds([*map(str, values)])) is None:
        return None
    t = np.rint(np.array(found) * SECOND_NS).astype(np.int64)
    return Clock(t, (column,), f"column {table.heads[column].name}, as written")


def _is_clock(value: Any) -> bool:
    """Whether a cell is a time of day: with its seconds, or it may be minutes and seconds."""
    if isinstance(value, time | timedelta):
        return True
    return table_stamps.CLOCK.fullmatch(str(value).strip()) is not None
