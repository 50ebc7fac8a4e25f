"""MATLAB files made to do harm: what unpacks to too much, and what is no number."""

import struct
import zlib

import numpy as np
import pytest
import scipy.io
from test_hostile_files import MB, reading, refused, saved


@pytest.mark.study(turn=5)
def test_a_matlab_variable_that_unpacks_to_a_gigabyte(tmp_path):
    packer = zlib.compressobj(9)
    body = b"".join(packer.compress(bytes(MB)) for _ in range(1000)) + packer.flush()
    head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
    refused(saved(tmp_path / "log", head + struct.pack("<II", 15, len(body)) + body))


@pytest.mark.parametrize("kind", [1, 3, 16, 17, 18], ids=["cell", "object", "function", "17", "18"])
def test_matlab_functions_and_objects_are_no_channels(tmp_path, kind):
    with (tmp_path / "log").open("wb") as file:
        scipy.io.savemat(file, {"f": {"x": np.arange(9.0)}, "t": np.arange(9.0), "u": np.ones(9)})
    raw = (tmp_path / "log").read_bytes()
    flags = struct.pack("<IIB", 6, 8, 2)
    assert flags in raw
    found = reading(saved(tmp_path / "log", raw.replace(flags, struct.pack("<IIB", 6, 8, kind))))
    assert isinstance(found, str) or not any(name.startswith("f") for name in found.channels)


@pytest.mark.study(turn=4)
def test_a_matlab_variable_of_as_much_as_is_read(tmp_path):
    """Half a kilobyte to 290 MB of zeros: read, within a gigabyte in all."""
    count = 290 * MB // 8
    fields = (6, 8, 6, 0, 5, 8, count, 1, 1, 1, b"x\0\0\0")
    name = struct.pack("<IIIIIIIIHH4s", *fields)
    size = len(name) + 8 + 8 * count
    packer = zlib.compressobj(9)
    body = packer.compress(struct.pack("<II", 14, size) + name + struct.pack("<II", 9, 8 * count))
    zeros = bytes(MB)
    body += b"".join(packer.compress(zeros) for _ in range(290)) + packer.flush()
    head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
    path = saved(tmp_path / "log", head + struct.pack("<II", 15, len(body)) + body)
    reading(path, megabytes=950)
