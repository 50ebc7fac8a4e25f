"""CSV logs: a header row, a time column, one column a channel.

A column is `name`, `name[unit]` or `name (unit)`. Separator: comma, semicolon or tab; with the last
two the decimals may stand behind a comma. The time column is called `t`, `time` or `timestamp` and
holds seconds from any origin, another stated unit of time, or ISO-8601 dates.
"""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trialid import units
from trialid.errors import LogError, UnitError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, asked, sha256
from trialid.recording import Channel, Recording

SEPARATORS = ",;\t"
TIME_NAMES = ("t", "time", "timestamp")
MISSING = frozenset({"", "nan", "na", "n/a", "null"})
HEADER = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<square>[^\]]*)\]|\((?P<round>[^)]*)\))?")
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
LATEST_S = 9e9
"""More seconds than this do not fit 64 bits of nanoseconds, and are no seconds."""


@dataclass(frozen=True)
class Head:
    """One field of the header row."""

    name: str
    unit: str | None


@dataclass(frozen=True)
class Table:
    """The file as text: one row a line, with the line number each row ended at."""

    path: Path
    separator: str
    heads: tuple[Head, ...]
    rows: list[list[str]]
    lines: list[int]

    def where(self, row: int, column: int) -> str:
        """Place of a field, as an error names it."""
        return f"{self.path}, line {self.lines[row]}, column {self.heads[column].name!r}"


def recognises(head: bytes) -> bool:
    """A first line of two or more fields that all begin like names."""
    if b"\x00" in head:
        return False
    line = _text(head).partition("\n")[0]
    fields = [field.strip(' "') for field in line.strip().split(_separator(line))]
    return len(fields) > 1 and all(re.match(r"[^\W\d]", field) for field in fields)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted columns; LogError names the line and column of what cannot be read."""
    del aids
    remarks: list[str] = []
    table = _table(path, remarks)
    clock = _time_column(table)
    t, words = _times(table, clock)
    channels: dict[str, Channel] = {}
    for i, head in enumerate(table.heads):
        if i == clock or not asked(head.name, wanted):
            continue
        y = _numbers(table, i)
        if y is None:
            remarks.append(f"column {head.name!r} holds text, left out")
        else:
            channels[head.name] = Channel(head.name, t, y, head.unit, words)
    return Recording(path, ADAPTER.name, sha256(path), channels, tuple(remarks))


def _text(raw: bytes) -> str:
    """UTF-8, else the Windows code page that yards' spreadsheets write."""
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "replace")


def _separator(line: str) -> str:
    return max(SEPARATORS, key=line.count)


def _table(path: Path, remarks: list[str]) -> Table:
    lines = _text(path.read_bytes()).splitlines(keepends=True)
    separator = _separator(lines[0])
    reader = csv.reader(lines, delimiter=separator)
    heads = tuple(_head(field) for field in next(reader))
    try:
        numbered = [(reader.line_num, row) for row in reader if any(row)]
    except csv.Error as error:
        raise LogError(
            f"{path}, line {reader.line_num}: {error}; look for a stray quote"
        ) from error
    if numbered and len(numbered[-1][1]) < len(heads) and not lines[-1].endswith("\n"):
        number, _ = numbered.pop()
        remarks.append(f"line {number}, the last, is cut short and left out")
    table = Table(path, separator, heads, [r for _, r in numbered], [n for n, _ in numbered])
    _check(table)
    return table


def _head(field: str) -> Head:
    found = HEADER.fullmatch(field.strip())
    if found is None:
        return Head(field.strip(), None)
    unit = (found["square"] or found["round"] or "").strip()
    return Head(found["name"].strip(), unit or None)


def _check(table: Table) -> None:
    """LogError unless there are rows, all as long as the header, and every name stands once."""
    names = [head.name for head in table.heads]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise LogError(f"{table.path}: column {twice!r} stands twice in the header; rename one")
    if not table.rows:
        raise LogError(f"{table.path}: a header but no rows; check that the log was exported")
    for number, row in zip(table.lines, table.rows, strict=True):
        if len(row) != len(names):
            raise LogError(
                f"{table.path}, line {number}: {len(row)} fields where the header has {len(names)}"
                f" ({', '.join(names)}); mend or delete the line"
            )


def _time_column(table: Table) -> int:
    found = [i for i, head in enumerate(table.heads) if head.name.lower() in TIME_NAMES]
    if len(found) == 1:
        return found[0]
    what = "several time columns" if found else "no time column"
    names = ", ".join(head.name for head in table.heads)
    raise LogError(
        f"{table.path}: {what} among {names}; name exactly one of them "
        + " or ".join(f"{name!r}" for name in TIME_NAMES)
    )


def _times(table: Table, column: int) -> tuple[NDArray[np.int64], str]:
    """Stamps [ns] and the words for the clock; (N,)."""
    name = f"column {table.heads[column].name}"
    if re.match(r"\d{4}-\d\d", table.rows[0][column].strip()):
        t = [_date(table, row, column) for row in range(len(table.rows))]
        return np.array(t, np.int64), f"{name}, dates (UTC where no zone is given)"
    seconds = _numbers(table, column)
    if seconds is None:
        raise LogError(
            f"{table.where(0, column)}: {table.rows[0][column]!r} is no time; write seconds or "
            "ISO-8601 dates (2023-11-05T14:00:00Z)"
        )
    return _stamps(table, column, seconds), name


def _stamps(table: Table, column: int, y: NDArray[np.float64]) -> NDArray[np.int64]:
    seconds = y * _seconds_per(table, table.heads[column].unit or "s")
    wrong = ~(np.abs(seconds) < LATEST_S)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise LogError(
            f"{table.where(row, column)}: {table.rows[row][column]!r} is no time in seconds; "
            "state the unit in the header, as in 't[ms]', or delete the line"
        )
    return np.rint(seconds * 1e9).astype(np.int64)


def _seconds_per(table: Table, unit: str) -> float:
    try:
        return 1.0 if unit == "s" else units.factor(unit, "s")
    except UnitError as error:
        raise LogError(f"{table.path}, header of the time column: {error}") from error


def _date(table: Table, row: int, column: int) -> int:
    """ISO-8601 to nanoseconds since 1970; without a zone it is taken as UTC."""
    text = table.rows[row][column].strip()
    try:
        date = datetime.fromisoformat(text)
    except ValueError as error:
        place = table.where(row, column)
        raise LogError(f"{place}: {text!r} is no ISO-8601 date; mend or delete the line") from error
    aware = date if date.tzinfo else date.replace(tzinfo=UTC)
    return (aware - EPOCH) // timedelta(microseconds=1) * 1000


def _numbers(table: Table, column: int) -> NDArray[np.float64] | None:
    """A column as numbers, NaN where it is empty; None for a column of text; (N,)."""
    texts = [row[column] for row in table.rows]
    if table.separator != ",":
        texts = [text.replace(",", ".") for text in texts]
    try:
        return np.array([float(text) for text in texts])
    except ValueError:
        return _with_gaps(table, column, texts)


def _with_gaps(table: Table, column: int, texts: Sequence[str]) -> NDArray[np.float64] | None:
    y = np.full(len(texts), np.nan)
    bad = []
    for row, text in enumerate(texts):
        try:
            y[row] = np.nan if text.strip().lower() in MISSING else float(text)
        except ValueError:
            bad.append(row)
    if not bad:
        return y
    if np.isnan(y).all():
        return None
    place, text = table.where(bad[0], column), table.rows[bad[0]][column]
    raise LogError(f"{place}: {text!r} where a number was expected; mend it or leave it empty")


ADAPTER = Adapter("csv", recognises, read, general=True)
