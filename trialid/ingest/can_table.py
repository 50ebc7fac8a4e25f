"""Tables python-can writes to frames: its CSV files and its SQLite databases.

Both hold seconds since 1970, identifier, whether it is extended, remote, an error, and the data.
"""

import sqlite3
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError, said
from trialid.ingest import text_fields
from trialid.ingest.can_frames import EXTENDED_ID, Frames, Tally, joined, nothing
from trialid.ingest.text_fields import Bools, Fields, Ints

CSV_HEAD = b"timestamp,arbitration_id,extended,remote,error,dlc,data"
SQLITE_HEAD = b"SQLite format 3\0"
COLUMNS = ("ts", "arbitration_id", "extended", "remote", "error", "dlc", "data")
ROWS = 1 << 16
LARGEST_ID = 1 << 30

SIXES = np.full(256, 99, np.int64)
"""Value of a character of base64; 99 for any other."""
for _value, _character in enumerate(
    b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
):
    SIXES[_character] = _value
NUMPY = b"np.float64("
"""What stands before a stamp that was handed over as a numpy number."""


def is_csv(head: bytes) -> bool:
    """The header row of python-can's CSV."""
    return head.lstrip(b"\xef\xbb\xbf").startswith(CSV_HEAD)


def is_sqlite(head: bytes) -> bool:
    """The magic bytes of SQLite, and the definition of python-can's table."""
    return head.startswith(SQLITE_HEAD) and b"arbitration_id" in head


def of_csv(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of a CSV file, and words for their clock; LogError when there is none."""
    del zone
    parts = [_rows(text_fields.fields(b, b","), tally) for b in text_fields.blocks(path)]
    whole = joined(parts)
    tally.lines, tally.strange = tally.lines - 1, tally.strange - 1  # the header row
    if not len(whole):
        raise LogError(f"{path}: none of its {tally.lines} rows is a CAN frame; copy it again")
    return whole, "column timestamp"


def _rows(lines: Fields, tally: Tally) -> Frames:
    """Frames of rows `1483389946.197,0x00dadada,1,0,0,6,WzQyLCA5XQ==`; no data, no last field."""
    rows = np.flatnonzero((lines.count == 7) | (lines.count == 6))
    start, end = lines.at(rows, 0)
    dressed = lines.text[start] == ord("n")
    t, good = text_fields.seconds(lines.text, start + len(NUMPY) * dressed, end - dressed)
    start, end = lines.at(rows, 1)
    can_id, is_id = text_fields.integers(lines.text, np.minimum(start + 2, end), end, 16)
    good &= is_id & (can_id <= EXTENDED_ID)
    flags = [text_fields.integers(lines.text, *lines.at(rows, k), 10) for k in range(2, 6)]
    (extended, remote, error, length), fine = zip(*flags, strict=True)
    good &= np.all(fine, axis=0)
    plain = good & (remote == 0) & (error == 0)
    table, is_data = _base64(lines, rows, length)
    used = plain & is_data & (length <= 8)
    tally.lines += len(lines)
    tally.errors += int(np.sum(good & (error == 1)))
    tally.remote += int(np.sum(good & (error == 0) & (remote == 1)))
    tally.flexible += int(np.sum(plain & (length > 8) & (length <= 64)))
    known = used | (good & ((error == 1) | (remote == 1))) | (plain & (length > 8) & (length <= 64))
    tally.strange += len(lines) - int(known.sum())
    none = np.zeros(int(used.sum()), np.int64)
    return Frames(t[used], can_id[used], extended[used] == 1, table[used], length[used], none)


def _base64(lines: Fields, rows: Ints, length: Ints) -> tuple[NDArray[np.uint8], Bools]:
    """Data bytes (n, 8) of the last fields, and which are right."""
    there = lines.count[rows] == 7
    index = lines.first[rows] + np.where(there, 6, 0)
    start, width = lines.start[index], np.where(there, lines.end[index] - lines.start[index], 0)
    places = start[:, None] + np.arange(12)
    six = SIXES[lines.character(places)]
    needed = (np.minimum(length, 8)[:, None] * 8 + 5) // 6
    used = np.arange(12) < needed
    good = (width == 4 * ((length + 2) // 3)) & (~used | (six < 64)).all(axis=1)
    four = np.where(used, six, 0).reshape(-1, 3, 4)
    three = (four[..., 0] << 18) | (four[..., 1] << 12) | (four[..., 2] << 6) | four[..., 3]
    octets = np.stack([three >> 16, three >> 8 & 0xFF, three & 0xFF], axis=-1).reshape(-1, 9)[:, :8]
    return np.where(np.arange(8) < length[:, None], octets, 0).astype(np.uint8), good


def of_sqlite(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of a database, and words for their clock; LogError when there is none."""
    del zone
    parts: list[Frames] = []
    try:
        uri = f"{path.resolve().as_uri()}?mode=ro&immutable=1"
        connection = sqlite3.connect(uri, uri=True)
        connection.text_factory = bytes
        try:
            for rows in _fetched(connection, path):
                parts.append(_of_rows(rows, tally))
        finally:
            connection.close()
    except (sqlite3.Error, UnicodeDecodeError) as error:  # words of a damaged schema are no text
        why = said(error)
        if not parts:
            raise LogError(f"{path}: SQLite cannot read it, {why}; copy it again") from error
        count = sum(len(part) for part in parts)
        tally.remarks.append(f"recovered {count} frames, then the database is damaged ({why})")
    whole = joined(parts) if parts else nothing()
    if not len(whole):
        raise LogError(f"{path}: its table holds no CAN frame; python-can wrote none of them yet")
    return whole, "column ts"


def _fetched(connection: sqlite3.Connection, path: Path) -> Iterator[list[tuple[object, ...]]]:
    tables = connection.execute("SELECT name FROM sqlite_master WHERE type='table'").fetchall()
    for (name,) in tables:
        quoted = '"' + name.decode("utf-8", "replace").replace('"', '""') + '"'
        columns = [
            row[1].decode("utf-8", "replace")
            for row in connection.execute(f"PRAGMA table_info({quoted})")
        ]
        if columns[:7] == list(COLUMNS):
            cursor = connection.execute(f"SELECT {', '.join(COLUMNS)} FROM {quoted}")
            while rows := cursor.fetchmany(ROWS):
                yield rows
            return
    raise LogError(f"{path}: has no table of CAN frames; its columns would be {', '.join(COLUMNS)}")


def _of_rows(rows: list[tuple[object, ...]], tally: Tally) -> Frames:
    """Frames of rows of the table."""
    tally.lines += len(rows)
    sane = [row for row in rows if _is_sane(row)]
    tally.strange += len(rows) - len(sane)
    if not sane:
        return nothing()
    ts, can_id, extended, remote, error, _, data = zip(*sane, strict=True)
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


def _is_sane(row: tuple[object, ...]) -> bool:
    ts, can_id, extended, remote, error, _, data = row
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
