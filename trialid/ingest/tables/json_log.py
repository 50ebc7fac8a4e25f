"""JSON logs: a record a line, a list of records, or an object with a list a column.

What is nested in a record is a column with both names: `{"t": 0.1, "imu": {"rate": [0.2]}}` has the
columns `t` and `imu.rate.0`. A field that a record lacks, or that is null, was not measured then.
"""

import json
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from trialid.errors import LogError, reason_of
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted
from trialid.ingest.bytes.encoded_text import UTF_8
from trialid.ingest.tables.table import (
    Table,
    Values,
    blank_out,
    check_width,
    head,
    reader_of_numbers,
)
from trialid.ingest.tables.table_channels import recording
from trialid.ingest.tables.table_names import is_time, two_parts
from trialid.ingest.tables.templates import template
from trialid.recording import Recording

Record = dict[str, Any]

BEGINS: Final = re.compile(rb'(?:\[\s*+)?+\{\s*+"')
COLUMNS: Final = re.compile(rb'\{\s*+"[^"\n]*+"\s*+:\s*+\[')
KEY: Final = re.compile(rb'"([^"\\\n]{1,64})"\s*+:')
BLOCK: Final = 4_000_000
"""Bytes of lines that are read at once, so that their numbers take little memory."""
LONGEST: Final = 2_000_000
"""Bytes of a line that is still a record."""
MOST_BYTES: Final = 50_000_000
"""Of a file that is one value: it takes ten times as much memory."""
MOST_VALUES: Final = 50_000_000
"""Numbers of one log; a record may name any fields, and all others lack them."""
FAILURES: Final = (ValueError, RecursionError)
DELTA: Final = re.compile(rb'[^\n]*"updates"\s*+:')
"""The first line of Signal K's deltas, which are no table."""
CANBOAT: Final = re.compile(rb'[^\n]*"pgn"\s*+:')
"""And of what canboat's analyzer writes: messages of all kinds, with units by its own options."""


def recognises(start: bytes) -> bool:
    """Records with a time: more than one on lines of their own, a list of them, or columns."""
    return may_be_one(start) and bool(_times(start))


def nearly(start: bytes) -> str | None:
    """What JSON lacks that is no log to be read."""
    if CANBOAT.match(start):
        return "it is what canboat's analyzer made of a log, in units not stated; give that log"
    if not may_be_one(start) or _times(start):
        return None
    return "it is JSON, but none of its fields is called a time; a template says which is"


def may_be_one(start: bytes) -> bool:
    """Whether it begins as a log does, and not as one object that says something of a log."""
    text = start.removeprefix(UTF_8).lstrip()
    if BEGINS.match(text) is None or DELTA.match(text) or CANBOAT.match(text):
        return False
    first, ended, more = text.partition(b"\n")
    if first.startswith(b"[") or COLUMNS.match(text):
        return True
    one = _parsed(first) is not None
    return one == bool(ended and more.strip())  # a whole line of several, or one that goes on


def _times(start: bytes) -> list[str]:
    keys = list(dict.fromkeys(one.decode("utf-8", "replace") for one in KEY.findall(start)))
    both = two_parts(keys)
    return [key for key in keys if is_time(key)] + [keys[i] for i in both or ()]


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted fields; LogError names the line or record of what cannot be read."""
    told = None if aids.template is None else template.load(aids.template)
    remarks = list[str]()
    blocks = [_gathered(path, block) for block in _blocks(path, remarks) if block]
    if not blocks:
        raise LogError(f"{path}: holds no record; check that the log was exported")
    names = dict.fromkeys(name for columns, _ in blocks for name in columns)
    _check_size(path, sum(rows for _, rows in blocks), len(names))
    if told is not None:
        template.check_header(path, [*names], told)
    missing = frozenset(told.missing if told else ())
    columns = (np.concatenate([_column(*block, name) for block in blocks]) for name in names)
    table = Table(
        path,
        tuple(head(name) for name in names),
        tuple(blank_out(one, missing) for one in columns),
        _place,
        reader_of_numbers(".", None, missing),
        remarks=tuple(remarks),
        own=True,
    )
    return recording(table, ADAPTER.name, wanted, aids, told)


def top(path: Path) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """The fields of its first records, and what the first two of these have in them."""
    block = next(_blocks(path, []), [])
    header = tuple(dict.fromkeys(name for record in block for name in record))
    return header, [tuple(str(one.get(name, "")) for name in header) for one in block[:2]]


def _place(row: int) -> str:
    return f"record {row + 1}"


def _blocks(path: Path, remarks: list[str]) -> Iterator[list[Record]]:
    """Its records in turn, some at once; a last line that is cut off is told in the remarks."""
    with path.open("rb") as file:
        first = file.readline(LONGEST).removeprefix(UTF_8)
        if _parsed(first) is None or not file.read(1):  # one value in all of the file
            yield _of_one_value(path)
            return
        file.seek(0)
        number = 1
        while lines := file.readlines(BLOCK):
            yield list(_of_lines(path, number, lines, remarks))
            number += len(lines)


def _of_lines(path: Path, number: int, lines: list[bytes], remarks: list[str]) -> Iterator[Record]:
    """The records of lines, the first of them `number` in its file."""
    for place, line in enumerate(lines, number):
        text = line.removeprefix(UTF_8).strip()
        record = _parsed(text) if len(line) < LONGEST else None
        if record is not None:
            yield _flat(path, record)
        elif text and line.endswith(b"\n"):
            raise LogError(
                f"{path}, line {place}: {_shown(text)} is no JSON object, as the lines before are; "
                "mend or delete the line"
            )
        elif text:
            remarks.append(f"line {place}, the last, is cut off and left out")


def _shown(text: bytes) -> str:
    return f"{text.decode('utf-8', 'replace'):.40}"


def _parsed(text: bytes) -> Record | None:
    """The object that a text is; None where it is none, or not whole."""
    try:
        found = json.loads(text)
    except FAILURES:
        return None
    return found if isinstance(found, dict) else None


def _of_one_value(path: Path) -> list[Record]:
    """The records of a file that is one list of them, or one object with a list a column."""
    if path.stat().st_size > MOST_BYTES:
        raise LogError(
            f"{path}: is one JSON value of more than {MOST_BYTES // 10**6} MB; export one record a "
            "line"
        )
    try:
        found = json.loads(path.read_bytes().removeprefix(UTF_8))
    except FAILURES as error:
        raise LogError(
            f"{path}: is no JSON that can be read ({reason_of(error)}); copy it again, or export "
            "one record a line"
        ) from error
    records = _turned(path, found) if isinstance(found, dict) else found
    odd = next((i for i, one in enumerate(records, 1) if not isinstance(one, dict)), 0)
    if odd:
        raise LogError(f"{path}, record {odd}: is no JSON object; export one object a sample")
    return [_flat(path, one) for one in records]


def _turned(path: Path, found: Record) -> list[Record]:
    """Columns as records; LogError for an object that has none."""
    columns = found.values()
    sizes = {len(one) if isinstance(one, list) else -1 for one in columns}
    if len(sizes) != 1 or -1 in sizes:
        raise LogError(
            f"{path}: one JSON object with {', '.join([*found][:5])}, and no list of equal length "
            "for each; export a list of records, or one record a line"
        )
    return [dict(zip(found, row, strict=True)) for row in zip(*columns, strict=True)]


def _flat(path: Path, record: Record) -> Record:
    """Its plain values by name; LogError for a nest without end."""
    try:
        return dict(_fields(record))
    except RecursionError:
        raise LogError(f"{path}: a record is nested too deeply for a log's") from None


def _check_size(path: Path, rows: int, columns: int) -> None:
    check_width(path, columns)
    if rows * columns > MOST_VALUES:
        raise LogError(
            f"{path}: {rows} records with {columns} fields are more than {MOST_VALUES // 10**6} "
            "million values; export a shorter time, or fewer fields"
        )


def _gathered(path: Path, block: list[Record]) -> tuple[dict[str, Values], int]:
    """The fields of some records by name, and how many records there are."""
    found = dict[str, list[Any]]()
    for row, record in enumerate(block):
        for name, value in record.items():
            column = found.setdefault(name, [])
            column += [None] * (row - len(column))
            column.append(value)
        _check_size(path, len(block), len(found))
    full = (column + [None] * (len(block) - len(column)) for column in found.values())
    return dict(zip(found, map(_values, full), strict=True)), len(block)


def _fields(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Every plain value within a record, with the names on the way to it."""
    parts: Iterable[tuple[str, Any]]
    if isinstance(value, dict):
        parts = ((f"{name}.{key}" if name else key, part) for key, part in value.items())
    elif isinstance(value, list):
        parts = ((f"{name}.{i}", part) for i, part in enumerate(value))
    else:
        yield name, str(value) if isinstance(value, bool) else value
        return
    for longer, part in parts:
        yield from _fields(part, longer)


def _values(column: list[Any]) -> Values:
    """Numbers where nothing else is in it; (N,)."""
    try:
        if not any(isinstance(one, str) for one in column):
            return np.array([np.nan if one is None else one for one in column], np.float64)
    except OverflowError:  # a whole number beyond all others: no instrument's
        pass
    found = np.empty(len(column), object)
    found[:] = column
    return found


def _column(columns: dict[str, Values], rows: int, name: str) -> Values:
    """A field of some records; without values where none of them has it."""
    return columns[name] if name in columns else np.full(rows, np.nan)


ADAPTER = Adapter(
    "json",
    recognises,
    read,
    frozenset({"template", "zone"}),
    by_template=may_be_one,
    nearly=nearly,
)
