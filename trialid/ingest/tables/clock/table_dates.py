"""Dates of a table: stamps [ns] of texts, of dates and of days counted, in UTC or in a zone."""

from collections.abc import Sequence
from datetime import UTC, datetime, time, timedelta
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.tables.clock import table_stamps
from trialid.ingest.tables.clock.lost_zeros import with_lost_zeros
from trialid.ingest.tables.clock.table_time import (
    DAY_NS,
    LATEST_S,
    Clock,
    bare,
    show_value,
    time_numbers,
)
from trialid.ingest.tables.table import Table
from trialid.ingest.tables.table_names import is_universal
from trialid.ingest.tables.templates.template import Time
from trialid.recording import ZONELESS

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
FIRST_DAY = {"excel days": 25_569, "matlab datenum": 719_529}
"""What the two count on 1 January 1970."""


def date_clock(table: Table, columns: tuple[int, ...], spec: Time, zone: str | None) -> Clock:
    """Dates, in one column or two; in UTC where nothing else is said."""
    name, remark = " and ".join(table.heads[column].name for column in columns), ""
    values = table.columns[columns[0]]
    if spec.kind in FIRST_DAY:
        naive = _days(table, columns[0], FIRST_DAY[spec.kind])
        aware = _universal(table, columns)
        said = f"column {name}, {spec.kind}"
    elif values.dtype.kind == "M" and len(columns) == 1:
        naive = values.astype("datetime64[ns]").astype(np.int64)
        aware = table.utc or _universal(table, columns)
        _no_gaps(table, columns[0], naive)
        said = f"column {name}, dates"
    else:
        naive, aware, remark = _read_dates(table, columns, spec.format)
        aware = aware or _universal(table, columns)
        said = f"column {name}, dates"
    remarks = (f"{table.path.name}: {remark}",) if remark else ()
    if aware or zone is None:
        words = f"{said}, UTC" if aware else f"{said} (no zone stated, {ZONELESS})"
        return Clock(naive, columns, words, remarks)
    t = _localized(table, columns[0], naive, zone)
    return Clock(t, columns, f"{said}, time zone {zone}", remarks)


def _universal(table: Table, columns: Sequence[int]) -> bool:
    """Whether the header says that the dates are of UTC."""
    return any(is_universal(bare(table.heads[i]), table.heads[i].unit) for i in columns)


def _days(table: Table, column: int, first: int) -> NDArray[np.int64]:
    days = time_numbers(table, column) - first
    wrong = ~(np.abs(days * 86_400.0) < LATEST_S)
    if wrong.any():
        row = int(np.argmax(wrong))
        shown = show_value(table, row, column)
        raise LogError(f"{table.where(row, column)}: {shown!r} is no day; mend or delete the line")
    whole = np.floor(days)
    return whole.astype(np.int64) * DAY_NS + np.rint((days - whole) * DAY_NS).astype(np.int64)


def _no_gaps(table: Table, column: int, t: NDArray[np.int64]) -> None:
    none = t == np.iinfo(np.int64).min
    if none.any():
        row = int(np.argmax(none))
        raise LogError(f"{table.where(row, column)}: '' is no time; delete the line")


def _read_dates(
    table: Table, columns: Sequence[int], form: str | None
) -> tuple[NDArray[np.int64], bool, str]:
    """Stamps as written [ns], whether the texts stated their zone, and what is remarked."""
    texts = join_columns(table, columns, form)
    if form is None and not table_stamps.ISO.match(texts[0] if texts else ""):
        texts = table_stamps.as_iso(texts) or texts
    t, aware = table_stamps.stamps(texts, form) or _one_by_one(table, columns, texts, form)

    def again(written: list[str]) -> NDArray[np.int64] | None:
        found = table_stamps.stamps(written, form)
        return None if found is None else found[0]

    t, remark = with_lost_zeros(texts, t, again)
    return t, aware, remark


def join_columns(table: Table, columns: Sequence[int], form: str | None) -> list[str]:
    """The texts of these columns, of each row one."""
    parts = [_date_texts(table.columns[column].tolist()) for column in columns]
    return [table_stamps.write_point(" ".join(words), form) for words in zip(*parts, strict=True)]


def _date_texts(values: Sequence[Any]) -> list[str]:
    if set(map(type, values)) == {str}:
        return [value.strip() for value in values]
    return [_date_text(value) for value in values]


def _date_text(value: Any) -> str:
    if isinstance(value, np.datetime64):
        value = value.astype("datetime64[us]").item()
    if isinstance(value, datetime) and value.time() == time():
        return value.date().isoformat()
    return str(value).strip()


def _one_by_one(
    table: Table, columns: Sequence[int], texts: Sequence[str], form: str | None
) -> tuple[NDArray[np.int64], bool]:
    """The slow way, which knows which text is none, or without a zone where others have one."""
    dates = [_date(table, row, columns[-1], text, form) for row, text in enumerate(texts)]
    zoned = [date.tzinfo is not None for date in dates]
    aware = any(zoned)
    if aware != all(zoned):
        row = zoned.index(False)
        raise LogError(
            f"{table.where(row, columns[-1])}: {texts[row]!r} states no zone, where other rows do; "
            "state one in every row, or in none and give its name with --zone"
        )
    utc = (date if date.tzinfo else date.replace(tzinfo=UTC) for date in dates)
    nanos = [(date - EPOCH) // timedelta(microseconds=1) * 1000 for date in utc]
    late = next((row for row, one in enumerate(nanos) if abs(one) >= LATEST_S * 1e9), None)
    if late is not None:
        place = table.where(late, columns[-1])
        raise LogError(f"{place}: {texts[late]!r} is out of range; mend or delete the line")
    return np.array(nanos, np.int64), aware


def _date(table: Table, row: int, column: int, text: str, form: str | None) -> datetime:
    try:
        return datetime.fromisoformat(text) if form is None else datetime.strptime(text, form)
    except ValueError as error:
        place = table.where(row, column)
        what = "ISO-8601 date" if form is None else f"date of the form {form}"
        raise LogError(f"{place}: {text!r} is no {what}; mend or delete the line") from error


def _localized(table: Table, column: int, t: NDArray[np.int64], zone: str) -> NDArray[np.int64]:
    """Local stamps to UTC; LogError for those a change of the clocks makes none or two of.

    Of an hour that comes twice the rows before the step back in it are of summer, where it is the
    one in the log that goes back by more than half of an hour.
    """
    import pandas as pd

    local = pd.DatetimeIndex(t.astype("datetime64[ns]"))
    known = local.tz_localize(zone, ambiguous="NaT", nonexistent="NaT")
    doubtful = np.asarray(known.isna())
    back = np.flatnonzero(np.diff(t) < -DAY_NS // 48)
    if len(back) == 1 and doubtful[back[0]] and doubtful[back[0] + 1]:
        summer = np.arange(len(t)) <= back[0]
        known = local.tz_localize(zone, ambiguous=summer, nonexistent="NaT")
        doubtful = np.asarray(known.isna())
    if doubtful.any():
        row = int(np.argmax(doubtful))
        raise LogError(
            f"{table.where(row, column)}: {local[row]} is no one instant in {zone}, where the "
            "clocks are changed then; export the time in UTC, or cut the hour out"
        )
    return known.tz_convert("UTC").tz_localize(None).as_unit("ns").to_numpy().astype(np.int64)
