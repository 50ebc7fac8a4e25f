"""Units of autopilots by their prefixes, against a library that knows what a prefix is."""

import pint
import pytest

from trialid.ingest.mavlink.mavlink_meanings import UNITS, unit
from trialid.names import units

REGISTRY = pint.UnitRegistry()
SPELT = {
    "cdeg": "centidegree",
    "ddeg": "decidegree",
    "cdeg/s": "centidegree / second",
    "degE5": "1e-5 degree",
    "degE7": "1e-7 degree",
    "mrad/s": "milliradian / second",
    "degheading": "degree",
    "deglatitude": "degree",
    "deglongitude": "degree",
    "m/s/s": "meter / second**2",
    "cm/s/s": "centimeter / second**2",
    "deg/s/s": "degree / second**2",
    "rad/s/s": "radian / second**2",
    "µs": "microsecond",
    "%": "percent",
    "d%": "decipercent",
    "c%": "centipercent",
}
"""As the definitions of MAVLink and ArduPilot explain them."""

OTHERS = {"", "UNKNOWN", "instance", "cdegC", "mG", "Gauss", "mGauss"}
"""Of no motion of a ship."""


@pytest.mark.parametrize("text", SPELT)
def test_a_number_becomes_what_its_unit_says(text):
    known, divisor = unit(text)
    ours = REGISTRY.Quantity(1.0 / divisor, known)
    meant = REGISTRY.Quantity(SPELT[text])
    assert ours.to(meant.units).magnitude == pytest.approx(meant.magnitude, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "si", "rate"),
    [
        ("cdeg/s", "rad/s", 1.7453292519943295e-4),
        ("mrad/s", "rad/s", 1e-3),
        ("cdeg", "rad", 1.7453292519943295e-4),
        ("degE7", "rad", 1.7453292519943295e-9),
    ],
)
def test_what_turns_a_ship_by_the_numbers(text, si, rate):
    known, divisor = unit(text)
    assert units.factor(known, si) / divisor == pytest.approx(rate, rel=1e-9)


def test_every_unit_is_looked_at():
    assert {*SPELT, *OTHERS} == {*UNITS}
