"""MCAP logs by the real libraries: ROS 2, Keelson's protobuf and JSON, in every compression.

ROS 2 messages come as recorders of research vessels have them: rate of turn and roll in an Imu by
REP-103, the rudder as a JointState, the speed as a TwistStamped, the course angle of the Imu's axes
in its quaternion, which grows to port.
"""

import functools
import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import CompressionType
from sample_writers import write_logs
from written import Format, Series, Written

from trialid.alignment import SignalSource

LATE = 3_000_000
"""The recorder gets a message so many nanoseconds after its stamp."""

RULE = "=" * 80
STAMP = (
    f"{RULE}\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    f"{RULE}\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
)
JOINT_STATE = (
    "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
    f"float64[] effort\n{STAMP}"
)
TWIST_STAMPED = (
    f"std_msgs/Header header\ngeometry_msgs/Twist twist\n{STAMP}"
    f"{RULE}\nMSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n"
    f"{RULE}\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
)
KINDS = {
    "joints": ("sensor_msgs/msg/JointState", JOINT_STATE),
    "imu": ("sensor_msgs/msg/Imu", write_logs.IMU),
    "roll": ("sensor_msgs/msg/Imu", write_logs.IMU),
    "heading": ("sensor_msgs/msg/Imu", write_logs.IMU),
    "speed": ("geometry_msgs/msg/TwistStamped", TWIST_STAMPED),
}
KEELSON = {
    "delta": ("rudder_angle_deg", np.pi / 180),
    "r": ("yaw_rate_degps", np.pi / 180),
    "phi": ("roll_deg", np.pi / 180),
    "u": ("speed_through_water_knots", 1852 / 3600),
    "psi": ("heading_true_north_deg", np.pi / 180),
}


def header(stamp: int) -> dict[str, Any]:
    """A ROS header."""
    seconds, nanos = divmod(stamp, 1_000_000_000)
    return {"stamp": {"sec": seconds, "nanosec": nanos}, "frame_id": "base_link"}


def ros2(compression: CompressionType) -> Callable[[Path, Mapping[str, Series]], Written]:
    """Writer of a ROS 2 log."""

    def write(path: Path, series: Mapping[str, Series]) -> Written:
        from mcap_ros2.writer import Writer

        with path.open("wb") as file:
            writer = Writer(file, chunk_size=write_logs.CHUNK_SIZE, compression=compression)
            schemas = {topic: writer.register_msgdef(*kind) for topic, kind in KINDS.items()}
            for stamp, topic, message in _ros2_messages(series):
                log = stamp + LATE
                schema = schemas[topic]
                writer.write_message(f"/{topic}", schema, message, log_time=log, publish_time=log)
            writer.finish()
        return _written(series, ROS2_SOURCES, dict.fromkeys(series, 1e-12))

    return write


ROS2_SOURCES = (
    SignalSource("delta", "/joints:position[rudder]", "rad", "starboard"),
    SignalSource("r", "/imu:angular_velocity.z", None, "port"),
    SignalSource("phi", "/roll:orientation", as_="roll"),
    SignalSource("u", "/speed:twist.linear.x"),
    SignalSource("psi", "/heading:orientation", None, "port", as_="yaw"),
)


def _ros2_messages(series: Mapping[str, Series]) -> Iterator[tuple[int, str, dict[str, Any]]]:
    each = [_of_quantity(name, *samples) for name, samples in series.items()]
    return write_logs._merged(each)


def _of_quantity(name: str, t: Any, y: Any) -> Iterator[tuple[int, str, dict[str, Any]]]:
    for stamp, value in zip(t.tolist(), y.tolist(), strict=True):
        half = value / 2
        topic, content = {
            "delta": ("joints", {"name": ["sail", "rudder"], "position": [9.0, value]}),
            "r": ("imu", {"angular_velocity": {"z": -value}}),
            "phi": ("roll", {"orientation": {"x": np.sin(half), "w": np.cos(half)}}),
            "u": ("speed", {"twist": {"linear": {"x": value}}}),
            "psi": ("heading", {"orientation": {"z": -np.sin(half), "w": np.cos(half)}}),
        }[name]
        yield stamp, topic, {"header": header(stamp), **content}


def keelson(path: Path, series: Mapping[str, Series]) -> Written:
    """Protobuf TimestampedFloat, which are 32 bit."""
    prefix = "rise/@v0/ship/pubsub"
    topics = {name: f"{prefix}/{KEELSON[name][0]}/one" for name in series}
    channels = {topics[name]: (t, y / KEELSON[name][1]) for name, (t, y) in series.items()}
    write_logs.write_keelson_mcap(path, channels, LATE)
    sources = tuple(
        SignalSource(name, f"{topic}:value", None, "starboard" if name == "delta" else None)
        for name, topic in topics.items()
    )
    steps = {name: float(np.abs(y).max()) * 2.0**-23 for name, (_, y) in series.items()}
    return _written(series, sources, steps)


def json_messages(
    compression: CompressionType,
) -> Callable[[Path, Mapping[str, Series]], Written]:
    """Writer of a log of JSON messages without a schema, all quantities on one topic."""

    def write(path: Path, series: Mapping[str, Series]) -> Written:
        from mcap.writer import Writer

        with path.open("wb") as file:
            writer = Writer(file, chunk_size=write_logs.CHUNK_SIZE, compression=compression)
            writer.start()
            topic = writer.register_channel("/ship", "json", 0)
            for stamp, name, value in write_logs._in_order(series):
                text = json.dumps({"header": header(stamp), name: value})
                writer.add_message(topic, stamp + LATE, text.encode(), stamp + LATE)
            writer.finish()
        sources = tuple(
            SignalSource(
                name, f"/ship:{name}", UNITS[name], "starboard" if name == "delta" else None
            )
            for name in series
        )
        return _written(series, sources, dict.fromkeys(series, 1e-12))

    return write


UNITS = {"delta": "rad", "r": "rad/s", "phi": "rad", "u": "m/s", "psi": "rad"}


def _written(
    series: Mapping[str, Series], sources: tuple[SignalSource, ...], steps: Mapping[str, float]
) -> Written:
    return Written(tuple(s for s in sources if s.quantity in series), steps)


@functools.cache
def encoder(topic: str) -> Callable[[dict[str, Any]], bytes]:
    """What encodes messages of a topic in CDR, from the library."""
    from mcap_ros2._dynamic import serialize_dynamic

    name, definition = KINDS[topic]
    encode: Callable[[dict[str, Any]], bytes] = serialize_dynamic(name, definition)[name]
    return encode


FORMATS: tuple[Format, ...] = (
    Format("mcap ros2 zstd", ros2(CompressionType.ZSTD)),
    Format("mcap ros2 lz4", ros2(CompressionType.LZ4)),
    Format("mcap keelson", keelson),
    Format("mcap json", json_messages(CompressionType.NONE)),
)
