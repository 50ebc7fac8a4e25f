"""Where the ship is: the track of a motion, and what a current makes of its record."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from dual import simulate

from trialid.effects import CATALOGUE
from trialid.effects.track import current
from trialid.errors import NotIdentifiable
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

WATER = {"V_cn": -0.7, "V_ce": 0.4}
GROUND = ("x", "y", "x_dot", "y_dot", "sog", "cog")
START = {"u": 7.1, "v": 0.2, "p": 0.01, "r": -0.002, "phi": 0.05, "psi": 3.0, "x": 2.0, "y": -1.0}


@pytest.fixture
def drifting(everything: ShipModel) -> ShipModel:
    return (everything + current).with_values(WATER)


def circled(s175q: Ship, turns: float, current_of: dict[str, float]) -> np.ndarray:
    """A point that goes round at 6 m/s and 1 deg/s, nothing of it simulated but the place."""
    model = (ShipModel(s175q, ("x", "y")) + current).with_values(current_of)
    t = np.arange(0.0, 360.0 * turns + 0.5)
    rate = np.deg2rad(1.0)
    signals = {"u": np.full(len(t), 6.0), "v": np.zeros(len(t)), "psi": rate * t}
    trial = Trial("circle", "fit", 1.0, signals, {})
    simulator = prepare(model, (), GROUND)
    return respond(simulator, trial, {}, {}, sensitivities=False).y


def test_a_circle_closes_to_starboard_and_has_its_radius(s175q: Ship) -> None:
    radius = 6.0 / np.deg2rad(1.0)
    y = circled(s175q, 1.0, {"V_cn": 0.0, "V_ce": 0.0})
    np.testing.assert_allclose(y[180, :2], [0.0, 2.0 * radius], atol=1e-3)  # east of the start
    np.testing.assert_allclose(y[90, :2], [radius, radius], atol=1e-3)  # ahead is north
    np.testing.assert_allclose(y[-1, :2], 0.0, atol=1e-3)


def test_a_current_carries_the_circle_along(s175q: Ship) -> None:
    y = circled(s175q, 1.0, WATER)
    np.testing.assert_allclose(y[-1, :2], [360.0 * -0.7, 360.0 * 0.4], atol=1e-3)


def test_speed_and_course_over_ground_are_those_of_the_track(s175q: Ship) -> None:
    """By differences of the positions, which share nothing with them; two turns, no jump."""
    y = circled(s175q, 2.0, WATER)
    north, east = np.gradient(y[:, 0]), np.gradient(y[:, 1])
    inner = slice(1, -1)
    np.testing.assert_allclose(y[inner, 2], north[inner], atol=1e-3)
    np.testing.assert_allclose(y[inner, 4], np.hypot(north, east)[inner], atol=1e-3)
    course = np.unwrap(np.arctan2(east, north))
    np.testing.assert_allclose(y[inner, 5], course[inner], atol=1e-3)
    assert y[-1, 5] > 4.0 * np.pi - 0.1


@pytest.mark.parametrize("engine", ["compiled", "numpy"])
def test_the_track_has_exact_slopes_by_everything_the_current_too(
    drifting: ShipModel, lively: Callable[..., Trial], engine: str
) -> None:
    trial = lively(samples=40)
    simulator = prepare(drifting, tuple(drifting.parameters), GROUND, engine, 1)
    values = {n: drifting.value(n) for n in drifting.parameters}
    response = respond(simulator, trial, values, START)
    names, y, dy = simulate(drifting, trial, values, START, GROUND, 1)
    order = [names.index(c) for c in simulator.columns]
    assert response.S is not None
    np.testing.assert_allclose(response.y, y, rtol=1e-11, atol=1e-11)
    size = np.maximum(np.abs(dy[:, :, order]).max(axis=0), 1e-12)
    assert np.max(np.abs(response.S - dy[:, :, order]) / size) < 1e-8
    column = simulator.columns.index("V_ce")
    np.testing.assert_allclose(response.S[:, 1, column], trial.t, atol=1e-9)


def test_a_ship_mirrored_sails_the_mirrored_track(s175q: Ship) -> None:
    """Port for starboard: the same north, the opposite east."""
    effects = tuple(CATALOGUE[n] for n in ("linear_hull", "linear_rudder"))
    model = ShipModel(s175q, ("v", "r", "psi", "x", "y"), effects)
    t = np.arange(0.0, 200.0)
    simulator = prepare(model, (), ("x", "y"))
    tracks = []
    for side in (1.0, -1.0):
        signals = {"delta": np.full(len(t), side * 0.1), "u": np.full(len(t), 7.0)}
        trial = Trial("turn", "fit", 1.0, signals, {})
        tracks.append(respond(simulator, trial, {}, {}, sensitivities=False).y)
    np.testing.assert_allclose(tracks[0][:, 0], tracks[1][:, 0], rtol=1e-12)
    np.testing.assert_allclose(tracks[0][:, 1], -tracks[1][:, 1], rtol=1e-12)
    assert tracks[0][-1, 1] > 100.0  # a rudder that is positive turns her to starboard: east


def test_a_track_without_sway_or_heading_is_refused(
    s175q: Ship, lively: Callable[..., Trial]
) -> None:
    model = ShipModel(s175q, ("x", "y"))
    trial = lively()
    signals = {n: x for n, x in trial.signals.items() if n != "v"}
    with pytest.raises(NotIdentifiable, match="no signal 'v'"):
        respond(prepare(model, (), ("x",)), replace(trial, signals=signals), {}, {})
