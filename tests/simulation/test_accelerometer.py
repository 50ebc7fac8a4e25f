"""What accelerometers feel of a motion: its accelerations, the turn, and gravity in a heel."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from dual import simulate

from trialid.effects import CATALOGUE
from trialid.errors import EffectError
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.ship.effect import SENSORS
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FELT = ("a_x", "a_y")
START = {"u": 7.1, "v": 0.2, "p": 0.01, "r": -0.002, "phi": 0.05, "psi": 3.0, "x": 0.0, "y": 0.0}


def test_heeled_to_starboard_what_holds_it_up_points_to_port(s175q: Ship) -> None:
    """No force, no turn: gravity alone."""
    record = {"u": np.ones(3)}
    simulator = prepare(ShipModel(s175q, ("v", "p", "r", "phi")), (), ("a_y",))
    y = respond(simulator, Trial("still", "fit", 1.0, record, {}), {}, {"phi": 0.1}).y
    np.testing.assert_allclose(y, -s175q.particulars["g"] * np.sin(0.1))


def test_it_is_the_acceleration_by_differences_of_the_motion(
    everything: ShipModel, lively: Callable[..., Trial]
) -> None:
    outputs = ("u", "v", "r", "phi", *FELT)
    sensors = [e for e in everything.effects if set(e.forms) & set(SENSORS)]
    effects = tuple(e for e in everything.effects if e not in sensors)
    own = {n for e in sensors for n in e.parameters}
    values = {n: x for n, x in everything.values.items() if n not in own}
    model = replace(everything, effects=effects, values=values)
    period = 0.02
    y = respond(prepare(model, (), outputs), lively(500, period), {}, START).y
    u, v, r, phi, ahead, aside = y.T
    g = model.ship.particulars["g"]
    inner = slice(2, -2)
    drawn = np.gradient(u, period) - v * r
    np.testing.assert_allclose(ahead[inner], drawn[inner], atol=0.005 * np.std(drawn))
    drawn = np.gradient(v, period) + u * r - g * np.sin(phi)
    np.testing.assert_allclose(aside[inner], drawn[inner], atol=0.005 * np.std(drawn))


@pytest.mark.parametrize("engine", ["compiled", "numpy"])
def test_its_slopes_are_exact_by_everything(
    everything: ShipModel, lively: Callable[..., Trial], engine: str
) -> None:
    trial = lively(samples=40)
    simulator = prepare(everything, tuple(everything.parameters), FELT, engine, 1)
    values = {n: everything.value(n) for n in everything.parameters}
    response = respond(simulator, trial, values, START)
    names, y, dy = simulate(everything, trial, values, START, FELT, 1)
    order = [names.index(c) for c in simulator.columns]
    assert response.S is not None
    np.testing.assert_allclose(response.y, y, rtol=1e-11, atol=1e-11)
    size = np.maximum(np.abs(dy[:, :, order]).max(axis=0), 1e-12)
    assert np.max(np.abs(response.S - dy[:, :, order]) / size) < 1e-8


def test_a_ship_is_found_by_what_an_accelerometer_felt_of_her(s175q: Ship) -> None:
    """Rate of turn and acceleration, neither sway nor speed recorded; 1 cm/s^2 of noise."""
    effects = tuple(CATALOGUE[n] for n in ("linear_hull", "linear_rudder", "linear_roll"))
    model = ShipModel(s175q, ("v", "p", "r", "phi"), effects)
    t = np.arange(0.0, 600.0)
    delta = np.deg2rad(10.0) * np.sign(np.sin(2.0 * np.pi * t / 150.0))
    record = {"delta": delta, "u": np.full(len(t), 7.0)}
    true = respond(prepare(model, (), ("r", "a_y")), Trial("", "fit", 1.0, record, {}), {}, {}).y
    rng = np.random.default_rng(4)
    noisy = true + rng.normal(size=true.shape) * [1e-4, 0.01]
    signals = {**record, "r": noisy[:, 0], "a_y": noisy[:, 1]}
    whole = {n: np.ones(len(t), dtype=bool) for n in signals}
    trial = Trial("zigzag", "fit", 1.0, signals, whole)
    free = ("Yv", "Yr", "Nv", "Nr", "Ydelta", "Ndelta")
    off = model.with_values({n: 1.2 * model.value(n) for n in free})
    fit = identify([trial], off, Settings(free, ("r", "a_y")))
    assert fit.converged
    for name in ("Nv", "Nr", "Ndelta", "Ydelta"):
        assert fit.value(name) == pytest.approx(model.value(name), rel=0.05), name


def test_without_heel_it_is_not_known(s175q: Ship) -> None:
    with pytest.raises(EffectError, match=r"'a_y' is not simulated.*gravity in a heel"):
        prepare(ShipModel(s175q, ("v", "r")), (), ("a_y",))
