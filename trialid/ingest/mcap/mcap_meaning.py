"""What the numbers in well-known messages are: unit, quantity, positive side, in words.

Only what a convention defines is said: the subjects of Keelson, whose names end in their unit, and
the ROS types whose definitions state units and, by REP-103, axes: x forward, y to port, z up. So a
ROS rate of turn counts to port, a roll rate starboard down.
"""

import re
from dataclasses import dataclass
from typing import Literal

from trialid.ingest.mcap.mcap_names import Source

Side = Literal["starboard", "port"] | None


@dataclass(frozen=True)
class Meaning:
    """What is known of a field; None where no convention says it."""

    description: str
    unit: str | None = None
    quantity: str | None = None
    positive: Side = None


KEELSON = re.compile(
    r"(?:^|/)@v\d+/(?P<entity>[^/]+)/pubsub/(?P<subject>\w+?)(?:_(?P<unit>[a-z]+))?/(?P<source>.+)"
)
KEELSON_UNITS = {
    "deg": "deg",
    "degps": "deg/s",
    "degpm": "deg/min",
    "knots": "kn",
    "mps": "m/s",
    "rpm": "rpm",
    "rad": "rad",
    "radps": "rad/s",
    "m": "m",
    "pct": "percent",
}
"""Keelson names its subjects with their unit at the end: `rudder_angle_deg`, `yaw_rate_degps`."""
KEELSON_SUBJECTS: dict[str, tuple[str, Side]] = {
    "rudder_angle": ("delta", "starboard"),
    "yaw_rate": ("r", "starboard"),
    "rate_of_turn": ("r", "starboard"),
    "roll": ("phi", "starboard"),
    "roll_rate": ("p", "starboard"),
    "heading_true_north": ("psi", "starboard"),
    "speed_through_water": ("u", None),
    "propeller_rate": ("n", None),
    "apparent_wind_speed": ("V_aw", None),
    "apparent_wind_angle": ("gamma_aw", "starboard"),
}
"""Signs as Keelson's connectors pass them on, unchanged, from NMEA 0183 and NMEA 2000. Wind over
ground and speed over ground are no quantities of the ship's motion through the water."""

TWISTS = {
    "geometry_msgs/Twist": "",
    "geometry_msgs/TwistStamped": "twist.",
    "geometry_msgs/TwistWithCovariance": "twist.",
    "geometry_msgs/TwistWithCovarianceStamped": "twist.twist.",
    "nav_msgs/Odometry": "twist.twist.",
}
"""Where a message keeps its velocities."""
RATES: dict[str, tuple[str, str | None, Side]] = {
    "x": ("rad/s", "p", "starboard"),
    "y": ("rad/s", None, None),
    "z": ("rad/s", "r", "port"),
}
SPEEDS: dict[str, tuple[str, str | None, Side]] = {
    "x": ("m/s", "u", None),
    "y": ("m/s", "v", "port"),
    "z": ("m/s", None, None),
}
UNITS = {
    "sensor_msgs/Imu": {"linear_acceleration": "m/s^2"},
    "nav_msgs/Odometry": {"pose.pose.position": "m"},
    "sensor_msgs/NavSatFix": {"latitude": "deg", "longitude": "deg", "altitude": "m"},
    "mavros_msgs/VfrHud": {"airspeed": "m/s", "groundspeed": "m/s", "heading": "deg"},
    "mavros_msgs/RCOut": {"channels": "us"},
    "mavros_msgs/RCIn": {"channels": "us"},
}
"""Units that definitions state of other fields, by the field or what stands before its last dot or
bracket."""
ORDERS = re.compile(r"cmd|command|setpoint|desired|target|reference", re.IGNORECASE)
"""Topics of what was asked for: a field has its unit there, but is no motion of the ship."""
EARTH = re.compile(r"gps|gnss|navsat|global_position|velocity_local|/vel$", re.IGNORECASE)
"""Topics whose velocities are to the east and north, whatever the type says."""

SENTENCES = {
    "nmea_msgs/Sentence": "NMEA 0183 sentences",
    "raw_nmea0183": "NMEA 0183 sentences",
    "raw_nmea2000": "NMEA 2000 frames",
    "raw_lwe450": "NMEA 0183 datagrams",
}


def field_meaning(source: Source, field: str) -> Meaning:
    """What the field of messages from this source is.

    >>> gyro = Source("x/@v0/ship/pubsub/yaw_rate_degps/gyro", "protobuf", None)
    >>> one = field_meaning(gyro, "value")
    >>> one.unit, one.quantity, one.positive
    ('deg/s', 'r', 'starboard')
    """
    found = KEELSON.search(source.topic)
    if found and field == "value":
        return _keelson(found)
    kind = ros_kind(source.kind)
    plain = Meaning(f"{kind or source.encoding} {field} on {source.topic}")
    return _ros(source.topic, kind, field, plain) if source.encoding == "cdr" else plain


def _keelson(found: re.Match[str]) -> Meaning:
    subject, ending = found["subject"], found["unit"] or ""
    unit = KEELSON_UNITS.get(ending)
    whole = subject if not ending else f"{subject}_{ending}"
    words = f"Keelson {whole} of {found['entity']}, source {found['source']}"
    quantity, side = KEELSON_SUBJECTS.get(subject, (None, None)) if unit else (None, None)
    return Meaning(words, unit, quantity, side)


def ros_kind(kind: str) -> str:
    """A type as ROS 1 wrote it, `sensor_msgs/Imu`.

    >>> ros_kind("sensor_msgs/msg/Imu")
    'sensor_msgs/Imu'
    """
    return kind.replace("/msg/", "/")


def _ros(topic: str, kind: str, field: str, plain: Meaning) -> Meaning:
    before, _, axis = field.rpartition(".")
    if kind == "sensor_msgs/Imu" and before == "angular_velocity" and axis in RATES:
        return _along(RATES[axis], topic, plain)
    twist = TWISTS.get(kind)
    if twist is not None and before in (f"{twist}linear", f"{twist}angular"):
        axes = SPEEDS if before.endswith("linear") else RATES
        if axis in axes:  # a log may define the type otherwise than ROS does
            return _along(axes[axis], topic, plain)
    units = UNITS.get(kind, {})
    unit = units.get(field) or units.get(before) or units.get(field.partition("[")[0])
    return Meaning(plain.description, unit)


def _along(axis: tuple[str, str | None, Side], topic: str, plain: Meaning) -> Meaning:
    unit, quantity, side = axis
    if ORDERS.search(topic) or (unit == "m/s" and EARTH.search(topic)):
        return Meaning(plain.description, unit)
    towards = f", positive to {side}" if side else ""
    return Meaning(f"{plain.description}, axes of REP-103{towards}", unit, quantity, side)


def text(source: Source) -> str | None:
    """What a topic holds instead of numbers, None when it is not known to.

    >>> text(Source("x/@v0/ship/pubsub/raw_nmea0183/gps", "protobuf", None))
    'NMEA 0183 sentences'
    """
    found = KEELSON.search(source.topic)
    return SENTENCES.get(found["subject"] if found else ros_kind(source.kind))
