"""A speed over ground read as one: drift and current in it are no forces of the ship."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, white, zigzag

from trialid.diagnosis.unrecorded import name_records
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.simulation.integrate import prepare, respond
from trialid.workflow.notebook.front import diagnose

FREE = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
SETTINGS = Settings(FREE, ("r", "phi"), nuisance=("initial_state",))
SAILED = replace(MODEL, states=(*MODEL.states, "psi"))
AHEAD = {"propeller_thrust", "surge_resistance", "surge_turning", "surge_rudder"}
PLAIN = replace(
    MODEL, states=MODEL.states[1:], effects=tuple(e for e in MODEL.effects if e.name not in AHEAD)
)
READ = PLAIN + CATALOGUE["drift_in_speed_record"]


def over_ground(amplitude, seed, current=0.0, use="fit"):
    """A zig-zag logged with her heading and her speed over ground, in a current to the north."""
    trial = zigzag(amplitude, use=use)
    simulator = prepare(SAILED, (), ("r", "phi", "u", "v", "psi"))
    y = respond(simulator, trial, {}, {"u": 7.33, "psi": 0.5}, sensitivities=False).y
    r, phi, u, v, psi = y.T.copy()
    north = u * np.cos(psi) - v * np.sin(psi) + current
    east = u * np.sin(psi) + v * np.cos(psi)
    noise = white(np.random.default_rng(seed), trial.samples)
    logged = {"psi": psi, "u": np.hypot(north, east), "r": r + noise[0], "phi": phi + noise[1]}
    signals = {**trial.signals, **logged}
    valid = {name: np.ones(trial.samples, np.bool_) for name in signals}
    return replace(trial, signals=signals, valid=valid)


def found(model, seed, current):
    trials = [over_ground(a, seed + a, current) for a in (5, 10, 20)]
    trials.append(over_ground(10, seed, current, "check"))
    return diagnose(identify(trials, model, SETTINGS))


@pytest.mark.parametrize("seed", [31, pytest.param(32, marks=pytest.mark.study(turn="each"))])
def test_in_still_water_drift_is_read_out_of_it(seed):
    """Read as the speed ahead her drift counts twice, and her coefficients take it up."""
    plain, read = (found(model, seed, 0.0) for model in (PLAIN, READ))
    assert read.verdict.kind != "missing"
    assert read.fit.eps_rmsn < plain.fit.eps_rmsn
    for name, twice in (("Nv", -0.05), ("Nr", -0.035), ("Ndelta", -0.02)):
        counted, right = (one.fit.value(name) / MODEL.value(name) - 1.0 for one in (plain, read))
        assert counted < 0.8 * twice
        assert abs(right) < 0.4 * abs(twice)


@pytest.mark.parametrize("seed", [41, pytest.param(42, marks=pytest.mark.study(turn="each"))])
def test_a_current_has_its_name(seed):
    assert found(READ, seed, 0.8).verdict.effect == "current_in_speed_record"


def test_a_record_that_begins_at_rest_is_fitted():
    """Of no speed there is no drift, and the slopes are numbers."""
    trial = over_ground(10, 51)
    speed = np.where(trial.t < 20.0, 0.0, trial.signals["u"])
    rested = replace(trial, signals={**trial.signals, "u": speed})
    fit = identify([rested], READ, SETTINGS)
    assert fit.converged
    assert fit.value("Ndelta") == pytest.approx(MODEL.value("Ndelta"), rel=0.1)


def test_a_wind_that_nobody_recorded_may_be_the_current_in_a_speed_over_ground():
    named = Verdict("missing", "steady_wind", ("steady_wind",), "steady_wind is missing")
    current = CATALOGUE["current_in_speed_record"]
    for model, said in ((READ, True), (PLAIN, False), (READ + current, False)):
        fit = SimpleNamespace(
            model=model, trials=(zigzag(10),), problem=SimpleNamespace(trials=(zigzag(10),))
        )
        sentence = name_records(fit, named, [CATALOGUE["steady_wind"], current]).sentence
        assert ("the speed is over ground, and a current in it" in sentence) is said
    other = replace(named, effect="yaw_drag_rar")
    fit.model = READ
    assert "over ground" not in name_records(fit, other, [CATALOGUE["yaw_drag_rar"]]).sentence
