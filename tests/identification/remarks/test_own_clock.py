"""A trial whose clock is off: the delay that takes it up is told."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import s175q

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.effects import CATALOGUE
from trialid.identification.check.own_clock import APART, own_clocks
from trialid.identification.fit import identify

SETTINGS = replace(
    s175q.SETTINGS, free=("Nv", "Nr", "Ndelta", "Kdelta"), nuisance=("initial_state", "delay")
)
SOONER = ["in zigzag-10 r comes 1.9 s sooner", "in zigzag-10 phi comes 2 s sooner"]


def fitted(late, n=3):
    """Zig-zags; the rudder of the one by 10 deg is logged so much late [s]."""
    rng, made = np.random.default_rng(31), []
    for angle in (20, 10, 5)[:n]:
        trial = s175q.zigzag(angle)
        trial = s175q.with_noise(trial, *(0.3 * x for x in s175q.white(rng, trial.samples)))
        if angle == 10:
            delta = np.interp(trial.t - late, trial.t, trial.signals["delta"])
            trial = replace(trial, signals={**trial.signals, "delta": delta})
        made.append(trial)
    return identify(made, s175q.MODEL, SETTINGS)


def known(fit, error):
    """The accuracy of all delays."""
    rows = [SimpleNamespace(name=n, standard_error=error) for n in fit.estimates]
    return SimpleNamespace(parameters=rows)


@pytest.fixture(scope="module")
def late():
    return fitted(2.0)


def test_a_rudder_that_is_late_in_one_trial_is_told_by_all_that_it_moves(late):
    said = own_clocks(late, known(late, 0.1))
    assert [words.split(" after")[0] for words in said] == SOONER


def test_it_is_told_by_the_accuracy_of_a_run(late):
    asked = DiagnoseSettings(candidates={"lag_r": CATALOGUE["lag_r"]}, coefficients=False)
    said = own_clocks(late, diagnose(late, asked).before.own_accuracy)
    assert [words.split(" after")[0] for words in said] == SOONER


def test_so_is_one_that_is_early():
    fit = fitted(-2.0)
    said = own_clocks(fit, known(fit, 0.1))
    assert said[0].startswith(
        "in zigzag-10 r comes 2.1 s later after the rudder than in the others"
    )


@pytest.mark.parametrize("error", [2.1 / APART, np.inf])
def test_what_noise_may_have_done_is_not_said(late, error):
    assert own_clocks(late, known(late, error)) == ()


def test_nor_what_is_little_or_of_one_of_two():
    little, of_two = fitted(0.5), fitted(2.0, n=2)
    assert own_clocks(little, known(little, 0.01)) == ()
    assert own_clocks(of_two, known(of_two, 0.01)) == ()
