"""mcap-ros2-support decodes the same messages one by one: the oracle."""

import io
import struct
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.records import Schema
from mcap_ros2._dynamic import serialize_dynamic
from mcap_ros2.decoder import DecoderFactory
from packed import packed

from trialid.ingest.mcap import payload_cdr

RULE = "=" * 80
SCHEMA = f"""\
# a comment, and a constant that is no field
uint8 STEERING=3
string LABEL = "a # b"
std_msgs/Header header
string name
float64[] position
Inner[] inner
float32[3] fixed
bool on
builtin_interfaces/Duration lasting
string<=20[<=4] names
Inner one
uint16 count 7   # with a default
int8[<=6] small
int64 last
Nothing nothing
{RULE}
MSG: my_msgs/Inner
int8 a
float64 b
uint32 c
{RULE}
MSG: my_msgs/Nothing
{RULE}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
"""
NAME = "my_msgs/msg/Outer"
CDR = Schema(id=1, name=NAME, encoding="ros2msg", data=SCHEMA.encode())
ENCODE = serialize_dynamic(NAME, SCHEMA)[NAME]
NUMBERS = {
    "small": st.integers(-128, 127),
    "word": st.integers(0, 2**16 - 1),
    "long": st.integers(0, 2**32 - 1),
    "float": st.floats(allow_nan=False, width=32),
    "double": st.floats(allow_nan=False),
}
INNER = st.fixed_dictionaries({"a": NUMBERS["small"], "b": NUMBERS["double"], "c": NUMBERS["long"]})
TEXT = st.text(alphabet="abcdefgh", max_size=9)
MESSAGE = st.fixed_dictionaries(
    {
        "header": st.fixed_dictionaries(
            {
                "stamp": st.fixed_dictionaries(
                    {"sec": st.integers(0, 2**31 - 1), "nanosec": st.integers(0, 10**9 - 1)}
                ),
                "frame_id": TEXT,
            }
        ),
        "name": TEXT,
        "position": st.lists(NUMBERS["double"], max_size=4),
        "inner": st.lists(INNER, max_size=3),
        "fixed": st.lists(NUMBERS["float"], min_size=3, max_size=3),
        "on": st.booleans(),
        "lasting": st.just({"sec": 1, "nanosec": 2}),
        "names": st.lists(TEXT, max_size=4),
        "one": INNER,
        "count": NUMBERS["word"],
        "small": st.lists(NUMBERS["small"], max_size=6),
        "last": st.integers(-(2**53), 2**53),
        "nothing": st.just({}),
    }
)


def leaves(value, path=""):
    """Numbers of a message the library decoded."""
    if isinstance(value, bool | str) or path in ("header", "lasting"):
        return
    if isinstance(value, int | float):
        yield path, float(value)
    elif isinstance(value, SimpleNamespace):
        for name in value.__slots__:
            yield from leaves(getattr(value, name), f"{path}.{name}" if path else name)
    else:
        for i, item in enumerate(value):
            yield from leaves(item, f"{path}[{i}]")


def decoded(payloads, keep=lambda name: True):
    return payload_cdr.decoder(CDR)(packed(payloads), keep)


def rows_of(columns, count):
    """Columns turned back to one dictionary a message."""
    rows = [{} for _ in range(count)]
    for name, column in columns.fields.items():
        for row, y in zip(column.row.tolist(), column.y.tolist(), strict=True):
            rows[row][name] = y
    return rows


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(MESSAGE, min_size=1, max_size=6))
def test_any_message_is_read_as_the_library_reads_it(messages):
    payloads = [ENCODE(message) for message in messages]
    columns = decoded(payloads)
    library = DecoderFactory().decoder_for("cdr", CDR)
    assert columns.undecodable == 0
    assert rows_of(columns, len(messages)) == [dict(leaves(library(p))) for p in payloads]
    stamps = [m["header"]["stamp"] for m in messages]
    assert columns.stamp.tolist() == [s["sec"] * 10**9 + s["nanosec"] for s in stamps]


@settings(max_examples=100, deadline=None, derandomize=True)
@given(MESSAGE, st.floats(0, 1, exclude_max=True))
def test_a_message_cut_short_is_refused_not_guessed(message, share):
    payload = ENCODE(message)
    columns = decoded([payload[: int(share * len(payload))], payload])
    assert columns.undecodable == 1
    assert columns.reason
    assert all(column.row.tolist() == [1] for column in columns.fields.values())


def test_only_kept_fields_are_lifted():
    payload = ENCODE(dict.fromkeys(["name"], "x") | {"one": {"a": 1, "b": 2.5, "c": 3}})
    columns = decoded([payload], keep=lambda name: name.startswith("one."))
    assert {name: c.y.tolist() for name, c in columns.fields.items()} == {
        "one.a": [1.0],
        "one.b": [2.5],
        "one.c": [3.0],
    }


def test_both_byte_orders():
    schema = Schema(id=1, name="a/B", encoding="ros2msg", data=b"uint8 a\nfloat64 b\n")
    little = b"\x00\x01\x00\x00" + struct.pack("<B7xd", 1, 2.5)
    big = b"\x00\x00\x00\x00" + struct.pack(">B7xd", 1, 2.5)
    columns = payload_cdr.decoder(schema)(packed([little, big]), lambda name: True)
    assert columns.fields["a"].y.tolist() == [1.0, 1.0]
    assert columns.fields["b"].y.tolist() == [2.5, 2.5]


def test_other_encapsulations_are_refused():
    schema = Schema(id=1, name="a/B", encoding="ros2msg", data=b"float64 b\n")
    columns = payload_cdr.decoder(schema)(
        packed([b"\x00\x07\x00\x00" + bytes(8)]), lambda name: True
    )
    assert columns.reason == "CDR of kind 0007 is not supported"


def test_pictures_are_no_channels():
    schema = Schema(id=1, name="a/B", encoding="ros2msg", data=b"uint8[] data\nfloat64 b\n")
    payload = b"\x00\x01\x00\x00" + struct.pack("<I100sd", 100, b"", 1.5)
    columns = payload_cdr.decoder(schema)(packed([payload]), lambda name: True)
    assert {name: c.y.tolist() for name, c in columns.fields.items()} == {"b": [1.5]}


def test_a_type_the_schema_does_not_define_is_named():
    schema = Schema(id=1, name="a/B", encoding="ros2msg", data=b"Missing x\n")
    columns = payload_cdr.decoder(schema)(
        packed([b"\x00\x01\x00\x00" + bytes(8)]), lambda name: True
    )
    assert columns.reason == "the schema does not define a/Missing"


@pytest.mark.parametrize("length", [2**32 - 1, 200])
def test_an_absurd_length_is_refused(length):
    schema = Schema(id=1, name="a/B", encoding="ros2msg", data=b"float64[] b\n")
    payload = b"\x00\x01\x00\x00" + struct.pack("<I4xd", length, 1.0)
    columns = payload_cdr.decoder(schema)(packed([payload]), lambda name: True)
    assert columns.undecodable == 1
    assert not columns.fields


def test_the_library_writes_what_the_schema_says():
    """Guards the oracle: a message survives the library's own round trip."""
    out = DecoderFactory().decoder_for("cdr", CDR)(ENCODE({"count": 12, "name": "x"}))
    assert (out.count, out.name) == (12, "x")
    assert isinstance(io.BytesIO(ENCODE({})).read(), bytes)
    assert np.isfinite(out.one.b)
