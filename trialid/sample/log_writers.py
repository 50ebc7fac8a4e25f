"""Write given arrays to logs of each format, with the real libraries.

Every channel has its own stamps (int64, ns) and values. The same arrays give the same bytes, with
the same versions of the libraries. `received_after` is what a recorder adds: the log time of a
message is its stamp plus so many nanoseconds.
"""

import csv
import functools
import heapq
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from numpy.typing import NDArray

Stamps = NDArray[np.int64]
Values = NDArray[np.float64]
Samples = tuple[Stamps, Values]
"""Stamps [ns] and values of one channel; (N,) each."""
Message = tuple[int, str, Any]
"""Stamp [ns], topic, content."""

CHUNK_SIZE = 64 * 1024
"""Small chunks: a logger that dies loses seconds, not minutes."""

VALUE_SCHEMA = {
    "title": "value",
    "type": "object",
    "properties": {
        "timestamp": {
            "type": "object",
            "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}},
        },
        "value": {"type": ["number", "null"]},
    },
}

FLOAT64 = "float64 data\n"
IMU = """\
std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""


@dataclass(frozen=True, kw_only=True)
class Imu:
    """Motions as an inertial unit logs them, in the unit's own axes; angles [rad], rates [rad/s].

    Stamps [ns] and every array (N,).
    """

    t: Stamps
    roll: Values
    pitch: Values
    yaw: Values
    roll_rate: Values
    pitch_rate: Values
    yaw_rate: Values


def write_keelson_mcap(
    path: Path, channels: Mapping[str, Samples], received_after: int = 0
) -> None:
    """Protobuf `keelson.TimestampedFloat` messages; a key is the whole topic."""
    from mcap_protobuf.writer import Writer

    timestamped_float = _timestamped_float()
    with path.open("wb") as file, Writer(file, chunk_size=CHUNK_SIZE) as writer:
        for stamp, topic, value in _in_order(channels):
            message = timestamped_float(value=value)
            message.timestamp.FromNanoseconds(stamp)
            writer.write_message(topic, message, stamp + received_after, stamp + received_after)


def write_ros2_mcap(
    path: Path,
    floats: Mapping[str, Samples],
    imus: Mapping[str, Imu] | None = None,
    received_after: int = 0,
) -> None:
    """`std_msgs/Float64`, which has no stamp of its own, and `sensor_msgs/Imu`, which has one."""
    from mcap_ros2.writer import Writer

    with path.open("wb") as file:
        writer = Writer(file, chunk_size=CHUNK_SIZE)
        plain = writer.register_msgdef("std_msgs/msg/Float64", FLOAT64)
        imu = writer.register_msgdef("sensor_msgs/msg/Imu", IMU)
        streams = [*_floats(floats), *(_imu(topic, rows) for topic, rows in (imus or {}).items())]
        for stamp, topic, message in _merged(streams):
            schema = imu if "header" in message else plain
            log = stamp + received_after
            writer.write_message(topic, schema, message, log_time=log, publish_time=log)
        writer.finish()  # type: ignore[no-untyped-call]


def write_json_mcap(
    path: Path, channels: Mapping[str, Samples], received_after: int = 0, *, schema: bool = True
) -> None:
    """JSON messages `{"timestamp": {"sec", "nsec"}, "value"}`, NaN as null."""
    with path.open("wb") as file:
        writer = _mcap_writer(file)
        encoding = json.dumps(VALUE_SCHEMA).encode()
        number = writer.register_schema("value", "jsonschema", encoding) if schema else 0
        topics = {topic: writer.register_channel(topic, "json", number) for topic in channels}
        for stamp, topic, value in _in_order(channels):
            log = stamp + received_after
            writer.add_message(topics[topic], log, _json(stamp, value), log)
        writer.finish()  # type: ignore[no-untyped-call]


def write_csv(
    path: Path, t: Values, columns: Mapping[str, Values], separator: str = ",", decimal: str = "."
) -> None:
    """One table on one clock: `t` [s], and a header `name[unit]` as key of each column; (N,)."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, delimiter=separator, lineterminator="\n")
        writer.writerow(["t[s]", *columns])
        for row in zip(t, *columns.values(), strict=True):
            writer.writerow([_decimal(float(value), decimal) for value in row])


def _decimal(value: float, point: str) -> str:
    return "" if math.isnan(value) else repr(value).replace(".", point)


def _json(stamp: int, value: float) -> bytes:
    seconds, nanos = divmod(stamp, 1_000_000_000)
    number = None if math.isnan(value) else value
    return json.dumps({"timestamp": {"sec": seconds, "nsec": nanos}, "value": number}).encode()


def _mcap_writer(file: IO[bytes]) -> McapWriter:
    writer = McapWriter(file, chunk_size=CHUNK_SIZE, compression=CompressionType.ZSTD)
    writer.start(profile="", library="trialid sample data")
    return writer


def _in_order(channels: Mapping[str, Samples]) -> Iterator[Message]:
    """Samples of all channels in the order of their stamps."""
    return _merged([_samples(topic, *samples) for topic, samples in channels.items()])


def _merged(streams: Iterable[Iterable[Message]]) -> Iterator[Message]:
    return heapq.merge(*streams, key=lambda message: message[0])


def _samples(topic: str, t: Stamps, y: Values) -> Iterator[Message]:
    for stamp, value in zip(t.tolist(), y.tolist(), strict=True):
        yield stamp, topic, value


def _floats(channels: Mapping[str, Samples]) -> Iterator[Iterator[Message]]:
    for topic, samples in channels.items():
        yield ((stamp, name, {"data": value}) for stamp, name, value in _samples(topic, *samples))


def _imu(topic: str, imu: Imu) -> Iterator[Message]:
    x, y, z, w = _quaternion(imu.roll, imu.pitch, imu.yaw)
    for i, stamp in enumerate(imu.t.tolist()):
        seconds, nanos = divmod(stamp, 1_000_000_000)
        yield (
            stamp,
            topic,
            {
                "header": {"stamp": {"sec": seconds, "nanosec": nanos}, "frame_id": "imu"},
                "orientation": {"x": x[i], "y": y[i], "z": z[i], "w": w[i]},
                "orientation_covariance": [0.0] * 9,
                "angular_velocity": {
                    "x": imu.roll_rate[i],
                    "y": imu.pitch_rate[i],
                    "z": imu.yaw_rate[i],
                },
                "angular_velocity_covariance": [0.0] * 9,
                "linear_acceleration": {"x": 0.0, "y": 0.0, "z": 0.0},
                "linear_acceleration_covariance": [0.0] * 9,
            },
        )


def _quaternion(roll: Values, pitch: Values, yaw: Values) -> tuple[Values, Values, Values, Values]:
    """x, y, z, w of the rotation yaw, then pitch, then roll."""
    cr, sr = np.cos(roll / 2), np.sin(roll / 2)
    cp, sp = np.cos(pitch / 2), np.sin(pitch / 2)
    cy, sy = np.cos(yaw / 2), np.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


@functools.cache
def _timestamped_float() -> Callable[..., Any]:
    """The message class of Keelson's TimestampedFloat, built from its published definition."""
    from google.protobuf import timestamp_pb2
    from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorProto
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message_factory import GetMessageClass

    file = FileDescriptorProto(name="Primitives.proto", package="keelson", syntax="proto3")
    file.dependency.append("google/protobuf/timestamp.proto")
    message = file.message_type.add(name="TimestampedFloat")
    kinds, single = FieldDescriptorProto, FieldDescriptorProto.LABEL_OPTIONAL
    stamp = message.field.add(name="timestamp", number=1, type=kinds.TYPE_MESSAGE, label=single)
    stamp.type_name = ".google.protobuf.Timestamp"
    message.field.add(name="value", number=2, type=kinds.TYPE_FLOAT, label=single)
    pool = DescriptorPool()
    pool.AddSerializedFile(timestamp_pb2.DESCRIPTOR.serialized_pb)
    pool.Add(file)
    return GetMessageClass(pool.FindMessageTypeByName("keelson.TimestampedFloat"))
