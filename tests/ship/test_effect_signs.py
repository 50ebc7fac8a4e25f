"""Effects by hand: to which side, from where on, and how much together."""

import math

import pytest
from test_effects_by_hand import MASSES, NABLA, RHO, SHIP, STILL, U0, G, L, forces, sensed

from trialid.effects import CATALOGUE
from trialid.effects.rudder import ROUNDED
from trialid.ship.model import STATES, ShipModel
from trialid.ship.readings import readings


def test_what_comes_late_twice_comes_later_by_both() -> None:
    """A delay of half a second, and a clock that has lost 0.2 s after 2000 s."""
    both = (CATALOGUE["delay_r"], CATALOGUE["clock_drift_r"])
    model = ShipModel(SHIP, STATES, both)
    theta = MASSES | {"tau_r": 0.5, "drift_r": 1e-4}
    late = readings(model, STILL | {"u": U0}, {"t": 2000.0}, theta, dict.fromkeys("uvpr", 0.0))
    assert late.delay == {"r": pytest.approx(0.7)}


def test_a_current_to_the_north_sets_an_eastbound_ship_to_port() -> None:
    east, south = math.pi / 2, math.pi
    flow = {"vc_N": 2.0, "vc_E": 0.0}
    assert sensed("current_in_sway", flow, v=0.3, psi=east)["v"] == pytest.approx(-1.7)
    assert sensed("current_in_sway", flow, v=0.3, psi=south)["v"] == pytest.approx(0.3)
    assert sensed("current_in_surge", {"uc_N": 2.0, "uc_E": 0.0}, u=7.0, psi=south)[
        "u"
    ] == pytest.approx(5.0)


def test_a_rudder_loses_lift_only_beyond_its_stall() -> None:
    values = {"N_stall": -0.0015, "delta_stall": 0.4}
    scale = 0.5 * RHO * L**3 * U0**2
    for delta, beyond in ((0.5, 0.1), (-0.6, -0.2), (0.39, 0.0), (0.0, 0.0)):
        over = delta + 0.5 * (math.hypot(delta - 0.4, ROUNDED) - math.hypot(delta + 0.4, ROUNDED))
        assert over == pytest.approx(beyond, abs=7e-4)  # of a corner it is 0.04 deg off
        found = forces("rudder_stall", values, delta=delta)
        assert found["N"] == pytest.approx(-0.0015 * over * scale, rel=1e-6, abs=1e-6)
        assert found["Y"] == pytest.approx(0.003 * over * scale / L, rel=1e-6, abs=1e-6)


def test_the_slipstream_counts_the_speed_ahead_not_the_drift() -> None:
    u, v, delta = 4.0, 2.0, 0.3
    found = forces("rudder_slipstream", {"N_slip": 0.0015, "z_slip": 0.0}, u=u, v=v, delta=delta)
    expected = 0.5 * RHO * L**3 * 0.0015 * delta * u * (U0 - u)
    assert found["N"] == pytest.approx(expected, rel=1e-6)


def test_more_metacentric_height_rights_her_more() -> None:
    found = forces("metacentric_height_error", {"dGM": 0.1}, phi=0.05)
    assert found["K"] == pytest.approx(-RHO * G * NABLA * 0.1 * 0.05, rel=1e-6)
