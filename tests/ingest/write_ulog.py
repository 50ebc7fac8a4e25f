"""PX4 ULog by the public description of the format; pyulog can only write what it has read."""

import struct
from collections.abc import Iterable, Mapping
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from written import Format, Series, Written

from trialid.alignment import SignalSource

TOPICS = {
    "vehicle_angular_velocity": "uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;",
    "vehicle_attitude": "uint64_t timestamp;uint64_t timestamp_sample;float[4] q;",
    "vehicle_local_position": "uint64_t timestamp;float heading;bool heading_good_for_control;",
    "rudder_feedback": "uint64_t timestamp;float angle;",
    "speed_log": "uint64_t timestamp;double speed;",
}
PACKED = {
    "vehicle_angular_velocity": "<QQ3f", "vehicle_attitude": "<QQ4f",
    "vehicle_local_position": "<Qf?", "rudder_feedback": "<Qf", "speed_log": "<Qd",
}  # fmt: skip
LATE = 1500
"""Microseconds between a sample and its message."""


def message(kind: str, content: bytes) -> bytes:
    return struct.pack("<HB", len(content), ord(kind)) + content


def log(samples: Iterable[tuple[str, tuple[object, ...]]], start: int = 0) -> bytes:
    """A log of these messages: topic and fields."""
    formats = [message("F", f"{name}:{fields}".encode()) for name, fields in TOPICS.items()]
    added = [
        message("A", struct.pack("<BH", 0, i) + name.encode()) for i, name in enumerate(TOPICS)
    ]
    place = {name: i for i, name in enumerate(TOPICS)}
    data = [
        message("D", struct.pack("<H", place[topic]) + struct.pack(PACKED[topic], *fields))
        for topic, fields in samples
    ]
    flags = message("B", bytes(40))
    head = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", start)
    return b"".join([head, flags, *formats, *added, *data])


def samples(series: Mapping[str, Series]) -> list[tuple[str, tuple[object, ...]]]:
    """What an autopilot says of these series, by time."""
    found = [
        (int(t), *_one(name, int(t) // 1000, float(y)))
        for name, (stamps, values) in series.items()
        for t, y in zip(stamps, values, strict=True)
    ]
    return [(topic, fields) for _, topic, fields in sorted(found, key=lambda one: one[0])]


def _one(name: str, t: int, y: float) -> tuple[str, tuple[object, ...]]:
    if name == "r":
        return "vehicle_angular_velocity", (t + LATE, t, 0.0, 0.0, y)
    if name == "phi":
        return "vehicle_attitude", (t + LATE, t, np.cos(y / 2), np.sin(y / 2), 0.0, 0.0)
    if name == "psi":
        return "vehicle_local_position", (t, (y + np.pi) % (2 * np.pi) - np.pi, True)
    if name == "u":
        return "speed_log", (t, y)
    return "rudder_feedback", (t, y)


def write(path: Path, series: Mapping[str, Series]) -> Written:
    path.write_bytes(log(samples(series)))
    sources = (
        SignalSource("delta", "rudder_feedback:angle", "rad", "starboard"),
        SignalSource("r", "vehicle_angular_velocity:xyz[2]", positive="starboard"),
        SignalSource("phi", "vehicle_attitude:q", as_="roll"),
        SignalSource("psi", "vehicle_local_position:heading", positive="starboard"),
        SignalSource("u", "speed_log:speed", "m/s"),
    )
    resolution = {"delta": 1e-7, "r": 1e-8, "phi": 1e-6, "psi": 1e-6, "u": 1e-12}
    used = tuple(one for one in sources if one.quantity in series)
    return Written(used, {one.quantity: resolution[one.quantity] for one in used}, 1e-6)


FORMATS: tuple[Format, ...] = (Format("px4 ulog", write),) if find_spec("pyulog") else ()
