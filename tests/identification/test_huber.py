"""Errors of a robust fit: what outliers leave of a record says how far its parameters are off."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import GYRO, MODEL, SETTINGS, white, with_noise, zigzag

from trialid.accuracy.likely import Averaged
from trialid.diagnosis.trust import accuracy_of
from trialid.identification.fit import identify
from trialid.identification.one_search import influence

CLEAN = [zigzag(10), zigzag(20)]
UNKNOWN = SimpleNamespace(undermodelling_interval=None, noise=None, undermodelling=None)


def struck(seed, share):
    """Both zig-zags with white noise, and some samples of the gyro forty times as far off."""
    rng = np.random.default_rng(seed)
    trials = []
    for clean in CLEAN:
        noisy = with_noise(clean, *white(rng, clean.samples))
        hit = (rng.random(clean.samples) < share) * rng.choice([-1.0, 1.0], clean.samples)
        trials.append(with_noise(noisy, hit * 40.0 * GYRO, 0.0 * hit))
    return trials


def errors(fit):
    count = len(fit.theta)
    none = Averaged(np.zeros((2, count)), np.zeros((2, count)), ("",) * count)
    return [p.standard_error for p in accuracy_of(fit, UNKNOWN, none).physical]


@pytest.mark.study
def test_estimates_scatter_by_their_standard_errors():
    """By 4 to 11 times less, where outliers counted as noise."""
    settings = replace(SETTINGS, loss="huber")
    fits = [identify(struck(300 + k, 0.05), MODEL, settings) for k in range(12)]
    stated = np.mean([errors(f) for f in fits], axis=0)
    ratio = np.std([f.theta[: len(stated)] for f in fits], axis=0, ddof=1) / stated
    print(ratio.round(2))
    assert 0.75 < np.sqrt(np.mean(ratio**2)) < 1.35


def test_outliers_count_as_the_limit_and_the_rest_for_them():
    residual = np.array([-1.0, 1.0, -1.0, 1.0, 0.5, -0.5, 1.0, -1.0, 900.0, -700.0])
    found = influence(residual)
    assert found[:4] == pytest.approx(residual[:4] / 0.8)
    assert found[8:] == pytest.approx([1.345 * 1.4826 / 0.8, -1.345 * 1.4826 / 0.8])
