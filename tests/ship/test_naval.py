"""The naval vessel: its published dimensional numbers, their primes, and how it rolls."""

import math

import numpy as np
import pytest

from trialid.ship.model import ShipModel
from trialid.ship.prime import prime_parameter
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

DEG = math.pi / 180.0
L, RHO, G = 51.5, 1014.0, 9.81

PRINTED = {
    "m": 0.00523, "Yv": -0.00878, "Yr": 0.00189, "Yvav": -0.00275, "Yvar": -0.01147,
    "Yrav": -0.00263, "Nv": -0.00133, "Nr": -0.00132, "Nrar": -0.00110, "Nrav": -0.00437,
    "Kv": 1.34e-4, "Kr": -2.86e-5, "Kvav": 4.23e-4, "Kvar": 1.74e-4, "Krav": 3.98e-5,
    "Kp": -4.35e-6, "Kpap": -2.27e-6, "Yphi": -5.5e-5, "Nphi": -1.16e-4, "Kphi": -1.70e-5,
    "Yphiauv": 0.00803, "Yphiaur": 0.00362, "Nphiauv": -0.00309, "Nphiuar": -0.00140,
}  # fmt: skip
"""Primes by another hand, at 8 m/s, to two or three digits."""

RUDDERS = {"Yv": 1.0, "Yr": -23.8 / L, "Nv": -23.8 / L, "Nr": (23.8 / L) ** 2}
"""What a unit of side force of the two rudders adds, by where it acts (x = -23.8 m)."""


@pytest.mark.parametrize("name", PRINTED)
def test_prime_equivalents(name: str, naval: ShipModel) -> None:
    """Half a unit of the last printed digit is .5 % at the worst."""
    assert naval.value(name) == pytest.approx(PRINTED[name], rel=0.005)


def test_prime_equivalents_that_are_not_coefficients(naval: ShipModel) -> None:
    """Damping at rest at 8 m/s, and the cubic righting moment, as primed moments."""
    damping = naval.value("Kp0") / (0.5 * RHO * L**4 * 8.0)
    cubic = -RHO * G * 357.0 * naval.value("GM3") / (0.5 * RHO * L**3 * 64.0)
    assert damping == pytest.approx(-1.75e-5, rel=0.005)
    assert cubic == pytest.approx(-2.6e-4, rel=0.005)
    effect = next(e for e in naval.effects if "GM3" in e.parameters)
    assert prime_parameter(effect, "GM3", 0.325, L, 8.0) == pytest.approx(0.325 / L)


def test_our_rudders(naval: ShipModel) -> None:
    """Two of 1.5 m^2 with .054 per degree, 23.8 m aft of the origin, 1.55 m below the waterline."""
    force = -0.5 * RHO * 2.0 * 1.5 * math.degrees(0.054)
    given = naval.ship.coefficients
    assert given["Ydelta"] == pytest.approx(force, rel=1e-4)
    assert given["Ndelta"] == pytest.approx(-23.8 * force, rel=1e-4)
    assert given["Kdelta"] == pytest.approx(-1.55 * force, rel=1e-4)


def straightened(naval: ShipModel, straightening: float) -> ShipModel:
    """With the rudders standing in the flow of drift and turning: the sum in the hull's terms."""
    across = straightening * naval.value("Ydelta")
    arm = naval.value("Kdelta") / naval.value("Ydelta")
    changed = {n: naval.value(n) + across * x for n, x in RUDDERS.items()}
    changed |= {"Kv": naval.value("Kv") + arm * across}
    changed |= {"Kr": naval.value("Kr") + arm * across * RUDDERS["Yr"]}
    return naval.with_values(changed)


def roll_mode(model: ShipModel) -> tuple[float, float]:
    """Natural period [s] and damping ratio at 8 m/s, by a decay from half a degree."""
    samples, period = 1200, 0.025
    signals = {"u": np.full(samples, 8.0), "delta": np.zeros(samples)}
    trial = Trial("decay", "fit", period, signals, {})
    phi = respond(prepare(model, (), ("phi",)), trial, {}, {"phi": 0.5 * DEG}, False).y[:, 0]
    peak = np.flatnonzero((phi[1:-1] > phi[:-2]) & (phi[1:-1] >= phi[2:])) + 1
    decrement = np.log(phi[peak[1]] / phi[peak[4]]) / 3.0
    zeta = decrement / math.hypot(2.0 * math.pi, decrement)
    return float(np.diff(peak[1:5]).mean() * period * math.sqrt(1.0 - zeta**2)), float(zeta)


def test_roll_period_and_damping(naval: ShipModel) -> None:
    """5.50 s and .098 are printed with two rudders that straighten half of the flow."""
    period, zeta = roll_mode(straightened(naval, 0.5))
    assert period == pytest.approx(5.50, rel=0.01)
    assert zeta == pytest.approx(0.098, rel=0.02)


def test_the_bare_hull_rolls_as_long_with_less_damping(naval: ShipModel) -> None:
    period, zeta = roll_mode(naval)
    assert period == pytest.approx(5.50, rel=0.01)
    assert zeta == pytest.approx(0.0947, rel=0.02)


def test_a_turn_to_starboard(naval: ShipModel) -> None:
    """First inward, then outward heel; stable on its course."""
    samples = 3000
    signals = {"u": np.full(samples, 8.0), "delta": np.full(samples, 10.0 * DEG)}
    simulator = prepare(naval, (), ("r", "phi"))
    r, phi = respond(simulator, Trial("turn", "fit", 0.1, signals, {}), {}, {}, False).y.T
    assert r[-1] > 0.0
    assert phi.max() > 0.5 * DEG
    assert phi[-1] < -DEG
    assert abs(r[-1] - r[-300]) < 1e-4 * r[-1]
