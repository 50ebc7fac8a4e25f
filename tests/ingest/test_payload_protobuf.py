import numpy as np
import pytest
from google.protobuf import duration_pb2, struct_pb2, timestamp_pb2, wrappers_pb2
from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorProto
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass
from mcap.records import Schema
from mcap_protobuf.schema import build_file_descriptor_set
from packed import packed

from trialid.ingest import payload_protobuf

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
