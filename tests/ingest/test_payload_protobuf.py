import numpy as np
import pytest
from google.protobuf import duration_pb2, struct_pb2, timestamp_pb2, wrappers_pb2
from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorProto
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message import DecodeError
from google.protobuf.message_factory import GetMessageClass
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.records import Schema
from mcap_protobuf.schema import build_file_descriptor_set
from packed import packed

from trialid.ingest.mcap import payload_protobuf, protobuf_layout

KIND = FieldDescriptorProto
SINGLE, REPEATED = FieldDescriptorProto.LABEL_OPTIONAL, FieldDescriptorProto.LABEL_REPEATED
FIELDS = [
    ("timestamp", KIND.TYPE_MESSAGE, SINGLE, ".google.protobuf.Timestamp"),
    ("lasting", KIND.TYPE_MESSAGE, SINGLE, ".google.protobuf.Duration"),
    ("inner", KIND.TYPE_MESSAGE, SINGLE, ".x.Inner"),
    ("many", KIND.TYPE_MESSAGE, REPEATED, ".x.Inner"),
    ("rates", KIND.TYPE_DOUBLE, REPEATED, None),
    ("count", KIND.TYPE_INT64, SINGLE, None),
    ("on", KIND.TYPE_BOOL, SINGLE, None),
    ("mode", KIND.TYPE_ENUM, SINGLE, ".x.Mode"),
    ("name", KIND.TYPE_STRING, SINGLE, None),
    ("blob", KIND.TYPE_BYTES, SINGLE, None),
]


def definition():
    """Scalars of all kinds, nested, repeated, optional, a oneof, a truth value, an enum, times."""
    file = FileDescriptorProto(name="all.proto", package="x", syntax="proto3")
    file.dependency.extend(["google/protobuf/timestamp.proto", "google/protobuf/duration.proto"])
    inner = file.message_type.add(name="Inner")
    inner.field.add(name="z", number=1, type=KIND.TYPE_DOUBLE, label=SINGLE)
    mode = file.enum_type.add(name="Mode")
    mode.value.add(name="A", number=0)
    mode.value.add(name="B", number=1)
    outer = file.message_type.add(name="Outer")
    outer.oneof_decl.add(name="choice")
    outer.oneof_decl.add(name="_maybe")
    for number, (name, what, label, of) in enumerate(FIELDS, 1):
        outer.field.add(name=name, number=number, type=what, label=label, type_name=of)
    single = {"type": KIND.TYPE_FLOAT, "label": SINGLE}
    outer.field.add(name="left", number=20, oneof_index=0, **single)
    outer.field.add(name="right", number=21, oneof_index=0, **single)
    outer.field.add(name="maybe", number=22, oneof_index=1, proto3_optional=True, **single)
    return file


def message_class():
    pool = DescriptorPool()
    for needed in (timestamp_pb2, duration_pb2):
        pool.AddSerializedFile(needed.DESCRIPTOR.serialized_pb)
    pool.Add(definition())
    return GetMessageClass(pool.FindMessageTypeByName("x.Outer"))


def decoded(*messages, keep=lambda name: True):
    descriptors = build_file_descriptor_set(type(messages[0])).SerializeToString()
    name = type(messages[0]).DESCRIPTOR.full_name
    decode = payload_protobuf.decoder(Schema(1, descriptors, "protobuf", name))
    return decode(packed([message.SerializeToString() for message in messages]), keep)


def rows(columns):
    return {name: (c.row.tolist(), c.y.tolist()) for name, c in columns.fields.items()}


SCALARS = [
    (name, getattr(KIND, f"TYPE_{name.upper()}"))
    for name in (
        "double", "float", "int32", "int64", "uint32", "uint64", "sint32", "sint64",
        "fixed32", "fixed64", "sfixed32", "sfixed64", "bool", "string", "bytes",
    )
]  # fmt: skip


def plain_class():
    """Single numbers of every kind, texts, a time, the same once more inside, and optional."""
    file = FileDescriptorProto(name="plain.proto", package="x", syntax="proto3")
    file.dependency.extend(["google/protobuf/timestamp.proto", "google/protobuf/duration.proto"])
    inner, outer = (file.message_type.add(name=name) for name in ("Inside", "Plain"))
    for message in (inner, outer):
        for number, (name, kind) in enumerate(SCALARS, 1):
            message.field.add(name=name, number=number, type=kind, label=SINGLE)
    outer.oneof_decl.add(name="_maybe")
    outer.field.add(
        name="maybe", number=30, type=KIND.TYPE_SINT32, label=SINGLE, oneof_index=0,
        proto3_optional=True,
    )  # fmt: skip
    for number, (name, of) in enumerate(
        [("in", ".x.Inside"), ("timestamp", f".{STAMP}"), ("lasting", f".{LASTING}")], 40
    ):
        outer.field.add(
            name=name, number=number, type=KIND.TYPE_MESSAGE, label=SINGLE, type_name=of
        )
    pool = DescriptorPool()
    for needed in (timestamp_pb2, duration_pb2):
        pool.AddSerializedFile(needed.DESCRIPTOR.serialized_pb)
    pool.Add(file)
    return GetMessageClass(pool.FindMessageTypeByName("x.Plain"))


STAMP, LASTING = "google.protobuf.Timestamp", "google.protobuf.Duration"
NUMBERS = {
    "double": st.floats(allow_nan=False),
    "float": st.floats(allow_nan=False, width=32),
    **{f"{kind}32": st.integers(-(2**31), 2**31 - 1) for kind in ("int", "sint", "sfixed")},
    **{f"{kind}64": st.integers(-(2**63), 2**63 - 1) for kind in ("int", "sint", "sfixed")},
    **{f"{kind}32": st.integers(0, 2**32 - 1) for kind in ("uint", "fixed")},
    **{f"{kind}64": st.integers(0, 2**64 - 1) for kind in ("uint", "fixed")},
    "bool": st.booleans(),
    "string": st.text(alphabet="aö", max_size=3),
    "bytes": st.binary(max_size=3),
}
INSIDE = st.fixed_dictionaries({}, optional=NUMBERS)
TIMES = st.fixed_dictionaries(
    {}, optional={"seconds": st.integers(-1, 2**33), "nanos": st.integers(-5, 10**9 - 1)}
)
PLAIN = st.fixed_dictionaries(
    {},
    optional={
        **NUMBERS,
        "maybe": NUMBERS["sint32"],
        "in": INSIDE,
        "timestamp": TIMES,
        "lasting": TIMES,
    },
)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(PLAIN, min_size=1, max_size=6), st.booleans())
def test_what_is_laid_out_is_what_the_library_parses(messages, alike):
    plain = plain_class()
    made = [plain(**message) for message in (messages[:1] * 3 if alike else messages)]
    columns = decoded(*made)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(protobuf_layout, "lays_out", lambda descriptor: False)
        parsed = decoded(*made)
    assert rows(columns) == rows(parsed)
    assert columns.stamp.tolist() == parsed.stamp.tolist()
    assert columns.undecodable == parsed.undecodable == 0


@settings(max_examples=150, deadline=None, derandomize=True)
@given(PLAIN, st.integers(0, 10**6), st.integers(0, 255))
def test_a_byte_changed_is_read_as_the_library_reads_it_or_refused(message, at, byte):
    """The library alone decides what cannot be laid out; a text is not looked into."""
    plain = plain_class()
    payload = bytearray(plain(**message).SerializeToString() or b"\x08")
    payload[at % len(payload)] = byte
    descriptors = build_file_descriptor_set(plain).SerializeToString()
    decode = payload_protobuf.decoder(Schema(1, descriptors, "protobuf", "x.Plain"))
    columns = decode(packed([bytes(payload)]), lambda name: True)
    try:
        parsed = plain.FromString(bytes(payload))
    except DecodeError:
        assert columns.undecodable == 1 or message_has_text(message)
        return
    expected = dict(payload_protobuf._leaves(parsed, ""))
    assert {n: c.y[0] for n, c in columns.fields.items()} == pytest.approx(expected, nan_ok=True)


def message_has_text(message):
    return any({"string", "bytes"} & part.keys() for part in (message, message.get("in", {})))


def test_every_number_and_nothing_else():
    outer = message_class()
    message = outer(count=-3, on=True, mode=1, name="x", blob=b"y", rates=[1.5, 2.5], right=4.0)
    message.inner.z = 0.0
    message.many.add().z = 7.0
    message.timestamp.FromNanoseconds(1_700_000_000_123_456_789)
    message.lasting.FromNanoseconds(5)
    columns = decoded(message)
    assert columns.stamp.tolist() == [1_700_000_000_123_456_789]
    assert rows(columns) == {
        "inner.z": ([0], [0.0]),
        "many[0].z": ([0], [7.0]),
        "rates[0]": ([0], [1.5]),
        "rates[1]": ([0], [2.5]),
        "count": ([0], [-3.0]),
        "mode": ([0], [1.0]),
        "right": ([0], [4.0]),
    }


def test_an_optional_field_that_is_not_set_is_no_zero():
    outer = message_class()
    columns = decoded(outer(), outer(maybe=0.0), keep=lambda name: name == "maybe")
    assert rows(columns) == {"maybe": ([1], [0.0])}
    assert columns.stamp.tolist() == [0, 0]


def test_a_damaged_message_is_counted():
    descriptors = build_file_descriptor_set(wrappers_pb2.DoubleValue).SerializeToString()
    schema = Schema(1, descriptors, "protobuf", "google.protobuf.DoubleValue")
    good = wrappers_pb2.DoubleValue(value=2.0).SerializeToString()
    columns = payload_protobuf.decoder(schema)(packed([good, good[:-1], good]), lambda name: True)
    assert columns.undecodable == 1
    assert columns.reason
    np.testing.assert_array_equal(columns.fields["value"].row, [0, 2])


def test_maps_and_messages_that_hold_themselves_end():
    message = struct_pb2.Struct()
    message["a"] = 1.0
    assert rows(decoded(message)) == {}


def test_a_schema_that_does_not_hold_its_message():
    descriptors = build_file_descriptor_set(wrappers_pb2.DoubleValue).SerializeToString()
    with pytest.raises(ValueError, match="its schema cannot be used"):
        payload_protobuf.decoder(Schema(1, descriptors, "protobuf", "google.protobuf.Missing"))
