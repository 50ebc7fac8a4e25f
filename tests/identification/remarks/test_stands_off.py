"""What stands off by the same in all trials is said: a heel, a gyro's zero, a delay."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.identification.remarks import remarks

SETTINGS = Settings(("Nv", "Ndelta", "Kp", "GM"), ("r", "phi"), nuisance=("initial_state", "bias"))


def trials(model, *of_each):
    """Zig-zags of 5, 10, ... deg, each with what its sensor adds [deg]."""
    made = []
    for k, off in enumerate(of_each):
        trial = zigzag((5, 10, 20)[k], model)
        noise = white(np.random.default_rng(90 + k), trial.samples)
        made.append(with_noise(trial, noise[0], noise[1] + np.deg2rad(off)))
    return made


def said(made, begins="the heel's zero"):
    return [x for x in remarks(identify(made, MODEL, SETTINGS)) if x.startswith(begins)]


@pytest.mark.parametrize("heel", [-1.5, 3.0])
def test_a_list_is_told(heel):
    lists = (MODEL + CATALOGUE["static_list"]).with_values({"a_0": 0.3 * np.deg2rad(heel)})
    [line] = said(trials(lists, 0.0, 0.0, 0.0))
    assert float(line.split(" deg")[0].split()[-1]) == pytest.approx(heel, abs=0.3)
    assert "a list or how the sensor is mounted" in line


@pytest.mark.parametrize("of_each", [(0.2, 0.2, 0.2), (2.0, -1.0, 0.5), (2.5,)])
def test_a_small_offset_one_that_changes_and_that_of_one_trial_are_the_sensors(of_each):
    assert said(trials(MODEL, *of_each)) == []


def test_the_same_trials_without_a_bias_say_nothing():
    made = trials(MODEL, 1.0, 1.0)
    held = replace(SETTINGS, nuisance=("initial_state",))
    assert not any("heel's zero" in x for x in remarks(identify(made, MODEL, held)))


def with_gyro(made, *of_each):
    """The same with what the gyro adds in each [deg/s]."""
    pairs = zip(made, of_each, strict=True)
    return [with_noise(t, np.deg2rad(off) + np.zeros(t.samples), 0.0) for t, off in pairs]


@pytest.mark.parametrize("off", [-0.15, 0.1])
def test_a_gyros_zero_is_told(off):
    [line] = said(with_gyro(trials(MODEL, 0.0, 0.0, 0.0), off, off, off), "the rate of turn reads")
    assert float(line.split(" deg/s")[0].split()[-1]) == pytest.approx(off, abs=0.03)


@pytest.mark.parametrize("of_each", [(0.02, 0.02, 0.02), (0.3, -0.1, 0.05)])
def test_a_small_one_and_one_that_changes_are_not(of_each):
    made = with_gyro(trials(MODEL, 0.0, 0.0, 0.0), *of_each)
    assert said(made, "the rate of turn reads") == []


@pytest.mark.parametrize(("of_each", "told"), [((3.0, 3.0, 3.0), True), ((1.0, 1.0, 1.0), False)])
def test_a_rate_that_is_late_in_all_trials_is_told(of_each, told):
    """She goes her length in 24 s."""
    late = []
    for off, made in zip(of_each, trials(MODEL, 0.0, 0.0, 0.0), strict=True):
        r = np.roll(made.signals["r"], round(off / made.period))
        late.append(replace(made, signals={**made.signals, "r": r}))
    settings = replace(SETTINGS, nuisance=("initial_state", "bias", "delay"))
    lines = [x for x in remarks(identify(late, MODEL, settings)) if x.startswith("r is taken as")]
    assert bool(lines) is told
    for line in lines:
        assert float(line.split(" s late")[0].split()[-1]) == pytest.approx(3.0, abs=0.4)


def test_what_is_said_of_all_trials_is_not_said_of_each_again():
    """Of a boat with a side push of 3.7 deg it was cut off behind three lines of its trials."""
    made = []
    for k in range(3):
        trial = zigzag((5, 10, 20)[k], MODEL)
        turned = {**trial.signals, "delta": trial.signals["delta"] - np.deg2rad(4.0)}
        noise = white(np.random.default_rng(95 + k), trial.samples)
        made.append(with_noise(replace(trial, signals=turned), *noise))
    fit = identify(made, MODEL, replace(SETTINGS, nuisance=("initial_state", "rudder_offset")))
    assert sum(name.startswith("delta_0") for name in fit.contradicted) == 3
    lines = remarks(fit)
    assert sum("the rudder's zero is 4 deg in all trials" in line for line in lines) == 1
    assert not any(line.startswith("delta_0") for line in lines)
    assert any(x.startswith("delta_0") for x in remarks(identify(made[:1], MODEL, fit.settings)))


WINDY = (MODEL + CATALOGUE["steady_wind"]).with_values(
    {"F_N": 0.0, "F_E": 0.0, "x_wind": 0.08, "z_wind": 0.0, "k_wind": 0.0}
)


@pytest.mark.parametrize(("wind", "told"), [(1.0, True), (0.0, False)])
def test_a_rudders_zero_that_is_another_in_each_trial_is_told(wind, told):
    """A wind that nobody recorded, from another side in each."""
    made = []
    for k, heading in enumerate((0.0, 0.5 * np.pi, np.pi)):
        model = WINDY.with_values({"F_E": wind * 3e-4 * np.cos(heading)})
        trial = zigzag((5, 10, 20)[k], replace(model, states=(*model.states, "psi")))
        made.append(with_noise(trial, *white(np.random.default_rng(90 + k), trial.samples)))
    settings = replace(SETTINGS, nuisance=("initial_state", "bias", "rudder_offset"))
    lines = [x for x in remarks(identify(made, MODEL, settings)) if "another in each trial" in x]
    assert bool(lines) is told
    for line in lines:
        assert float(line.split(" deg (")[0].split()[-1]) == pytest.approx(0.8, abs=0.4)


def test_a_speed_below_zero_is_told():
    made = trials(MODEL, 0.0, 0.0)
    settings = replace(SETTINGS, free=("Ndelta",))
    for sign, told in ((-1.0, True), (1.0, False)):
        given = [with_u(t, np.full(t.samples, sign * 7.0)) for t in made]
        words = remarks(identify(given, replace(MODEL, states=("v", "p", "r", "phi")), settings))
        assert any("u is below zero in zigzag-5, zigzag-10: she goes" in x for x in words) is told


def with_u(trial, u):
    """The same with a recorded speed [m/s]."""
    valid = {**trial.valid, "u": np.ones(trial.samples, dtype=bool)}
    return replace(trial, signals={**trial.signals, "u": u}, valid=valid)
