"""SQLite databases that python-can writes to frames.

A damaged database is read as far as SQLite goes from its first row on, and then from its last row
back. Nothing it states is believed: neither sizes nor that its pages are a tree.
"""

import math
import sqlite3
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trialid.errors import LogError, reason_of
from trialid.ingest.bytes import text_fields
from trialid.ingest.can.can_frames import EXTENDED_ID, Frames, Tally, join_frames, no_frames

HEAD = b"SQLite format 3\0"
COLUMNS = ("ts", "arbitration_id", "extended", "remote", "error", "dlc", "data")
ROWS = 1 << 16
LARGEST_ID = 1 << 30
LONGEST = 1 << 20
"""Bytes of one value, or of one statement of the schema."""
TURN = 10_000
"""Steps of SQLite's machine after which it is asked whether to go on."""
STEPS_PER_BYTE = 4
"""A row of python-can's has over thirty bytes and takes about twelve steps."""

Row = tuple[Any, ...]
"""Number of the row, then the columns."""


@dataclass(frozen=True)
class _Way:
    """Frames of a table up to where it is damaged, the last two numbers of rows, and the damage."""

    parts: list[Frames]
    numbers: tuple[int, ...]
    why: str


def is_sqlite(head: bytes) -> bool:
    """The magic bytes of SQLite, and the definition of python-can's table."""
    return head.startswith(HEAD) and b"arbitration_id" in head


def of_sqlite(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of a database, and words for their clock; LogError when there is none."""
    del zone
    try:
        with closing(_opened(path)) as connection:
            parts, why = _frames(connection, _table(connection, path), tally)
    except (sqlite3.Error, UnicodeDecodeError) as error:  # words of a damaged schema are no text
        raise LogError(
            f"{path}: SQLite cannot read it, {reason_of(error)}; copy it again"
        ) from error
    whole = join_frames(parts)
    if not len(whole) and why:
        raise LogError(f"{path}: SQLite cannot read its rows, {why}; copy it again")
    if not len(whole):
        raise LogError(f"{path}: its table holds no CAN frame; python-can wrote none of them yet")
    if why:
        tally.remarks.append(
            f"recovered {len(whole)} frames, the rest stands where the database is damaged ({why})"
        )
    return whole, "column ts"


def _opened(path: Path) -> sqlite3.Connection:
    """The database, to read only; it is worked on no longer than its size explains."""
    uri = f"{path.resolve().as_uri()}?mode=ro&immutable=1"
    connection = sqlite3.connect(uri, uri=True)
    connection.text_factory = bytes
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LONGEST)
    connection.execute("PRAGMA writable_schema=ON")  # or a database that was cut is refused whole
    turns = iter(range(2 + path.stat().st_size * STEPS_PER_BYTE // TURN))
    connection.set_progress_handler(lambda: next(turns, None) is None, TURN)
    return connection


def _answers(connection: sqlite3.Connection, query: str) -> Iterator[Row]:
    """Rows of an answer, one by one."""
    try:
        yield from connection.execute(query)
    except MemoryError as error:  # SQLite's word for a size that damage states
        raise sqlite3.DatabaseError("a size in it is past all memory") from error


def _table(connection: sqlite3.Connection, path: Path) -> str:
    """The quoted name of the table of frames; a virtual one has no page and is none."""
    query = "SELECT name FROM sqlite_master WHERE type='table' AND rootpage > 0"
    for (name,) in list(_answers(connection, query)):
        quoted = '"' + name.decode("utf-8", "replace").replace('"', '""') + '"'
        columns = [
            row[1].decode("utf-8", "replace")
            for row in _answers(connection, f"PRAGMA table_info({quoted})")
        ]
        if columns[:7] == list(COLUMNS) and "rowid" not in map(str.lower, columns):
            return quoted
    raise LogError(f"{path}: has no table of CAN frames; its columns would be {', '.join(COLUMNS)}")


def _frames(connection: sqlite3.Connection, table: str, tally: Tally) -> tuple[list[Frames], str]:
    """Frames of all rows that can be read, and what is wrong with the table, if anything."""
    ahead = _walked(connection, table, 1, (), tally)
    if not ahead.why:
        return ahead.parts, ""
    back = _walked(connection, table, -1, ahead.numbers, tally)
    return ahead.parts + back.parts[::-1], ahead.why


def _walked(
    connection: sqlite3.Connection, table: str, sign: int, reached: tuple[int, ...], tally: Tally
) -> _Way:
    """From the first row on (`sign` 1), or from the last one back to what was reached before (-1).

    The very last number reached may be a damaged one, as large as any.
    """
    order = "ASC" if sign > 0 else "DESC"
    query = f"SELECT rowid, {', '.join(COLUMNS)} FROM {table} ORDER BY rowid {order}"
    parts: list[Frames] = []
    rows: list[Row] = []
    numbers: deque[int] = deque(maxlen=2)
    floor = min(reached, default=-math.inf)
    why = ""
    try:
        for row in _in_order(_answers(connection, query), sign):
            if row[0] <= floor or row[0] in reached:
                break
            numbers.append(row[0])
            rows.append(row)
            if len(rows) == ROWS:
                parts.append(_of_rows(rows[::sign], tally))
                rows = []
    except sqlite3.Error as error:
        why = reason_of(error)
    parts.append(_of_rows(rows[::sign], tally))
    return _Way(parts, tuple(numbers), why)


def _in_order(rows: Iterable[Row], sign: int) -> Iterator[Row]:
    """The rows; sqlite3.Error where their numbers turn: pages that lead back to one another."""
    last = None
    for row in rows:
        if last is not None and sign * (row[0] - last) <= 0:
            raise sqlite3.DatabaseError("its rows are out of order")
        last = row[0]
        yield row


def _of_rows(rows: list[Row], tally: Tally) -> Frames:
    """Frames of rows of the table."""
    tally.lines += len(rows)
    sane = [row for row in rows if _is_sane(row)]
    tally.strange += len(rows) - len(sane)
    if not sane:
        return no_frames()
    _, ts, can_id, extended, remote, error, _, data = zip(*sane, strict=True)
    length = np.fromiter(map(len, data), np.int64, len(data))
    flat = b"".join(one[:8].ljust(8, b"\0") for one in data)
    t = np.rint(np.array(ts, np.float64) * 1e6).astype(np.int64) * 1000
    is_remote, is_error = np.array(remote, np.int64) > 0, np.array(error, np.int64) > 0
    tally.errors += int(is_error.sum())
    tally.remote += int(np.sum(is_remote & ~is_error))
    used = ~is_remote & ~is_error & (length <= 8)
    tally.flexible += int(np.sum(~is_remote & ~is_error & (length > 8)))
    return Frames(
        t[used],
        np.array(can_id, np.int64)[used] & EXTENDED_ID,
        np.array(extended, np.int64)[used] > 0,
        np.frombuffer(flat, np.uint8).reshape(-1, 8)[used],
        length[used],
        np.zeros(int(used.sum()), np.int64),
    )


def _is_sane(row: Row) -> bool:
    _, ts, can_id, extended, remote, error, _, data = row
    return (
        isinstance(ts, (int, float))
        and abs(ts) < text_fields.LATEST_S
        and isinstance(can_id, int)
        and 0 <= can_id < LARGEST_ID
        and extended in (0, 1)
        and remote in (0, 1)
        and error in (0, 1)
        and isinstance(data, bytes)
    )
