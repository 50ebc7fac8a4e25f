"""How much of an error is as slow as the ship herself: of a sensor's noise next to nothing."""

from types import SimpleNamespace

import numpy as np
import pytest
from s175q import GYRO, INCLINOMETER, MODEL, SETTINGS, waves, white, with_noise, zigzag
from scipy.signal import lfilter

from trialid.diagnosis.noise import own_motion
from trialid.diagnosis.noise.own_motion import share_at_own_frequencies
from trialid.diagnosis.noise.residual import Residual
from trialid.identification.fit import identify
from trialid.identification.problem import replace

FREE = ("Nv", "Nr", "Ndelta", "Yv", "Kv", "Kr", "Kdelta", "Kp", "GM")


def of_the_ship(rng, n):
    """What a force without memory does to a ship that answers within 40 s."""
    slow = np.exp(-0.5 / 40.0)
    e = lfilter([1.0], [1.0, -slow], rng.standard_normal((2, n + 1000)))[:, 1000:]
    return np.array([[GYRO], [INCLINOMETER]]) * e / np.std(e, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("noise", "low", "high"), [(white, 0.0, 0.1), (waves, 0.0, 0.3), (of_the_ship, 0.5, 1.0)]
)
def test_only_what_passes_through_the_ship_is_as_slow_as_she_is(noise, low, high):
    rng = np.random.default_rng(11)
    trials = [zigzag(amplitude) for amplitude in (10, 20)]
    noisy = [with_noise(trial, *noise(rng, trial.samples)) for trial in trials]
    fit = identify(noisy, MODEL, replace(SETTINGS, free=FREE))
    share = share_at_own_frequencies(fit)
    print(f"{share:.2f}")
    assert low <= share < high


def test_a_ship_that_lies_still_has_no_frequencies_of_her_own(monkeypatch):
    """Whatever her sensors say: nothing passes through her."""
    still = Residual(
        SimpleNamespace(period=0.5), np.ones((100, 1)), np.ones((100, 1), bool), np.zeros((100, 1))
    )
    monkeypatch.setattr(own_motion, "residuals", lambda fit: [still])
    fit = SimpleNamespace(problem=SimpleNamespace(outputs=("r",)))
    assert share_at_own_frequencies(fit) == 0.0
