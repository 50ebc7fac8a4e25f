"""A thrust logged in newtons tells her mass, where the file's was guessed."""

from types import SimpleNamespace

import pytest

from trialid.identification.remarks import another_mass
from trialid.ship.actuators import Actuator

FILE = {"rho": 1025.0, "nabla": 2.0}


def fitted(gain, command):
    """What is read of a fit: a boat of 2050 kg by her file, with two thrusters."""
    drives = [Actuator(name=n, kind="thruster", x=-2.0, y=0.5, command=command) for n in "ab"]
    model = SimpleNamespace(ship=SimpleNamespace(actuators=drives, particulars=FILE))
    return SimpleNamespace(model=model, estimates={"k_ahead": gain})


@pytest.mark.parametrize(("gain", "mass"), [(6.7, "3.1e+02"), (0.2, "1e+04")])
def test_a_gain_that_no_thrust_has_tells_of_her_mass(gain, mass):
    [said] = another_mass(fitted(gain, "thrust"))
    assert f"push with {gain}: either it is no thrust, or her mass is nearer {mass} kg" in said


@pytest.mark.parametrize(("gain", "command"), [(0.9, "thrust"), (1.6, "thrust"), (160.0, "share")])
def test_one_that_a_hull_may_have_and_a_share_tell_nothing(gain, command):
    assert another_mass(fitted(gain, command)) == []
