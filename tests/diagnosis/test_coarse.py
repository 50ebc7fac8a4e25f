"""A long record examined by means of a few samples: the same answers, less time and room."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trialid import pipeline_file
from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.noise import thinning as module
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.noise.thinning import mean_trial, samples_together, with_means
from trialid.diagnosis.search.score import rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit
from trialid.trial import Trial
from trialid.workflow import build_model, fit_model, read_trials

ROOT = Path(__file__).parents[2]
PERIOD = 0.5
"""Of the shipped records [s]."""
FEW = ("righting_arm_cubic", "heel_roll_cubic", "yaw_drag_rav", "sway_drag_rar", "rudder_stall")


@pytest.fixture(scope="module")
def fit() -> Fit:
    """Three trials of 2399 samples, two a second, with a righting arm hidden in them."""
    asked = pipeline_file.load(ROOT / "pipelines" / "hidden_effect.toml")
    quiet = lambda words, share: None  # noqa: E731
    trials = read_trials.align_trials(asked, quiet)
    return fit_model.fit_of(asked, trials, build_model.available(asked), quiet)


def test_means_are_of_whole_blocks_that_were_measured_and_of_angles_put_together() -> None:
    course = np.deg2rad([170.0, 178.0, -174.0, -166.0, 1.0])
    seen = np.array([True, True, True, False, True])
    signals = {"r": np.array([1.0, 3.0, 9.0, 9.0, 5.0]), "psi": course}
    trial = Trial("t", "fit", 0.5, signals, {"r": seen, "psi": np.ones(5, dtype=bool)})
    found = mean_trial(trial, 2)
    assert (found.period, found.samples) == (1.0, 2)
    assert found.signals["r"] == pytest.approx([2.0, 9.0])
    assert found.signals["psi"] == pytest.approx(np.deg2rad([174.0, 190.0]))
    assert found.valid["r"].tolist() == [True, False]


def test_records_of_usual_length_are_examined_sample_by_sample(fit: Fit) -> None:
    assert with_means(fit) is fit


def test_a_long_record_gives_the_same_answers(fit: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    few = {n: CATALOGUE[n] for n in FEW}
    every, fine = rank(fit, few)
    monkeypatch.setattr(module, "LONGEST", 800)
    third, rough = rank(fit, few)
    assert rough.fit.problem.trials[0].period == 3.0 * fit.problem.trials[0].period
    assert len(rough.S) == pytest.approx(len(fine.S) / 3, rel=0.01)
    assert third[0].effect.name == every[0].effect.name == "righting_arm_cubic"
    assert third[0].eps_predicted == pytest.approx(every[0].eps_predicted, rel=0.02)
    assert third[0].expected["GM3"] == pytest.approx(every[0].expected["GM3"], rel=0.05)
    parts = [split(fit, a, {}, {})[0].undermodelling for a in (fine, rough)]
    assert parts[1] == pytest.approx(parts[0], rel=0.05)


def test_means_never_hide_how_the_ship_moves(fit: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    """Roll of 25 s: means over 10 s would lose a third of it, whatever is asked for."""
    monkeypatch.setattr(module, "LONGEST", 120)
    assert 1 < samples_together(fit) < 8


def test_a_fast_ship_is_examined_sample_by_sample(
    fit: Fit, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LONGEST", 800)
    rng = np.random.default_rng(1)
    fast = replace(fit, scores=tuple(
        replace(s, response=replace(s.response, y=rng.standard_normal(s.response.y.shape)))
        for s in fit.scores
    ))  # fmt: skip
    assert samples_together(fast) == 1


def test_a_trial_in_which_an_output_rests_does_not_stand_in_the_way(
    fit: Fit, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LONGEST", 800)
    first, *others = fit.scores
    still = replace(first.response, y=first.response.y * np.array([1.0, 0.0]))
    resting = replace(fit, scores=(replace(first, response=still), *others))
    assert samples_together(resting) == samples_together(fit) == 3


@pytest.mark.study(turn="each")
def test_what_is_tried_is_fitted_to_means_and_its_error_is_that_of_every_sample(
    fit: Fit, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = DiagnoseSettings(candidates={n: CATALOGUE[n] for n in FEW}, coefficients=False)
    whole = diagnose(fit, asked)
    monkeypatch.setattr(module, "LONGEST", 800)
    short = diagnose(fit, asked)
    assert short.verdict.effect == whole.verdict.effect == "righting_arm_cubic"
    assert whole.after is not None
    assert short.after is not None
    one, other = whole.after.fit, short.after.fit
    assert other.by_means is not None
    assert other.by_means.trials[0].period == 3.0 * other.trials[0].period == 3.0 * PERIOD
    assert len(other.residual) == len(one.residual)
    assert other.eps_rmsn == pytest.approx(one.eps_rmsn, rel=5e-3)
    assert other.eps_rmsn >= one.eps_rmsn * (1.0 - 1e-9)  # the least is on every sample
    assert other.value("GM3") == pytest.approx(one.value("GM3"), rel=0.02)
    pairs = zip(whole.before.accuracy.physical, short.before.accuracy.physical, strict=True)
    for fine, rough in pairs:  # by how many lags each counts; of 100 000 samples 3 % at most
        assert rough.value == fine.value
        assert rough.standard_error == pytest.approx(fine.standard_error, rel=0.2)
