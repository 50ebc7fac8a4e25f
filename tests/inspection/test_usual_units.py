"""The short cut past the library of units says what the library says."""

import pytest

from trialid.errors import UnitError
from trialid.inspection.usual_units import USUAL, to_si
from trialid.names import units

SI = ("rad", "rad/s", "m/s", "m", "N")


@pytest.mark.parametrize("unit", USUAL)
@pytest.mark.parametrize("si", SI)
def test_the_usual_units_are_what_the_library_of_units_says(unit, si):
    try:
        expected = units.factor(unit, si)
    except UnitError:
        expected = None
    assert to_si(unit, si) == (expected if expected is None else pytest.approx(expected, rel=1e-12))


def test_other_units_are_asked_for_and_nonsense_is_none():
    assert to_si("degree", "rad") == pytest.approx(USUAL["deg"][1])
    assert to_si("ft", "m") == pytest.approx(0.3048)
    assert to_si("[deg]", "rad") is None
    assert to_si("", "rad") is None
