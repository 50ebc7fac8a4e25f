"""Trials held out against `nothing missing`: what noise leaves there is known, and no more is."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import GYRO, INCLINOMETER, MODEL, SETTINGS, waves, white, with_noise, zigzag

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.diagnosis.left_by_check import left_by_check, with_held_out
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import identify
from trialid.progress import silent

NOTHING = Verdict("nothing missing", None, (), "no effect stands out")
BIASED = replace(SETTINGS, nuisance=("initial_state", "bias"))
LACKING = MODEL - "yaw_drag_rar"
FEWER = replace(SETTINGS, free=tuple(n for n in SETTINGS.free if n != "Nrar"))


def sailed(seed, angles, held, noise=white, offset=0.0):
    """Zig-zags with noise; of those held out the gyro's zero is off by so much [rad/s]."""
    rng, made = np.random.default_rng(seed), []
    for angle in (*angles, *held):
        trial = zigzag(angle, use="check" if angle in held else "fit")
        r, phi = noise(rng, trial.samples)
        made.append(with_noise(trial, r + offset * (angle in held), phi))
    return made


def cut(trial, samples):
    """The beginning of a trial."""
    signals = {n: x[:samples] for n, x in trial.signals.items()}
    return replace(trial, signals=signals, valid={n: m[:samples] for n, m in trial.valid.items()})


def covariance(fit):
    asked = DiagnoseSettings(candidates={}, coefficients=False)
    return examine_fit(fit, asked, silent)[0].accuracy.covariance


def said(fit, of=covariance):
    return with_held_out(fit, NOTHING, lambda: of(fit), 0.05)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    "noise", [white, pytest.param(waves, marks=pytest.mark.study(turn="each"))]
)
def test_noise_alone_leaves_any_share_as_often(noise):
    """Of 16 chances a half below 0.5, none beyond belief: 150 s of waves are few values."""
    chances = []
    for seed in range(300, 308):
        *fitted, held = sailed(seed, (5, 10), (20,), noise)
        fit = identify([*fitted, cut(held, 300)], MODEL, SETTINGS)
        chances += [one.p_value for one in left_by_check(fit, covariance(fit))]
    assert len(chances) == 16
    assert 3 <= np.sum(np.array(chances) < 0.5) <= 13
    assert min(chances) > 0.001


def test_what_acts_only_in_the_trial_held_out_is_seen_there():
    """The squared yaw rate is nothing at 5 degrees of rudder and much at 20."""
    fit = identify(sailed(7, (2, 5), (20,)), LACKING, FEWER)
    found = said(fit)
    assert found.kind == "cannot tell"
    assert "those held out leave" in found.sentence
    worst = min(left_by_check(fit, covariance(fit)), key=lambda one: one.p_value)
    assert worst.left > 1.5 * worst.by_noise


@pytest.mark.study(turn="each")
def test_the_whole_diagnosis_says_so():
    """No effect stands out in the trials that it was fitted to."""
    found = diagnose(identify(sailed(7, (2, 5), (20,)), LACKING, FEWER)).verdict
    assert (found.kind, found.effect) == ("cannot tell", None)
    assert "no effect stands out in the fitted trials" in found.sentence


def test_parameters_that_are_hardly_known_are_not_blamed_on_the_model():
    """Ten from one small zig-zag: the large one is 1.5 times off what noise alone would leave."""
    fit = identify(sailed(11, (2,), (20,)), MODEL, SETTINGS)
    assert fit.eps_check is not None
    assert fit.eps_check > 1.5 * fit.eps_rmsn
    assert said(fit) == NOTHING
    assert said(fit, lambda f: np.zeros_like(covariance(f))).kind == "cannot tell"


def test_the_zero_of_a_sensor_is_the_trials_own():
    trials = sailed(12, (5, 10), (20,), offset=3.0 * GYRO)
    found = said(identify(trials, MODEL, BIASED))
    assert found.kind == "nothing missing"
    assert "; of r trials held out leave" in found.sentence
    assert "with zeros and delays of their own: sensors differ so, or take up" in found.sentence
    assert said(identify(trials, MODEL, SETTINGS)).kind == "cannot tell"


def test_a_gear_has_one_zero():
    """A trial whose rudder stands off by itself is told: nobody says that nothing is missing."""
    one, *others = sailed(14, (2, 5, 10), (20,))
    moved = {**one.signals, "delta": one.signals["delta"] + np.deg2rad(4.0)}
    settings = replace(BIASED, nuisance=(*BIASED.nuisance, "rudder_offset"))
    found = said(identify([replace(one, signals=moved), *others], MODEL, settings))
    assert (found.kind, found.effect) == ("cannot tell", None)
    assert f"deg, in {one.name} most: something acts there" in found.sentence


def test_what_is_left_is_a_share_of_what_moved():
    """White noise of both sensors, held against what was added."""
    fit = identify(sailed(13, (10, 20), (5,)), MODEL, SETTINGS)
    for one, rms, noise in zip(
        left_by_check(fit, covariance(fit)), fit.problem.y_rms, (GYRO, INCLINOMETER), strict=True
    ):
        assert one.left == pytest.approx(fit.eps_check_by_output[one.output], rel=0.01)
        assert one.left == pytest.approx(noise / rms, rel=0.1)
        assert one.by_noise == pytest.approx(noise / rms, rel=0.1)


@pytest.mark.parametrize("kind", ["missing", "not in catalogue", "cannot tell", "no fit"])
def test_other_verdicts_stay(kind):
    fit = identify(sailed(7, (2, 5), (20,)), LACKING, FEWER)
    verdict = replace(NOTHING, kind=kind)
    assert with_held_out(fit, verdict, lambda: covariance(fit), 0.05) is verdict


def test_without_a_trial_held_out_nothing_is_asked():
    fit = identify(sailed(14, (5, 10), ()), MODEL, SETTINGS)
    assert with_held_out(fit, NOTHING, pytest.fail, 0.05) is NOTHING


def test_a_trial_that_leaves_the_model_has_no_measure():
    """A covariance that nobody knows has none either."""
    fit = identify(sailed(13, (10, 20), (5,)), MODEL, SETTINGS)
    unknown = np.full((len(fit.theta), len(fit.theta)), np.nan)
    assert left_by_check(fit, unknown) == ()
    lost = replace(fit, theta=np.where([n == "Nr" for n in fit.estimates], 1.0, fit.theta))
    assert left_by_check(lost, np.zeros_like(unknown)) == ()
