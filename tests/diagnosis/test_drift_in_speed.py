"""A speed over ground read as one: drift and current in it are no forces of the ship."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, white, zigzag

from trialid.diagnosis.records.unrecorded import name_records
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.errors import NotIdentifiable
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


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [31, 32])
def test_in_still_water_drift_is_read_out_of_it(seed):
    """Read as the speed ahead her drift counts twice, and her coefficients take it up."""
    plain, read = (found(model, seed, 0.0) for model in (PLAIN, READ))
    assert read.verdict.kind != "missing"
    assert read.fit.eps_rmsn < plain.fit.eps_rmsn
    for name, twice in (("Nv", -0.05), ("Nr", -0.035), ("Ndelta", -0.02)):
        counted, right = (one.fit.value(name) / MODEL.value(name) - 1.0 for one in (plain, read))
        assert counted < 0.8 * twice
        assert abs(right) < 0.4 * abs(twice)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [41, 42])
def test_a_current_has_its_name(seed):
    assert found(READ, seed, 0.8).verdict.effect == "current_in_speed_record"


WATER = replace(SETTINGS, nuisance=("initial_state", "current"))


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [61, pytest.param(62, marks=pytest.mark.study(turn="each"))])
@pytest.mark.parametrize("current", [0.0, 0.8])
def test_a_current_that_is_looked_for_is_found_and_leaves_the_ship_alone(seed, current):
    """It is none of hers and has no name, and her coefficients are what they are."""
    trials = [over_ground(a, seed + a, current) for a in (5, 10, 20)]
    trials.append(over_ground(10, seed, current, "check"))
    fit = identify(trials, READ, WATER)
    north, east = (fit.estimates[n] for n in ("Uc_N", "Uc_E"))
    assert (north, east) == pytest.approx((current, 0.0), abs=0.08)
    assert "current_in_speed_record" not in {e.name for e in fit.model.effects}
    for name in ("Nv", "Nr", "Ndelta"):
        assert fit.value(name) == pytest.approx(MODEL.value(name), rel=0.04)
    done = diagnose(fit)
    words = re.compile(
        r"the fit reads a current of 0\.[78]\d* \+-0\.\d+ m/s to (00|35)\d \+-\d+ deg out of"
    )
    assert any(words.match(said) for said in done.result.fit.remarks) is (current > 0.0)
    assert done.verdict.effect != "current_in_speed_record"
    assert "current_in_speed_record" not in {*done.ranking["effect"]}
    assert {"Uc_N", "Uc_E"}.isdisjoint(row.name for row in done.result.physical)


def test_a_current_that_no_record_shows_is_refused():
    with pytest.raises(NotIdentifiable, match="read a speed over ground by the effect"):
        identify([over_ground(10, 51)], PLAIN, WATER)


def test_a_current_is_held_by_what_water_does():
    """A zig-zag of 5 deg tells it to a few tenths; the rest is drawn to still water."""
    for seed in (51, 71, 72):
        held, loose = (
            identify([over_ground(5, seed)], READ, replace(WATER, hold_nuisance=held))
            for held in (True, False)
        )
        off = [np.hypot(fit.estimates["Uc_N"], fit.estimates["Uc_E"]) for fit in (held, loose)]
        assert off[0] < off[1] < 0.5
        priors = {x.name: x.prior for x in held.problem.unknowns}
        assert priors["Uc_N"] == priors["Uc_E"] == (0.0, 1.0)


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
        problem = SimpleNamespace(trials=(zigzag(10),), simulator=SimpleNamespace(model=model))
        fit = SimpleNamespace(model=model, trials=problem.trials, problem=problem)
        sentence = name_records(fit, named, [CATALOGUE["steady_wind"], current]).sentence
        assert ("the speed is over ground, and a current in it" in sentence) is said
    for model, doubted in ((PLAIN, True), (READ, False)):
        fit.model = problem.simulator.model = model
        told = name_records(fit, replace(named, effect=current.name), [current]).sentence
        assert ("a wind that nobody recorded may look like it" in told) is doubted
    other = replace(named, effect="yaw_drag_rar")
    fit.model = problem.simulator.model = READ
    assert "over ground" not in name_records(fit, other, [CATALOGUE["yaw_drag_rar"]]).sentence
