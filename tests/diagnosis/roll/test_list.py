"""A heel that is there in all trials may be hers: predictions have her upright, and it is said."""

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


def said(made):
    return [x for x in remarks(identify(made, MODEL, SETTINGS)) if x.startswith("the heel's zero")]


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
