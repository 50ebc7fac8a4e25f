"""A thrust logged in newtons tells her mass, where the file's was guessed."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.identification.remarks import another_mass
from trialid.ship.actuators import Actuator

FILE = {"rho": 1025.0, "nabla": 2.0}


def fitted(command):
    """What is read of a fit: a boat of 2050 kg by her file, with two thrusters."""
    drives = [Actuator(name=n, kind="thruster", x=-2.0, y=0.5, command=command) for n in "ab"]
    ship = SimpleNamespace(actuators=drives, particulars=FILE)
    return SimpleNamespace(model=SimpleNamespace(ship=ship))


def known(gain, error=0.01):
    """The accuracy of a gain."""
    row = SimpleNamespace(name="k_ahead", value=gain, standard_error=error)
    return SimpleNamespace(parameters=[row])


@pytest.mark.parametrize(("gain", "mass"), [(6.7, "3.1e+02"), (0.2, "1e+04")])
def test_a_gain_that_no_thrust_has_tells_of_her_mass(gain, mass):
    [said] = another_mass(fitted("thrust"), known(gain))
    assert f"push with {gain}: either it is no thrust, or her mass is nearer {mass} kg" in said


@pytest.mark.parametrize(
    ("gain", "error", "command"),
    [
        (0.9, 0.01, "thrust"),
        (1.6, 0.01, "thrust"),
        (5.9, 2.8, "thrust"),  # noise alone may have made it so
        (5.9, np.nan, "thrust"),
        (160.0, 0.01, "share"),
    ],
)
def test_one_that_a_hull_may_have_one_hardly_known_and_a_share_tell_nothing(gain, error, command):
    assert another_mass(fitted(command), known(gain, error)) == ()
