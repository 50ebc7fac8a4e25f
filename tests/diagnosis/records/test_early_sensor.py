"""A sensor that is taken to be early: the model without delays stands beside the one with them."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, with_noise, zigzag

from trialid.accuracy.ranges import IN_TIME
from trialid.diagnosis.diagnosed import examination
from trialid.diagnosis.records.early_sensor import beside_in_time
from trialid.diagnosis.search.augment import augment
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.remarks import in_all_trials, remarks
from trialid.workflow.use import kept_models

FREE = ("Nv", "Nr", "Ndelta")


def shifted(angle, late):
    """A zig-zag whose rate of turn comes so late [s], in a little noise."""
    trial = zigzag(angle)
    rng = np.random.default_rng([angle, 3])
    t = trial.t
    r = np.interp(t - late, t, trial.signals["r"]) - trial.signals["r"]
    return with_noise(trial, r + 1e-4 * rng.standard_normal(len(t)), 0.0)


def fitted(late):
    settings = replace(SETTINGS, free=FREE, nuisance=("initial_state", "delay"))
    return identify([shifted(angle, late) for angle in (10, 20)], MODEL, settings)


def test_beside_a_gyro_that_is_early_stands_the_model_without_delays():
    fit = fitted(-1.5)
    assert in_all_trials(fit)["r"] == pytest.approx(-1.5, abs=0.2)
    [said] = [line for line in remarks(fit) if line.startswith("r is taken as")]
    assert said.startswith("r is taken as 1.5 s early in all trials, which no sensor is")
    [other] = beside_in_time(fit, lambda found: found)
    assert not [x.name for x in other.problem.unknowns if x.name.startswith("tau_")]
    assert abs(other.value("Nv") - fit.value("Nv")) > 0.05 * abs(fit.value("Nv"))


@pytest.mark.parametrize("late", [0.0, 1.5])
def test_a_sensor_that_is_in_time_or_late_stands_for_itself(late):
    assert beside_in_time(fitted(late), lambda found: found) == ()


def test_a_finished_run_takes_the_model_without_delays_up_again():
    fit = fitted(-1.5)
    done = examination(fit, augment(fit, {}))
    [(what, other)] = [one for one in done.others if one[0] == IN_TIME]
    kept = kept_models.kept_model(
        kept_models.about_model(what, other), kept_models.arrays_of(other), CATALOGUE
    )
    again = kept.beside(fit, CATALOGUE)
    assert [x.name for x in again.fit.problem.unknowns] == [
        x.name for x in other.fit.problem.unknowns
    ]
    assert again.fit.estimates == pytest.approx(other.fit.estimates)
