"""The clock of a table: stamps [ns] from seconds, indices, dates, days or times of day."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, time, timedelta
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError, UnitError
from trialid.ingest.tables import table_stamps
from trialid.ingest.tables.table import Head, Table, numbers
from trialid.ingest.tables.table_names import is_universal, unit_of_time
from trialid.ingest.tables.template import Time
from trialid.names import units

TIME_NAMES = ("t", "time", "timestamp", "zeit")
DATE_NAMES = ("date", "datum")
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
LATEST_S = 9e9
"""More seconds than this do not fit 64 bits of nanoseconds, and are no seconds."""
DAY_NS = 86_400 * 10**9
FIRST_DAY = {"excel days": 25_569, "matlab datenum": 719_529}
"""What the two count on 1 January 1970."""
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


def clock_by_template(table: Table, spec: Time, zone: str | None) -> Clock:
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
        return _counted(table, columns, spec)
    if spec.kind == "time of day":
        return of_day(table, columns[0], spec)
    return in_seconds(table, columns[0], spec.unit)


def bare(head: Head) -> str:
    """The column's own name, without the group it is in."""
    return head.name.rpartition(".")[2]


def _index(table: Table, name: str) -> int:
    return [head.text for head in table.heads].index(name)


def no_zone(table: Table, zone: str | None) -> None:
    """LogError for a zone that is given to a time which is no date."""
    if zone:
        raise LogError(
            f"{table.path}: its time is no date, so that zone {zone!r} says nothing; leave it out"
        )


def in_seconds(table: Table, column: int, unit: str | None) -> Clock:
    """Numbers in a unit of time: the one told, else that of the header or of its name."""
    head = table.heads[column]
    y = _numbers(table, column)
    stated = unit or head.unit or unit_of_time(bare(head))
    if stated is None:
        _not_days(table, column, y)
    scale = _seconds_per(table, stated or "s")
    for part in _parts(y):
        wrong = ~(np.abs(y[part] * scale) < LATEST_S)
        if wrong.any():
            row = part.start + int(np.argmax(wrong))
            raise LogError(
                f"{table.where(row, column)}: {_shown(table, row, column)!r} is no time in "
                "seconds; state the unit in the header, as in 't[ms]', or delete the line"
            )
    remarks = _resolution(table, column, y, scale)
    t = y.view(np.int64) if table.own else np.empty(len(y), np.int64)
    for part in _parts(y):
        t[part] = np.rint(y[part] * scale * 1e9)
    return Clock(t, (column,), f"column {head.name}", remarks)


def _parts(y: NDArray[np.float64]) -> Iterator[slice]:
    """A long column part by part, as what is made of it on the way is as long again."""
    return (slice(at, at + PART) for at in range(0, len(y), PART))


def _numbers(table: Table, column: int) -> NDArray[np.float64]:
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
    text = _shown(table, row, column)
    place = f"{table.where(row, column)}: {text!r} is no time"
    if re.match(r"\d{1,2}[./-]\d{1,2}[./-]\d{2,4}", text):
        raise LogError(f"{place} that can be read in one way only; write ISO-8601 dates, {TOLD}")
    raise LogError(
        f"{place}; write seconds or ISO-8601 dates (2023-11-05T14:00:00Z), {TOLD}"
    ) from cause


def _shown(table: Table, row: int, column: int) -> str:
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


def _counted(table: Table, columns: Sequence[int], spec: Time) -> Clock:
    rows = len(table.columns[0])
    count = _numbers(table, columns[0]) if columns else np.arange(rows, dtype=np.float64)
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
            shown = _shown(table, row, column)
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


def date_clock(table: Table, columns: tuple[int, ...], spec: Time, zone: str | None) -> Clock:
    """Dates, in one column or two; in UTC where nothing else is said."""
    name = " and ".join(table.heads[column].name for column in columns)
    values = table.columns[columns[0]]
    if spec.kind in FIRST_DAY:
        naive, aware = _days(table, columns[0], FIRST_DAY[spec.kind]), False
        said = f"column {name}, {spec.kind}"
    elif values.dtype.kind == "M" and len(columns) == 1:
        naive = values.astype("datetime64[ns]").astype(np.int64)
        aware = table.utc or _universal(table, columns)
        _no_gaps(table, columns[0], naive)
        said = f"column {name}, dates"
    else:
        naive, aware = _read_dates(table, columns, spec.format)
        aware = aware or _universal(table, columns)
        said = f"column {name}, dates"
    if aware:
        return Clock(naive, columns, f"{said} (UTC where no zone is given)")
    if zone is None:
        return Clock(naive, columns, f"{said} (UTC where no zone is given)")
    t = _localized(table, columns[0], naive, zone)
    return Clock(t, columns, f"{said}, time zone {zone}")


def _universal(table: Table, columns: Sequence[int]) -> bool:
    """Whether the header says that the dates are of UTC."""
    return any(is_universal(bare(table.heads[i]), table.heads[i].unit) for i in columns)


def _days(table: Table, column: int, first: int) -> NDArray[np.int64]:
    days = _numbers(table, column) - first
    wrong = ~(np.abs(days * 86_400.0) < LATEST_S)
    if wrong.any():
        row = int(np.argmax(wrong))
        shown = _shown(table, row, column)
        raise LogError(f"{table.where(row, column)}: {shown!r} is no day; mend or delete the line")
    whole = np.floor(days)
    return whole.astype(np.int64) * DAY_NS + np.rint((days - whole) * DAY_NS).astype(np.int64)


def _no_gaps(table: Table, column: int, t: NDArray[np.int64]) -> None:
    none = t == np.iinfo(np.int64).min
    if none.any():
        row = int(np.argmax(none))
        raise LogError(f"{table.where(row, column)}: '' is no time; delete the line")


def _read_dates(table: Table, columns: Sequence[int], form: str | None) -> table_stamps.Stamps:
    """Stamps as written [ns], and whether the texts stated their zone."""
    texts = join_columns(table, columns, form)
    if form is None and not table_stamps.ISO.match(texts[0] if texts else ""):
        texts = table_stamps.as_iso(texts) or texts
    return table_stamps.stamps(texts, form) or _one_by_one(table, columns, texts, form)


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
    """The slow way, which knows which text is none, and takes texts with and without a zone."""
    dates = [_date(table, row, columns[-1], text, form) for row, text in enumerate(texts)]
    aware = any(date.tzinfo for date in dates)
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
    """Local stamps to UTC; LogError for those a change of the clocks makes none or two of."""
    import pandas as pd

    local = pd.DatetimeIndex(t.astype("datetime64[ns]"))
    known = local.tz_localize(zone, ambiguous="NaT", nonexistent="NaT")
    doubtful = np.asarray(known.isna())
    if doubtful.any():
        row = int(np.argmax(doubtful))
        raise LogError(
            f"{table.where(row, column)}: {local[row]} is no one instant in {zone}, where the "
            "clocks are changed then; export the time in UTC, or cut the hour out"
        )
    return known.tz_convert("UTC").tz_localize(None).as_unit("ns").to_numpy().astype(np.int64)
