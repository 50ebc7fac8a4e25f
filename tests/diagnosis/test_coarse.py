"""A long record examined by means of a few samples: the same answers, less time and room."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trialid import pipeline_file
from trialid.diagnosis.noise import thinning as module
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.noise.thinning import coarse
from trialid.diagnosis.search.score import rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit
from trialid.trial_rows import Stretch
from trialid.workflow import build_model, fit_model, read_trials

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def fit() -> Fit:
    """Three trials of 2399 samples, two a second, with a righting arm hidden in them."""
    asked = pipeline_file.load(ROOT / "pipelines" / "hidden_effect.toml")
    quiet = lambda words, share: None  # noqa: E731
    trials = read_trials.align_trials(asked, quiet)
    return fit_model.fit_of(asked, trials, build_model.available(asked), quiet)


def test_rows_of_several_samples_keep_slow_squares_and_the_variance_of_noise() -> None:
    rng = np.random.default_rng(0)
    compared = np.ones(2000, dtype=bool)
    part = Stretch(0, 0, slice(0, 2000), compared, every=5)
    slow = np.sin(np.linspace(0.0, 20.0, 10_003))
    assert np.sum(part.taken(slow) ** 2) == pytest.approx(np.sum(slow[:10_000] ** 2), rel=1e-3)
    noise = rng.standard_normal(10_003)
    assert np.var(part.taken(noise)) == pytest.approx(1.0, rel=0.1)
    assert part.taken(noise[:, None]).shape == (2000, 1)


def test_a_row_with_a_gap_in_it_is_left_out() -> None:
    compared = np.array([True, False, True])
    part = Stretch(0, 0, slice(0, 2), compared, every=2)
    assert part.taken(np.array([1.0, 3.0, 9.0, 9.0, 5.0, 7.0, 8.0])) == pytest.approx(
        np.array([4.0, 12.0]) / np.sqrt(2.0)
    )


def test_records_of_usual_length_are_examined_sample_by_sample(fit: Fit) -> None:
    assert coarse(fit) is fit


def test_a_long_record_gives_the_same_answers(fit: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    few = {n: CATALOGUE[n] for n in ("righting_arm_cubic", "heel_roll_cubic", "roll_damping_cubic",
                                     "yaw_drag_rav", "sway_drag_rar", "rudder_stall")
           if n in CATALOGUE}  # fmt: skip
    every, fine = rank(fit, few)
    monkeypatch.setattr(module, "LONGEST", 800)
    third, rough = rank(fit, few)
    assert rough.stretches[0].every == 3
    assert len(rough.S) == pytest.approx(len(fine.S) / 3, rel=0.01)
    assert third[0].effect.name == every[0].effect.name == "righting_arm_cubic"
    assert third[0].eps_predicted == pytest.approx(every[0].eps_predicted, rel=0.02)
    assert third[0].expected["GM3"] == pytest.approx(every[0].expected["GM3"], rel=0.05)
    parts = [split(fit, a, {}, {})[0].undermodelling for a in (fine, rough)]
    assert parts[1] == pytest.approx(parts[0], rel=0.05)


def test_means_never_hide_how_the_ship_moves(fit: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    """Roll of 25 s: means over 10 s would lose a third of it, whatever is asked for."""
    monkeypatch.setattr(module, "LONGEST", 120)
    assert 1 < coarse(fit).problem.every < 8


def test_a_fast_ship_is_examined_sample_by_sample(
    fit: Fit, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LONGEST", 800)
    rng = np.random.default_rng(1)
    fast = replace(fit, scores=tuple(
        replace(s, response=replace(s.response, y=rng.standard_normal(s.response.y.shape)))
        for s in fit.scores
    ))  # fmt: skip
    assert coarse(fast) is fast


def test_a_trial_in_which_an_output_rests_does_not_stand_in_the_way(
    fit: Fit, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LONGEST", 800)
    first, *others = fit.scores
    still = replace(first.response, y=first.response.y * np.array([1.0, 0.0]))
    resting = replace(fit, scores=(replace(first, response=still), *others))
    assert coarse(resting).problem.every == coarse(fit).problem.every == 3
