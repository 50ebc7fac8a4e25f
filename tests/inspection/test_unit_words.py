"""Units as people and instruments write them."""

import math

import pytest

from trialid.errors import UnitError
from trialid.names import units

TURN = 2 * math.pi
FACTORS = {
    "rad/s": {
        "rpm": TURN / 60, "U/min": TURN / 60, "Upm": TURN / 60, "min-1": TURN / 60,
        "1/min": TURN / 60, "r/min": TURN / 60, "rev/min": TURN / 60, "tr/min": TURN / 60,
        "rev/s": TURN, "rps": TURN, "U/s": TURN, "°/min": TURN / 21600, "Grad/s": TURN / 360,
        "deg/sec": TURN / 360, "degree/s": TURN / 360, "º/s": TURN / 360,
        "deg per min": TURN / 21600,
    },
    "rad": {"°": TURN / 360, "Grad": TURN / 360, "grader": TURN / 360, "gon": TURN / 400},
    "m/s": {"Knoten": 1852 / 3600, "kts": 1852 / 3600, "m/sek": 1.0, "km/h": 1 / 3.6},
    "s": {"sek": 1.0, "ms": 1e-3},
}  # fmt: skip


@pytest.mark.parametrize(("unit", "si"), [(u, si) for si, of in FACTORS.items() for u in of])
def test_what_a_unit_in_other_words_is(unit, si):
    assert units.factor(unit, si) == pytest.approx(FACTORS[si][unit], rel=1e-9)


@pytest.mark.parametrize(
    ("unit", "si", "said"),
    [
        ("grad", "rad", "may be a degree or the hundredth of a right angle"),
        ("grad/s", "rad/s", "may be a degree"),
        ("1/s", "rad/s", "does not say what turns"),
        ("U/min", "m/s", "cannot become"),
        ("(7)", "s", "is not a unit text"),
    ],
)
def test_what_may_be_two_things_is_refused(unit, si, said):
    with pytest.raises(UnitError, match=said.replace("(", r"\(")):
        units.factor(unit, si)
