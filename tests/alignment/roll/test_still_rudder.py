"""A rudder that stands still tells no side, whatever its noise happens to go with."""

import numpy as np

from trialid.alignment.agreement.signs import answer_of


def decay(seed, period=0.05, duration=32.0):
    """A yaw that swings with the roll, a rudder amidships, each with the noise of its sensor."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, duration, period)
    swing = np.exp(-0.1 * t) * np.sin(2.4 * t)
    rate = np.deg2rad(swing + 0.05 * rng.standard_normal(len(t)))
    noise = np.convolve(rng.standard_normal(len(t) + 1), (0.5, 0.5), "valid")
    return np.deg2rad(0.04 * noise), rate, np.ones(len(t), np.bool_)


def test_of_many_none_is_said_to_be_steered():
    assert all(answer_of(*decay(seed), 0.05).sign == 0.0 for seed in range(500, 700))


def test_a_small_zigzag_still_tells_its_side():
    t = np.arange(0.0, 200.0, 0.5)
    rudder = np.deg2rad(2.0) * np.sign(np.sin(0.3 * t))
    rudder = rudder + np.deg2rad(0.1) * np.random.default_rng(3).standard_normal(len(t))
    rate = np.zeros(len(t))
    for k in range(1, len(t)):
        rate[k] = rate[k - 1] + 0.5 * (0.1 * rudder[k - 1] - rate[k - 1]) / 8.0
    known = np.ones(len(t), np.bool_)
    assert answer_of(rudder, rate, known, 0.5).sign == 1.0
    assert answer_of(-rudder, rate, known, 0.5).sign == -1.0
