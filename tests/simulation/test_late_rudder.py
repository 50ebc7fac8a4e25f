"""A rudder that acts later than it is recorded: by a time, or by a clock that runs on."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.diagnosis.search.score import rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.simulation.integrate import prepare, respond

DRIFTING = MODEL + CATALOGUE["clock_drift_delta"]
DRIFTS = (0.02, -0.02, 0.004)
FREE = ("Nv", "Nr", "Ndelta", "Kdelta", "Kp", "GM")
SETTINGS = Settings(FREE, ("r", "phi"), nuisance=("initial_state", "bias", "delay"))


def recorded(trial, drift):
    """The trial with its rudder on a clock that makes so much less of every second."""
    delta = np.interp(trial.t / (1.0 - drift), trial.t, trial.signals["delta"])
    return replace(trial, signals={**trial.signals, "delta": delta})


def answer(model, trial, drift):
    simulator = prepare(model, ("drift_delta",) if model is DRIFTING else ("Nv",), ("r", "phi"))
    return simulator, respond(simulator, trial, {"drift_delta": drift, "Nv": MODEL.value("Nv")}, {})


@pytest.mark.parametrize("drift", DRIFTS)
def test_her_answer_is_that_to_the_rudder_as_it_was_laid(drift):
    """To the end of 20 minutes, when two per cent are 24 s; only by the slope it was half of it."""
    trial = zigzag(10)
    rows = slice(0, int((1.0 - abs(drift)) * trial.samples))  # what lies beyond is not recorded
    _, laid = answer(MODEL, trial, drift)
    _, late = answer(DRIFTING, recorded(trial, drift), drift)
    _, early = answer(MODEL, recorded(trial, drift), drift)
    size = np.std(laid.y[rows], axis=0)
    assert np.all(np.std(late.y[rows] - laid.y[rows], axis=0) < 0.005 * size)
    assert np.all(np.std(early.y[rows] - laid.y[rows], axis=0) > 0.05 * size)


@pytest.mark.parametrize("drift", DRIFTS)
def test_its_slopes_are_its_differences(drift):
    trial = recorded(zigzag(10), drift)
    step = 1e-6
    there, back = (answer(DRIFTING, trial, drift + s * step)[1].y for s in (1, -1))
    simulator, found = answer(DRIFTING, trial, drift)
    S = found.S[:, :, simulator.columns.index("drift_delta")]
    expected = (there - back) / (2.0 * step)
    np.testing.assert_allclose(S, expected, atol=2e-3 * np.abs(expected).max())


GEARS = (
    {"rudder_backlash": {"b_play": 0.03, "T_play": 0.5}},
    {"rudder_deadband": {"b_dead": 0.03}},
)


@pytest.mark.parametrize("gear", GEARS)
@pytest.mark.parametrize(
    ("late", "values"),
    [("rudder_record_delay", {"tau_delta": 2.0}), ("clock_drift_delta", {"drift_delta": 0.02})],
)
def test_what_comes_late_comes_so_to_a_gear_with_play(gear, late, values):
    """Beside a play the blade did not move at all, and an outsider's error was to fall to 0 %."""
    trial, known = zigzag(10), {n: x for given in gear.values() for n, x in given.items()}
    played = MODEL
    for name in gear:
        played = (played + CATALOGUE[name]).with_values(known)

    def sailed(model, record):
        return respond(
            prepare(model, ("Nv",), ("r", "phi")), record, {"Nv": MODEL.value("Nv")}, {}
        ).y

    absent = (played + CATALOGUE[late]).with_values(dict.fromkeys(values, 0.0))
    plain = sailed(played, trial)
    np.testing.assert_allclose(sailed(absent, trial), plain, atol=1e-12)
    lag = values.get("tau_delta", 0.0) + values.get("drift_delta", 0.0) * trial.t
    laid = np.interp(trial.t - lag, trial.t, trial.signals["delta"])
    there = sailed((played + CATALOGUE[late]).with_values(values), trial)
    shifted = sailed(played, replace(trial, signals={**trial.signals, "delta": laid}))
    size = np.std(plain, axis=0)
    assert np.all(np.std(there - shifted, axis=0) < 0.01 * size)
    assert np.all(np.std(there - plain, axis=0) > 0.03 * size)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [71, 72])
@pytest.mark.parametrize("drift", [0.02, -0.02])
def test_a_clock_that_runs_two_per_cent_fast_comes_first(drift, seed):
    """An outsider's gyro did so beside his rudder, and his hull was said to lack one of twelve."""
    made = []
    for angle in (5, 10, 20):
        trial = zigzag(angle)
        noise = white(np.random.default_rng(seed + angle), trial.samples)
        made.append(recorded(with_noise(trial, *noise), drift))
    first, *_ = rank(identify(made, MODEL, SETTINGS), CATALOGUE)[0]
    assert first.effect.name == "clock_drift_delta"
    assert first.worth_a_name(0.05)
    assert 0.5 < first.expected["drift_delta"] / drift < 1.5
