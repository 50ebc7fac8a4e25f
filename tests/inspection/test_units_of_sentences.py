"""Units, quantities and sides of sentences and messages: one number of each, worked out in SI."""

import re
from functools import reduce
from operator import xor
from types import SimpleNamespace

import pytest

from trialid.ingest import read
from trialid.ingest.mavlink.mavlink_meanings import DATAFLASH, MAVLINK
from trialid.ingest.mcap.mcap_meaning import field_meaning
from trialid.ingest.mcap.mcap_names import Source
from trialid.ingest.signalk.signalk_deltas import PATHS
from trialid.names import units
from trialid.names.quantities import SIGNALS

KNOT = 1852.0 / 3600.0
DEGREE = 0.017453292519943295


def sentence(talker, kind, fields):
    """A sentence with its checksum."""
    body = ",".join([talker + kind, *fields])
    return f"${body}*{reduce(xor, body.encode()):02X}"


def one(folder, talker, kind, fields, channel):
    """A channel of a log that holds this sentence a hundred times, a tenth of a second apart."""
    lines = [
        f"2023-11-14T22:13:{20 + k / 10:06.3f}Z {sentence(talker, kind, fields)}\r\n"
        for k in range(100)
    ]
    path = folder / "bridge.log"
    path.write_text("".join(lines), encoding="ascii", newline="")
    return read(path).channels[channel]


@pytest.mark.parametrize(
    ("kind", "fields", "channel", "quantity", "si"),
    [
        ("ROT", ["-60.0", "A"], "ROT/TI:rate", "r", -DEGREE),  # deg/min
        ("HDT", ["90.0", "T"], "HDT/TI:heading", "psi", 90.0 * DEGREE),
        (
            "VBW",
            ["10.0", "-2.0", "A", "11.0", "3.0", "A", "", "", "", ""],
            "VBW/TI:longitudinal_water",
            "u",
            10.0 * KNOT,
        ),
        (
            "VBW",
            ["10.0", "-2.0", "A", "11.0", "3.0", "A", "", "", "", ""],
            "VBW/TI:transverse_water",
            "v",
            -2.0 * KNOT,
        ),
        ("MWV", ["30.0", "R", "20.0", "N", "A"], "MWV/TI:relative_speed", "V_aw", 20.0 * KNOT),
        ("MWV", ["30.0", "R", "36.0", "K", "A"], "MWV/TI:relative_speed", "V_aw", 10.0),
        ("MWV", ["30.0", "R", "12.0", "M", "A"], "MWV/TI:relative_speed", "V_aw", 12.0),
        (
            "MWV",
            ["30.0", "R", "12.0", "M", "A"],
            "MWV/TI:relative_angle",
            "gamma_aw",
            30.0 * DEGREE,
        ),
    ],
)
def test_a_sentence_in_si(tmp_path, kind, fields, channel, quantity, si):
    found = one(tmp_path, "TI", kind, fields, channel)
    assert found.quantity == quantity
    factor = units.factor(found.unit, SIGNALS[quantity].unit)
    assert factor * found.y == pytest.approx(si, rel=1e-6)


AXES = {
    r"(roll|x)(speed|gyro)|GyrX|R": "p",
    r"(yaw|z)(speed|gyro)|GyrZ|Y": "r",
    r"roll|Roll": "phi",
    r"yaw|Yaw|heading|hdg": "psi",
}
"""Fields of autopilots by their names, and what they are: body axes forward, right and down."""


@pytest.mark.parametrize("table", [DATAFLASH, MAVLINK], ids=["dataflash", "mavlink"])
def test_fields_of_an_autopilot_are_what_they_are_called(table):
    counted = 0
    for (message, field), meaning in table.items():
        for pattern, quantity in AXES.items():
            if re.fullmatch(pattern, field):
                assert meaning.quantity == quantity, (message, field)
                assert meaning.positive == "starboard", (message, field)
                counted += 1
    assert counted >= 12


@pytest.mark.parametrize(
    ("ending", "unit", "factor"),
    [
        ("deg", "rad", DEGREE),
        ("degps", "rad/s", DEGREE),
        ("degpm", "rad/s", DEGREE / 60.0),
        ("knots", "m/s", KNOT),
        ("rpm", "rad/s", 0.10471975511965977),
        ("mps", "m/s", 1.0),
        ("radps", "rad/s", 1.0),
    ],
)
def test_keelson_names_its_units(ending, unit, factor):
    source = Source(f"x/@v0/ship/pubsub/something_{ending}/one", "protobuf", None)
    assert units.factor(field_meaning(source, "value").unit, unit) == pytest.approx(factor)


@pytest.mark.parametrize(
    ("topic", "quantity"),
    [
        ("/imu/data", "r"),
        ("/cmd_imu", None),
        ("/setpoint/imu", None),
        ("/imu_desired", None),
    ],
)
def test_what_was_asked_for_is_no_motion(topic, quantity):
    imu = SimpleNamespace(name="sensor_msgs/msg/Imu")
    found = field_meaning(Source(topic, "cdr", imu), "angular_velocity.z")
    assert found.unit == "rad/s"
    assert found.quantity == quantity
    if quantity:
        assert found.positive == "port"  # REP-103: z is up


@pytest.mark.parametrize(
    ("path", "quantity", "side"),
    [
        ("navigation.attitude:roll", "phi", "starboard"),
        ("navigation.rateOfTurn", "r", "starboard"),
        ("steering.rudderAngle", "delta", "starboard"),
        ("navigation.headingTrue", "psi", "starboard"),
        ("environment.wind.angleApparent", "gamma_aw", "starboard"),
        ("navigation.speedThroughWaterTransverse", "v", "starboard"),
    ],
)
def test_signal_k_counts_to_starboard(path, quantity, side):
    """Its specification: roll and rudder positive to starboard, angles clockwise, all in SI."""
    unit, known, positive = PATHS[path]
    assert (known, positive) == (quantity, side)
    assert units.factor(unit, SIGNALS[quantity].unit) == 1.0


@pytest.mark.parametrize(
    ("kind", "field"),
    [
        ("sensor_msgs/msg/Imu", "angular_velocity.w"),
        ("geometry_msgs/msg/Twist", "linear.north"),
        ("geometry_msgs/msg/Twist", "angular.yJfloat64"),
    ],
)
def test_a_type_that_a_log_defines_otherwise_has_no_meaning(kind: str, field: str) -> None:
    found = field_meaning(Source("/imu", "cdr", SimpleNamespace(name=kind)), field)
    assert (found.quantity, found.unit) == (None, None)
