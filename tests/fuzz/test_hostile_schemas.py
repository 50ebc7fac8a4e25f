"""Schemas and messages made to do harm: types in themselves, types without end, nests of JSON."""

import json
from functools import partial

import numpy as np
import pytest
from google.protobuf import descriptor_pb2 as pb
from limits import bounded
from mcap.writer import CompressionType, Writer

from trialid.ingest import read
from trialid.inspection import Inspection, inspect_log

STAMP = 1_700_000_000_000_000_000
COUNT = 20
MB = 1_000_000


def log_of(path, encoding, schema, payload):
    """A log of one topic, and a healthy one beside it."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start()
        kind = 0 if schema is None else writer.register_schema(*schema)
        topic = writer.register_channel("/bad", encoding, kind)
        good = writer.register_channel("/good", "json", 0)
        for k in range(COUNT):
            stamp = STAMP + k * 100_000_000
            writer.add_message(topic, stamp, payload, stamp)
            writer.add_message(good, stamp, json.dumps({"y": k}).encode(), stamp)
        writer.finish()
    return path


def read_both(path, megabytes=400.0):
    """The channels; the healthy topic must be whole beside the harmful one."""
    channels = bounded(partial(read, path), megabytes).channels
    np.testing.assert_array_equal(channels["/good:y"].y, np.arange(COUNT))
    assert isinstance(bounded(partial(inspect_log, path), megabytes), Inspection)
    return {name: one for name, one in channels.items() if name != "/good:y"}


# --- ROS ----------------------------------------------------------------------------------------

RULE = "=" * 80
CDR = b"\x00\x01\x00\x00"


def _doubling(depth, width):
    """Each message holds `width` of the next: width^depth fields in all."""
    parts = [f"p/M1 a{i}\n" for i in range(width)]
    text = "".join(parts)
    for level in range(1, depth):
        inner = "".join(f"p/M{level + 1} a{i}\n" for i in range(width))
        text += f"{RULE}\nMSG: p/M{level}\n{inner if level < depth - 1 else 'float64 x'}\n"
    return text


ROS = {
    "itself": "p/A a\nfloat64 x\n",
    "each other": f"p/B b\n{RULE}\nMSG: p/B\np/A a\n",
    "many of itself": "p/A[] a\nfloat64 x\n",
    "doubling": _doubling(30, 10),
    "a huge array": "float64[1000000000] x\n",
    "a huge array of messages": f"p/B[1000000000] b\n{RULE}\nMSG: p/B\nuint8 x\n",
    "a huge array of nothing": f"p/B[1000000000] b\n{RULE}\nMSG: p/B\nuint8 K=1\n",
    "a huge bound": "float64[<=999999999999999999999999] x\n",
    "a million fields": "".join(f"float64 x{i}\n" for i in range(300_000)),
    "a hostile name": "float64 x\x1b[31m<script>\n",
}


@pytest.mark.parametrize("text", ROS.values(), ids=ROS)
@pytest.mark.parametrize("payload", [CDR, CDR + bytes(4000), CDR + b"\xff" * 4000, CDR + bytes(MB)],
                         ids=["empty", "0", "ff", "a megabyte"])  # fmt: skip
@pytest.mark.study(turn="each")
def test_a_ros_schema_without_end(tmp_path, text, payload):
    path = log_of(tmp_path / "log", "cdr", ("p/msg/A", "ros2msg", text.encode()), payload)
    read_both(path, 600.0)


# --- protobuf -----------------------------------------------------------------------------------


def _proto(*messages):
    """A set of descriptors: (name, [(field, type name or None for a double)])."""
    file = pb.FileDescriptorProto(name="bad.proto", package="p", syntax="proto3")
    for name, members in messages:
        kind = file.message_type.add(name=name)
        for number, (member, inner) in enumerate(members, 1):
            one = kind.field.add(name=member, number=number, label=1, type=1)
            if inner is not None:
                one.type, one.type_name = 11, f".p.{inner}"
    return pb.FileDescriptorSet(file=[file]).SerializeToString()


def _levels(depth, width):
    inside = [(f"M{i}", [(f"a{k}", f"M{i + 1}") for k in range(width)]) for i in range(depth)]
    return [("A", [("a", "M0")]), *inside, (f"M{depth}", [("x", None)])]


def _nested(depth):
    """Messages in field 1 of one another."""
    payload = b""
    for _ in range(depth):
        size = len(payload)
        varint = b""
        while size > 127:
            varint += bytes([size & 127 | 128])
            size >>= 7
        payload = b"\x0a" + varint + bytes([size]) + payload
    return payload


PROTO = {
    "itself": (_proto(("A", [("a", "A"), ("x", None)])), _nested(90)),
    "itself, deep": (_proto(("A", [("a", "A"), ("x", None)])), _nested(20_000)),
    "ten of itself": (_proto(("A", [(f"a{k}", "A") for k in range(10)])), _nested(20)),
    "doubling": (_proto(*_levels(14, 10)), _nested(10)),
    "doubling, deep": (_proto(*_levels(200, 2)), _nested(10)),
    "many fields": (_proto(("A", [(f"x{k}", None) for k in range(20_000)])), b""),
    "many messages": (_proto(("A", [("x", None)]), *((f"B{k}", []) for k in range(20_000))), b""),
    "unknown type": (_proto(("A", [("a", "Nowhere")])), b""),
    "no descriptor": (b"\xff" * 1000, b""),
    "empty": (b"", b""),
}


@pytest.mark.parametrize(("schema", "payload"), PROTO.values(), ids=PROTO)
def test_a_protobuf_schema_without_end(tmp_path, schema, payload):
    path = log_of(tmp_path / "log", "protobuf", ("p.A", "protobuf", schema), payload)
    read_both(path)


# --- JSON ---------------------------------------------------------------------------------------

DEEP = 100_000
JSON = {
    "lists": b"[" * DEEP,
    "closed lists": b'{"a":' + b"[" * DEEP + b"]" * DEEP + b"}",
    "objects": b'{"a":' * DEEP + b"1" + b"}" * DEEP,
    "less deep": b'{"a":' * 900 + b"1" + b"}" * 900,
    "a long number": b'{"a":' + b"9" * 5000 + b"}",
    "a number past all": b'{"a":1e999,"b":-1e999,"c":' + b"9" * 400 + b"}",
    "no numbers": b'{"a":NaN,"b":Infinity,"timestamp":NaN}',
    "a stamp past all": b'{"a":1,"timestamp":' + b"9" * 300 + b"}",
    "many keys": json.dumps({f"k{i}": i for i in range(20_000)}).encode(),
    "hostile keys": json.dumps({"\x1b[31m": 1, "<script>": 2, "[red]": 3, "a\nb": 4}).encode(),
    "lone surrogate": b'{"\\ud800":1}',
}


@pytest.mark.parametrize("payload", JSON.values(), ids=JSON)
@pytest.mark.study(turn="each")
def test_nests_of_json(tmp_path, payload):
    read_both(log_of(tmp_path / "log", "json", None, payload))


@pytest.mark.parametrize("payload", JSON.values(), ids=JSON)
@pytest.mark.study(turn=9)
def test_nests_of_json_in_a_delta(tmp_path, payload):
    """Signal K: the nest as a whole line, and as the value of one."""
    update = b'{"context":"vessels.self","updates":[{"$source":"a","values":[{"path":"b","value":'
    good = b"".join(
        b'%d;I;{"updates":[{"$source":"a","values":[{"path":"steering.rudderAngle","value":%d}]}]}\n'
        % (STAMP // 10**6 + 100 * k, k)
        for k in range(COUNT)
    )
    bad = b"%d;I;%s\n%d;I;%s%s}]}]}\n" % (STAMP // 10**6, payload, STAMP // 10**6, update, payload)
    (tmp_path / "log").write_bytes(good + bad + good)
    channels = bounded(partial(read, tmp_path / "log")).channels
    assert {0.0, COUNT - 1.0} <= set(channels["steering.rudderAngle/a:value"].y)
    assert isinstance(bounded(partial(inspect_log, tmp_path / "log")), Inspection)
