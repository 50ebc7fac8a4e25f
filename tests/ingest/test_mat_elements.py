"""MAT-files before version 7.3: as scipy reads them when they are sound, and no crash when not."""

import io
import struct

import numpy as np
import pytest
import scipy.io
from hypothesis import given, settings
from hypothesis import strategies as st

from trialid.ingest import read
from trialid.ingest.tables.mat_arrays import of_version_5
from trialid.ingest.tables.mat_elements import Damaged, variable

KINDS = ("f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8")
HEADER = b"MATLAB 5.0 MAT-file".ljust(124)
arrays = st.builds(
    lambda kind, shape, seed: np.random.default_rng(seed).integers(0, 100, shape).astype(kind),
    st.sampled_from(KINDS), st.lists(st.integers(1, 4), min_size=2, max_size=3), st.integers(0, 99),
)  # fmt: skip
names = st.text("abcxyz", min_size=1, max_size=9)
values = st.recursive(
    arrays | st.just("text") | st.just(1 + 2j),
    lambda inner: st.dictionaries(names, inner, min_size=1),
    max_leaves=8,
)  # fmt: skip


def flat(found, prefix=""):
    """Arrays of two numbers and more in what scipy gives, by dotted name."""
    for name, value in found.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{name}.")
        elif isinstance(value, np.ndarray) and value.dtype.kind in "fiu" and value.size > 1:
            yield prefix + name, value


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.dictionaries(names, values, min_size=1, max_size=4), st.booleans())
@pytest.mark.study(turn=15)
def test_what_scipy_reads(tmp_path_factory, content, packed):
    path = tmp_path_factory.getbasetemp() / "log.mat"
    scipy.io.savemat(path, content, do_compression=packed)
    theirs = scipy.io.loadmat(path, simplify_cells=True)
    expected = dict(flat({k: v for k, v in theirs.items() if not k.startswith("__")}))
    found = of_version_5(path)
    assert found.remarks == ()
    assert found.plain.keys() == expected.keys()
    for name, value in expected.items():
        np.testing.assert_array_equal(np.squeeze(found.plain[name]), value)


def element(order, kind, content):
    return struct.pack(f"{order}II", kind, len(content)) + content + bytes(-len(content) % 8)


def matrix(order, kind, name, *content, dims=(3, 1)):
    flags = element(order, 6, struct.pack(f"{order}II", kind, 0))
    shape = element(order, 5, struct.pack(f"{order}{len(dims)}i", *dims))
    return element(order, 14, flags + shape + element(order, 1, name) + b"".join(content))


@pytest.mark.parametrize(("order", "mark"), [("<", b"\x00\x01IM"), (">", b"\x01\x00MI")])
def test_both_orders_of_bytes(tmp_path, order, mark):
    numbers = [np.arange(3.0), np.array([1.5, 2.5, -1.0])]
    body = [element(order, 9, y.astype(f"{order}f8").tobytes()) for y in numbers]
    whole = matrix(order, 6, b"t", body[0]) + matrix(order, 6, b"u", body[1])
    (tmp_path / "log").write_bytes(HEADER + mark + whole)
    np.testing.assert_array_equal(read(tmp_path / "log").channels["u"].y, numbers[1])


def test_an_object_is_named_and_not_read(tmp_path):
    flags = element("<", 6, struct.pack("<II", 17, 0))
    words = b"".join(element("<", 1, word) for word in (b"T", b"MCOS", b"datetime"))
    held = element("<", 14, flags + words)
    assert variable(held, "<").opaque == ["T"]
    (tmp_path / "log").write_bytes(HEADER + b"\x00\x01IM" + held)
    assert of_version_5(tmp_path / "log").opaque == ("T",)


def test_a_type_that_is_none_is_a_lost_variable(tmp_path):
    """One byte, with which scipy's reader ends the process."""
    made = io.BytesIO()
    scipy.io.savemat(made, {"t": np.arange(9.0), "u": np.arange(9.0), "v": np.arange(9.0)})
    raw = bytearray(made.getvalue())
    at = raw.rindex(struct.pack("<II", 9, 72))
    raw[at] = 0x29
    (tmp_path / "log").write_bytes(raw)
    recording = read(tmp_path / "log")
    assert list(recording.channels) == ["u"]
    assert recording.remarks == ("recovered 2 of about 3 variables, the others are damaged",)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.integers(0, 10**6), st.binary(min_size=1, max_size=4))
def test_no_byte_ends_it(at, noise):
    inside = matrix("<", 6, b"", element("<", 9, bytes(24)))
    fields = element("<", 5, struct.pack("<i", 4)) + element("<", 1, b"x\0\0\0")
    whole = bytearray(matrix("<", 2, b"s", fields, inside, dims=(1, 1)))
    assert list(variable(whole, "<").plain) == ["s.x"]
    at %= len(whole)
    whole[at : at + len(noise)] = noise
    try:
        found = variable(whole, "<")
    except Damaged:
        return
    assert all(y.size <= 24 for y in found.plain.values())
