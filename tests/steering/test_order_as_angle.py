"""What is recorded of a rudder may be its order: it jumps, and nobody's gyro is late for that."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.diagnosis import objections
from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.records.rudder_jumps import Course, jump_of, own_time, rudder_jump
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

OWN_TIME = 20.0
"""[s] Of a ship of 160 m at 15 knots."""


def moved(rate: float, period: float, amplitude: float = 20.0, noise: float = 0.1) -> Course:
    """A rudder of a zig-zag, moved as fast as the rate [deg/s] and measured; in rad."""
    fine = np.arange(0.0, 400.0, 0.01)
    order = amplitude * np.sign(np.sin(2.0 * np.pi * (fine + 1.003) / 97.0))
    y, at = np.zeros(len(fine)), 0.0
    for k, wanted in enumerate(order):
        at += np.clip(wanted - at, -0.01 * rate, 0.01 * rate)
        y[k] = at
    every = round(period / 0.01)
    rng = np.random.default_rng(7)
    t, y = fine[::every], y[::every]
    return t, np.deg2rad(y + noise * rng.standard_normal(len(y)))


@pytest.mark.parametrize("amplitude", [10.0, 20.0, 35.0])
@pytest.mark.parametrize("period", [0.1, 0.5])
def test_an_order_jumps(period: float, amplitude: float) -> None:
    found = jump_of([moved(np.inf, period, amplitude)], OWN_TIME)
    assert found is not None
    assert np.rad2deg(found.size) == pytest.approx(2.0 * amplitude, rel=0.03)
    assert found.time == pytest.approx(period)
    assert str(found) == f"jumps by up to {2 * amplitude:.0f} deg within {period:g} s"


def test_so_does_that_of_a_small_boat() -> None:
    """She goes her length in 1.5 s; her gear takes 12 deg/s."""
    for rate, jumps in ((np.inf, True), (12.0, False)):
        found = jump_of([moved(rate, 0.1, amplitude=8.0)], 1.5)
        assert (found is not None) is jumps


@pytest.mark.parametrize("rate", [2.3, 7.0])
@pytest.mark.parametrize("period", [0.1, 0.5, 2.0, 10.0])
@pytest.mark.parametrize("noise", [0.0, 0.1, 0.5])
def test_a_rudder_that_a_gear_moves_does_not(rate: float, period: float, noise: float) -> None:
    """Nor where it is there by the next sample because that is ten seconds later."""
    assert jump_of([moved(rate, period, noise=noise)], OWN_TIME) is None


def test_a_few_wild_samples_are_no_order() -> None:
    t, y = moved(2.3, 0.5)
    y[[100, 300, 500]] += np.deg2rad(30.0)
    assert jump_of([(t, y)], OWN_TIME) is None


def test_all_trials_count_together() -> None:
    """Orders beside two trials whose angles are logged; where nothing moves, nothing jumps."""
    still = (np.arange(10.0), np.zeros(10))
    assert jump_of([still], OWN_TIME) is None
    assert jump_of([], OWN_TIME) is None
    order, angle = moved(np.inf, 0.5), moved(2.3, 0.5)
    assert jump_of([order, order, still], OWN_TIME) is not None
    assert jump_of([order, angle, angle], OWN_TIME) is None


def recorded_orders(T: float) -> list[Trial]:
    """Zig-zags whose gear lags by T [s], and of whose rudder the order is recorded as its angle."""
    rng = np.random.default_rng(77)
    model = (s175q.MODEL + CATALOGUE["rudder_servo"]).with_values({"T_delta": T})
    trials = []
    for amplitude in (5, 10, 20):
        bare = s175q.zigzag(amplitude)
        n = len(bare.signals["delta"])
        steps = np.deg2rad(amplitude) * np.sign(np.round(bare.signals["delta"], 3))
        orders = {**bare.signals, "delta_order": steps}
        valid = {name: np.ones(n, dtype=bool) for name in orders}
        blank = replace(bare, signals=orders, valid=valid)
        simulator = prepare(model, (), s175q.OUTPUTS)
        y = respond(simulator, blank, {}, {"u": 7.33}, sensitivities=False).y
        signals = {**bare.signals, "delta": steps, "r": y[:, 0].copy(), "phi": y[:, 1].copy()}
        trials.append(s175q.with_noise(replace(bare, signals=signals), *s175q.white(rng, n)))
    return trials


def named(fit: Fit) -> str | None:
    return diagnose(fit).verdict.effect


@pytest.mark.study(turn=0)
@pytest.mark.parametrize("T", [3.0, 6.0])
def test_no_sensor_is_late_where_the_rudder_jumps(T: float) -> None:
    """The gear is: its nearest among what can be tried is a record of the rudder that is late."""
    fit = identify(recorded_orders(T), s175q.MODEL, s175q.SETTINGS)
    assert rudder_jump(fit.trials, own_time(fit)) is not None
    assert named(fit) == "rudder_record_delay"


@pytest.mark.study(turn=0)
def test_where_nobody_looks_at_the_rudder_a_sensor_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(objections, "jump_in", lambda *_: None)
    assert named(identify(recorded_orders(6.0), s175q.MODEL, s175q.SETTINGS)) == "lag_phi"


@pytest.mark.study(turn=0)
def test_where_nothing_else_is_tried_nobody_can_tell() -> None:
    sensors = {n: CATALOGUE[n] for n in ("lag_r", "lag_phi", "delay_r", "delay_phi")}
    fit = identify(recorded_orders(6.0), s175q.MODEL, s175q.SETTINGS)
    found = diagnose(fit, DiagnoseSettings(candidates=sensors, coefficients=False)).verdict
    assert (found.kind, found.effect) == ("cannot tell", None)
    assert "but the recorded rudder jumps as an order does, and a gear is as late" in found.sentence
    assert found.sentence.endswith("where it is the order, call it delta_order")
