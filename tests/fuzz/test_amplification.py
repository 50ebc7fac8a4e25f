"""Small files that ask for much: channels, columns, messages, chunks; computing and memory held."""

import os
import struct
import time
import zlib

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import zstandard
from limits import bounded

from trialid.ingest import read
from trialid.inspection import inspect_log

MAGIC = b"\x89MCAP0\r\n"
STAMP = 1_700_000_000_000_000_000
SECONDS = 10.0
"""Of computing."""


def costs(call, megabytes=700):
    """What comes out, within ten seconds of computing and so much memory."""
    begin = time.process_time()
    found = bounded(call, megabytes)
    assert time.process_time() - begin < SECONDS
    return found


def _record(opcode, content):
    return bytes([opcode]) + struct.pack("<Q", len(content)) + content


def _text(text):
    return struct.pack("<I", len(text)) + text.encode()


def _channel(number, topic):
    return _record(4, struct.pack("<HH", number, 1) + _text(topic) + _text("cdr") + bytes(4))


SCHEMA = _record(3, struct.pack("<H", 1) + _text("std_msgs/Float64") + _text("ros2msg")
                 + struct.pack("<I", 12) + b"float64 data")  # fmt: skip


def _message(number, stamp):
    return _record(5, struct.pack("<HIQQ", number, 0, stamp, stamp) + b"\0\1\0\0" + bytes(8))


def _chunk(content, stamp):
    packed = zstandard.ZstdCompressor().compress(content)
    head = struct.pack("<QQQI", stamp, stamp, len(content), zlib.crc32(content))
    return _record(6, head + _text("zstd") + struct.pack("<Q", len(packed)) + packed)


def _mcap(path, contents):
    chunks = b"".join(_chunk(one, STAMP + i) for i, one in enumerate(contents))
    end = _record(15, bytes(4)) + _record(2, bytes(20)) + MAGIC
    path.write_bytes(MAGIC + _record(1, _text("") + _text("")) + chunks + end)
    return path


@pytest.mark.study(turn=11)
def test_a_log_of_every_channel_that_two_bytes_can_number(tmp_path):
    rows = [_channel(i, f"/t{i}") + _message(i, STAMP) + _message(i, STAMP + 10**9)
            for i in range(1, 65_500)]  # fmt: skip
    path = _mcap(tmp_path / "log", [SCHEMA + b"".join(rows)])
    assert "more than 10000 channels" in costs(lambda: inspect_log(path))


@pytest.mark.study(turn=3)
def test_chunks_of_millions_of_messages_each(tmp_path):
    """Each of them is let through; a megabyte holds thirty million messages."""
    many = 20 * 2**20 // len(_message(1, STAMP))
    contents = [SCHEMA + _channel(1, "/a") + _message(1, STAMP + k) * many for k in range(40)]
    path = _mcap(tmp_path / "log", contents)
    assert path.stat().st_size < 2**20
    assert "million messages" in costs(lambda: inspect_log(path))


@pytest.mark.study(turn=11)
def test_chunks_of_gigabytes_of_what_is_no_message(tmp_path):
    """Attachments of zeros; no message is counted, and yet all is unpacked."""
    nothing = _record(200, bytes(100 * 2**20))
    contents = [SCHEMA + _channel(1, "/a") + _message(1, STAMP + k) + nothing for k in range(8)]
    assert "unpacks to more than" in costs(lambda: read(_mcap(tmp_path / "log", contents)))


def test_many_messages_that_are_worth_their_bytes_are_read(tmp_path):
    rng = np.random.default_rng(1)
    stamps = STAMP + np.cumsum(rng.integers(1, 10**7, 200_000))
    rows = [_message(1, int(one)) for one in stamps]
    path = _mcap(tmp_path / "log", [SCHEMA + _channel(1, "/a") + b"".join(rows)])
    assert len(costs(lambda: read(path)).channels["/a:data"].y) == len(rows)


@pytest.mark.parametrize(("columns", "is_read"), [(2000, True), (20_000, False)])
def test_a_parquet_file_of_many_columns(tmp_path, columns, is_read):
    named = {f"c{i}": np.arange(20.0) * i for i in range(columns)}
    pq.write_table(pa.table({"t": np.arange(20.0)} | named), tmp_path / "log")
    found = costs(lambda: inspect_log(tmp_path / "log"))
    assert isinstance(found, str) is not is_read
    assert is_read or "20001 columns" in found


def test_containers_of_a_bus_log_that_unpack_to_gigabytes(tmp_path):
    packed = zlib.compress(bytes(15 * 2**20), 9)
    container = struct.pack("<4sHHII", b"LOBJ", 16, 1, 32 + len(packed), 10)
    container += struct.pack("<H6xI4x", 2, 15 * 2**20) + packed
    container += bytes(-len(container) % 4)
    head = struct.pack("<4sL", b"LOGG", 144).ljust(144, b"\0")
    path = tmp_path / "log"
    path.write_bytes(head + container * 200)
    assert "unpacks to more than" in costs(lambda: read(path))


@pytest.mark.skipif(not hasattr(os, "truncate"), reason="no sparse files here")
@pytest.mark.parametrize("form", ["tlog", "csv"])
def test_a_file_of_twenty_gigabytes_of_nothing(tmp_path, form):
    """It takes no room on the disk; in memory it would."""
    tlog = b"".join(
        struct.pack(">Q", STAMP // 1000 + k) + b"\xfe\x09" + bytes([k, 1, 1, 0]) + bytes(11)
        for k in range(4)
    )
    heads = {"tlog": tlog, "csv": b"t,u\n0,1\n"}
    path = tmp_path / "log"
    path.write_bytes(heads[form])
    os.truncate(path, 20 * 10**9)
    message = costs(lambda: read(path))
    assert isinstance(message, str)
    assert str(path) in message
