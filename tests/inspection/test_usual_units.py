"""The short cut past the library of units says what the library says."""

import subprocess
import sys

import numpy as np
import pytest

from trialid.errors import UnitError
from trialid.inspection.usual_units import of_angle, to_si
from trialid.names import units

SI = ("rad", "rad/s", "m/s", "m", "N")


@pytest.mark.parametrize("unit", units.USUAL)
@pytest.mark.parametrize("si", SI)
def test_the_usual_units_are_what_the_library_of_units_says(unit, si, monkeypatch):
    said = {"inspected": to_si(unit, si), "read": _factor(unit, si)}
    monkeypatch.setattr(units, "USUAL", {})
    expected = _factor(unit, si)
    assert said == {"inspected": expected, "read": expected}  # to the last digit


def test_a_roll_beyond_her_side_is_in_degrees_and_a_spike_is_no_roll():
    swing = 2.0 * np.sin(np.arange(0.0, 50.0, 0.1))
    assert of_angle(swing, goes_round=False) == "deg"
    assert of_angle(0.6 * swing, goes_round=False) is None
    assert of_angle(np.append(0.6 * swing, 3.0), goes_round=False) is None
    assert of_angle(swing, goes_round=True) is None  # a heading


def _factor(unit, si):
    try:
        return units.factor(unit, si)
    except UnitError:
        return None


def test_the_usual_units_are_read_without_the_library():
    asked = "from trialid.names import units; units.factor('Knoten', 'm/s')"
    told = f"import sys; {asked}; assert not {{'pint', 'dask'}} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", told], check=True)


def test_other_units_are_asked_for_and_nonsense_is_none():
    assert to_si("degree", "rad") == pytest.approx(units.USUAL["deg"][1])
    assert to_si("ft", "m") == pytest.approx(0.3048)
    assert to_si("[deg]", "rad") is None
    assert to_si("", "rad") is None
