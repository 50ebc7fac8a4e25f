"""A trial held out whose rudder stood otherwise, or whose gyro did: told whatever is missing."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag

from trialid.identification.check.own_sensor import own_sensors
from trialid.identification.fit import identify
from trialid.identification.remarks import remarks

OFFSET = replace(SETTINGS, nuisance=("initial_state", "bias", "rudder_offset"))
LACKING = MODEL - "yaw_drag_rar"
FEWER = replace(OFFSET, free=tuple(n for n in OFFSET.free if n != "Nrar"))


def fitted(seed, rudder=0.0, rate=0.0, model=MODEL, asked=OFFSET):
    """Zig-zags; in the one held out the rudder is at so much more than is recorded [rad]."""
    rng, trials = np.random.default_rng(seed), []
    for angle, use in ((5, "fit"), (20, "fit"), (10, "check")):
        r, phi = white(rng, zigzag(angle).samples)
        made = with_noise(zigzag(angle, use=use), r + rate * (use == "check"), phi)
        delta = made.signals["delta"] - rudder * (use == "check")
        trials.append(replace(made, signals={**made.signals, "delta": delta}))
    return identify(trials, model, asked)


@pytest.mark.parametrize("model", [MODEL, LACKING], ids=["whole", "lacking"])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_rudder_that_stands_two_degrees_off_is_told_with_its_side(model, side):
    off = side * np.deg2rad(2.0)
    asked = OFFSET if model is MODEL else FEWER
    (words,) = own_sensors(fitted(31, off, model=model, asked=asked))
    name, _, rest = words.partition(": ")
    assert name == f"{zigzag(10).name}, held out"
    assert rest.startswith("delta_0 of its own, ")
    told = float(rest.split()[4])
    assert told == pytest.approx(2.0 * side, abs=0.4)
    assert words in remarks(fitted(31, off, model=model, asked=asked))


def test_a_gyro_that_is_off_is_told_as_that():
    (words,) = own_sensors(fitted(32, rate=np.deg2rad(0.3)))
    assert "b_r of its own, 0.3" in words


@pytest.mark.parametrize(
    "seed", [40, *(pytest.param(s, marks=pytest.mark.study(turn="each")) for s in range(41, 44))]
)
def test_of_noise_and_of_what_the_model_lacks_in_all_trials_nothing_is_told(seed):
    assert own_sensors(fitted(seed)) == []
    assert own_sensors(fitted(seed, model=LACKING, asked=FEWER)) == []


def test_without_a_zero_in_the_fit_there_is_none_to_tell_of():
    assert own_sensors(fitted(33, np.deg2rad(2.0), asked=SETTINGS)) == []


@pytest.mark.parametrize("unlike", [5, 20])
def test_a_fitted_trial_that_is_unlike_the_rest_has_the_blame(unlike):
    """An outsider's heel stood 3 deg off in one of those that were fitted."""
    rng, trials = np.random.default_rng(34), []
    for angle, use in ((5, "fit"), (20, "fit"), (10, "check")):
        r, phi = white(rng, zigzag(angle).samples)
        off = np.deg2rad(3.0) * (angle == unlike)
        trials.append(with_noise(zigzag(angle, use=use), r, phi + off))
    (words,) = own_sensors(identify(trials, MODEL, OFFSET))
    assert words.startswith(f"{zigzag(10).name}, held out: b_phi of its own, -")
    assert f"apart themselves, that of {zigzag(unlike).name} furthest from all the rest" in words
