"""Alarms: how often noise alone raises one, and how soon an effect that sets in late is found."""

import late_effect
import numpy as np
import pytest

from trialid import pipeline_file
from trialid.diagnosis.examine import examine_fit
from trialid.diagnosis.noise.error_parts import Split
from trialid.replay.alarm import Band, Monitor, bands
from trialid.replay.playback import Playback
from trialid.workflow.build_model import available
from trialid.workflow.findings import diagnose_settings
from trialid.workflow.fit_model import fit_of
from trialid.workflow.read_trials import align_trial, align_trials

HOUR = 3600.0


def quietly(words, share):
    pass


def coloured(rng, n, outputs, a=0.9):
    """Noise of an autoregression, and the band that knows it."""
    e = rng.standard_normal((n, outputs))
    noise = np.zeros((n, outputs))
    for k in range(1, n):
        noise[k] = a * noise[k - 1] + e[k]
    band = Band("r", 1.0 / np.sqrt(1 - a**2), np.array([1.0, -a]))
    return noise, (band,) * outputs


def alarms_of_noise(hours_stated, hours, seed):
    period, outputs = 1.0, 2
    n = round(hours * HOUR / period)
    noise, known = coloured(np.random.default_rng(seed), n, outputs)
    monitor = Monitor(known, period, n, hours_stated)
    monitor.advance(noise, np.ones((n, outputs), dtype=bool), n)
    return len(monitor.alarms)


def test_noise_alone_raises_as_many_alarms_as_stated():
    """One in six minutes stated, so that enough of them come: 120 expected in twelve hours.

    An alarm that lasts cannot be raised again, which makes them a few less.
    """
    counted = sum(alarms_of_noise(0.1, 4.0, seed) for seed in range(3))
    print(f"\n{counted} alarms, 120 expected")
    assert 60 <= counted <= 150


@pytest.mark.study(turn=5)
def test_noise_alone_raises_one_alarm_a_day():
    """Ten days of slow noise by the stated rate of one in 24 hours."""
    counted = sum(alarms_of_noise(24.0, 60.0, seed) for seed in range(4))
    print(f"\n{counted} alarms in 240 h, 10 expected")
    assert counted <= 20


def test_a_wild_value_is_no_alarm_and_a_gap_is_passed_over():
    rng = np.random.default_rng(3)
    noise, known = coloured(rng, 2000, 1, a=0.5)
    noise[700] += 50.0
    compared = np.ones((2000, 1), dtype=bool)
    compared[900:950] = False
    noise[900:950] = 1e6
    monitor = Monitor(known, 0.5, 2000)
    monitor.advance(noise, compared, 2000)
    assert monitor.alarms == []
    assert np.isfinite(monitor.score).all()


def test_the_way_to_a_moment_does_not_change_what_is_found_there():
    noise, known = coloured(np.random.default_rng(4), 1200, 2)
    noise[600:] += 20.0  # two in the whitened residual
    compared = np.ones((1200, 2), dtype=bool)
    once, bits = Monitor(known, 0.5, 1200), Monitor(known, 0.5, 1200)
    once.advance(noise, compared, 1200)
    for to in range(0, 1207, 7):
        bits.advance(noise, compared, min(to, 1200))
    assert np.array_equal(once.score, bits.score)
    assert once.alarms == bits.alarms
    assert once.alarms


@pytest.fixture(scope="module")
def rudders():
    return late_effect.rudders()


def replayed(folder, lost, onset, seed, rudders):
    read = pipeline_file.load(late_effect.write(folder, lost, onset, seed, rudders))
    catalogue = available(read)
    fit = fit_of(read, align_trials(read, quietly), catalogue, quietly)
    found, augmented = examine_fit(fit, diagnose_settings(read, catalogue), quietly)
    playback = Playback(fit, align_trial(read, read.trials[-1]), bands(fit, found.split, augmented))
    playback.go_to(playback.trial.samples)
    return playback


@pytest.mark.parametrize(("lost", "onset"), [(0.3, 600.0), (0.5, 620.0)])
@pytest.mark.study(turn="each")
def test_an_effect_that_sets_in_halfway_is_found_within_ten_seconds(tmp_path, rudders, lost, onset):
    """And nothing is in the first half."""
    playback = replayed(tmp_path, lost, onset, 0, rudders)
    first = playback.monitor.alarms[0]
    print(f"\n{lost:.0%} of the rudder lost at {onset:g} s: sure at {first.raised:g} s")
    assert onset < first.raised <= onset + 10.0
    assert first.output == "r"
    assert abs(first.since - onset) <= 10.0
    words = playback.events()[0].words
    assert "left its noise band" in words
    assert words.endswith("to port")  # the rudder is over to port since 550 s


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", range(1, 9))
def test_every_sea_finds_it(tmp_path, rudders, seed):
    playback = replayed(tmp_path, 0.3, 600.0, seed, rudders)
    first = playback.monitor.alarms[0]
    print(f"\nsea {seed}: sure at {first.raised:g} s")
    assert 600.0 < first.raised <= 610.0


@pytest.mark.study(turn=6)
def test_without_a_late_effect_there_is_no_alarm_and_unknown_noise_is_said(tmp_path, rudders):
    playback = replayed(tmp_path, 0.0, 600.0, 0, rudders)
    assert playback.bands.separated
    assert playback.monitor.alarms == []
    fit = playback.fit
    read = pipeline_file.load(tmp_path / "late.toml")
    augmented = examine_fit(fit, diagnose_settings(read, available(read)), quietly)[1]
    unknown = bands(fit, Split("not separable", "nothing holds"), augmented)
    assert not unknown.separated
    assert "could not be separated" in unknown.source
    sigma = [b.sigma for b in unknown.of]
    rms = [fit.eps_by_output[c] * y for c, y in zip(("r", "phi"), fit.problem.y_rms, strict=True)]
    assert sigma == pytest.approx(rms)
