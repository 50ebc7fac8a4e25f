"""SQLite databases of python-can: what is damaged within, and what is made to do harm."""

import itertools
import sqlite3
import struct
from functools import partial

import numpy as np
import pytest
from limits import bounded

from trialid.ingest import read
from trialid.ingest.can import sqlite
from trialid.ingest.can.can_frames import Tally

PAGE = 4096
COUNT = 3000
RATE = "rate_of_turn/11:rate"
HEADER = 100
"""Bytes of the first page before its tree."""
LEAF, INTERIOR = 13, 5
COLUMNS = (
    "ts REAL, arbitration_id INTEGER, extended INTEGER, remote INTEGER, error INTEGER, "
    "dlc INTEGER, data BLOB"
)


def data_of(number):
    """The rate of turn of row `number`, which is its number."""
    return struct.pack("<Bi3s", 0, number, b"\xff" * 3)


def made(path, statements=(f"CREATE TABLE messages({COLUMNS})",), count=COUNT):
    """A database, and its bytes."""
    path.unlink(missing_ok=True)
    connection = sqlite3.connect(path)
    connection.execute(f"PRAGMA page_size={PAGE}")
    for statement in statements:
        connection.execute(statement)
    rows = ((1.7e9 + 0.1 * k, 0x09F1130B, 1, 0, 0, 8, data_of(k)) for k in range(count))
    connection.executemany(
        "INSERT INTO messages(ts, arbitration_id, extended, remote, error, dlc, data) "
        "VALUES(?,?,?,?,?,?,?)",
        rows,
    )
    connection.commit()
    connection.close()
    return bytearray(path.read_bytes())


def pages(content, kind):
    return [at for at in range(PAGE, len(content), PAGE) if content[at] == kind]


def numbers(path):
    """The rows that were read, by their values, and the remarks."""
    found = read(path)
    return np.rint(found.channels[RATE].y / 3.125e-8).astype(int), found.remarks


def cell_of(content, row):
    """Where a row begins: the size of its content, its number, the types of its columns."""
    number = bytes([0x80 | row >> 7, row & 0x7F])
    return content.index(b"\x1d" + number + b"\x08\x07\x04\x09\x08\x08\x01\x1c")


def test_a_size_past_all_memory_loses_its_row_alone(tmp_path):
    """SQLite says that memory is out; so did Python, and the reading ended."""
    content = made(tmp_path / "log")
    at = cell_of(content, 1500)
    content[at : at + 7] = b"\xff" * 6 + b"\x7f"
    (tmp_path / "log").write_bytes(content)
    found, remarks = numbers(tmp_path / "log")
    assert len(found) >= COUNT - 3
    np.testing.assert_array_equal(np.diff(found) > 0, True)
    assert f"recovered {len(found)} frames, the rest stands where the" in remarks[-1]


@pytest.mark.parametrize("zeros", [True, False], ids=["zeros", "ones"])
def test_a_lost_page_loses_its_rows_alone(tmp_path, zeros):
    content = made(tmp_path / "log")
    leaves = pages(content, LEAF)
    at = leaves[len(leaves) // 2]
    content[at : at + PAGE] = (b"\0" if zeros else b"\xff") * PAGE
    (tmp_path / "log").write_bytes(content)
    found, remarks = numbers(tmp_path / "log")
    assert COUNT - 140 < len(found) < COUNT - 100
    assert (found[0], found[-1]) == (0, COUNT - 1)
    np.testing.assert_array_equal(np.diff(found) > 0, True)
    assert "the rest stands where the database is damaged" in remarks[-1]


def test_a_damaged_number_of_a_row_gives_no_row_twice(tmp_path):
    content = made(tmp_path / "log")
    at = cell_of(content, 1500)
    content[at + 1 : at + 3] = b"\xff\x7f"
    (tmp_path / "log").write_bytes(content)
    found, _ = numbers(tmp_path / "log")
    np.testing.assert_array_equal(found, np.arange(COUNT))


def test_a_cut_database_is_read_up_to_where_it_is_cut(tmp_path):
    content = made(tmp_path / "log")
    (tmp_path / "log").write_bytes(content[: len(content) // 2])
    found, remarks = numbers(tmp_path / "log")
    np.testing.assert_array_equal(found, np.arange(len(found)))
    assert len(found) > 0.3 * COUNT
    assert "is damaged" in remarks[-1]


def _interior(child, room):
    """An interior page of 300 cells that all lead to the page `child`."""
    cells = [struct.pack(">I", child) + bytes([k // 128 | 0x80, k % 128]) for k in range(300)]
    start = PAGE - 6 * len(cells)
    places = b"".join(struct.pack(">H", start + 6 * k) for k in range(len(cells)))
    head = struct.pack(">BHHHBI", INTERIOR, 0, len(cells), start, 0, child) + places
    return head.ljust(start - room, b"\0") + b"".join(cells)


def _looped(content, top, leaf):
    """Eight interior pages above a leaf, every child of each the next: 300 to the eighth times."""
    chain = [top, *(len(content) // PAGE + 1 + k for k in range(7)), leaf]
    content += bytes(PAGE * 7)
    for here, below in itertools.pairwise(chain):
        at = max((here - 1) * PAGE, HEADER if here == 1 else 0)
        content[at : here * PAGE] = _interior(below, HEADER if here == 1 else 0)
    content[28:32] = struct.pack(">I", len(content) // PAGE)
    return content


def test_pages_that_lead_to_one_another_give_each_row_once(tmp_path):
    content = made(tmp_path / "log")
    (top,) = pages(content, INTERIOR)
    leaf = pages(content, LEAF)[0]
    content = _looped(content, top // PAGE + 1, leaf // PAGE + 1)
    (tmp_path / "log").write_bytes(content)
    assert not isinstance(bounded(partial(read, tmp_path / "log")), str)
    found, remarks = numbers(tmp_path / "log")
    assert len(found) == len(set(found)) < COUNT
    assert "out of order" in remarks[-1]


def test_a_schema_without_end(tmp_path):
    """SQLite itself walks through the pages of the schema, and would for years."""
    content = made(tmp_path / "log")
    (cell,) = struct.unpack_from(">H", content, HEADER + 8)
    leaf = bytearray(PAGE)
    leaf[:10] = struct.pack(">BHHHBH", LEAF, 0, 1, cell, 0, cell)
    leaf[cell:] = content[cell:PAGE]
    content = _looped(content + leaf, 1, len(content) // PAGE + 1)
    (tmp_path / "log").write_bytes(content)
    found = bounded(partial(sqlite.of_sqlite, tmp_path / "log", None, Tally()))
    assert "SQLite cannot read it" in str(found)


def test_a_view_that_is_said_to_be_a_table(tmp_path):
    made(tmp_path / "log")
    connection = sqlite3.connect(tmp_path / "log")
    connection.execute("PRAGMA writable_schema=ON")
    view = (
        "CREATE VIEW messages(ts, arbitration_id, extended, remote, error, dlc, data) AS WITH "
        "RECURSIVE a(x) AS (SELECT 1 UNION ALL SELECT x FROM a) SELECT x, 1, 1, 0, 0, 8, x FROM a"
    )
    connection.execute("UPDATE sqlite_master SET sql = ?", (view,))
    connection.commit()
    connection.close()
    assert isinstance(bounded(partial(read, tmp_path / "log")), str)


@pytest.mark.parametrize(
    "statement",
    [
        f"CREATE TABLE messages({COLUMNS.replace('data BLOB', '')} data AS (zeroblob(900000000)))",
        f"CREATE TABLE messages({COLUMNS}, rowid TEXT)",
        "CREATE VIRTUAL TABLE messages USING "
        "fts5(ts, arbitration_id, extended, remote, error, dlc, data)",
    ],
    ids=["a value without end", "a number that is text", "virtual"],
)
def test_tables_made_to_do_harm(tmp_path, statement):
    path = tmp_path / "log"
    connection = sqlite3.connect(path)
    connection.execute(statement)
    columns = [row[1] for row in connection.execute("PRAGMA table_info(messages)")]
    names = ", ".join(columns)
    values = ("1.0", *["1"] * (len(columns) - 1))
    connection.execute(f"INSERT INTO messages({names}) VALUES({', '.join(values)})")
    connection.commit()
    connection.close()
    assert sqlite.is_sqlite(path.read_bytes()[:4096])
    assert "has no table of CAN frames" in str(bounded(partial(read, path)))
