"""The bootstrap over blocks: false alarms as often as said, and what is there is found."""

import numpy as np
import pytest
from scipy.signal import lfilter

from trialid.diagnosis.noise.variance import lag_window
from trialid.diagnosis.search.p_value import against_chance, inflation
from trialid.diagnosis.search.projection import gather
from trialid.trial_rows import Stretch

SAMPLES, TRIALS = 1200, 3
PARTS = tuple(
    Stretch(i, 0, slice(i * SAMPLES, (i + 1) * SAMPLES), np.ones(SAMPLES, dtype=bool))
    for i in range(TRIALS)
)
N = SAMPLES * TRIALS


def slow(rng, columns, memory):
    """Smooth columns, as traces of physical effects are."""
    keep = np.exp(-1.0 / memory)
    made = lfilter([1.0], [1.0, -keep], rng.standard_normal((N + 500, columns)), axis=0)[500:]
    return made / made.std(axis=0)


def problem(rng, noise):
    psi, S = slow(rng, 8, 30.0), slow(rng, 40, 40.0)
    groups = [(i,) for i in range(30)] + [(30, 31), (32, 33, 34), (35, 36), (37, 38, 39)]
    return psi, S, groups, noise(rng)


def white(rng):
    return rng.standard_normal(N)


def red(rng):
    """Noise with the memory of a gust on top of white noise."""
    return slow(rng, 1, 12.0)[:, 0] + 0.5 * rng.standard_normal(N)


def least_p(rng, noise, hidden=0.0):
    psi, S, groups, e = problem(rng, noise)
    evidence = gather(e + hidden * S[:, 3], psi, S, PARTS, groups)
    w = evidence.white
    found = against_chance(w.residual, w.Q, w.S, groups, evidence.parts)
    return [c.p_value for c in found], evidence


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("noise", [white, red])
def test_false_alarms_come_as_often_as_said(noise):
    """The least p of a catalogue of 34 is below 0.1 in a tenth of the records: 60 +- 3 s.e."""
    alarms = sum(min(least_p(np.random.default_rng(s), noise)[0]) < 0.1 for s in range(60))
    print(f"{noise.__name__}: {alarms} of 60 at 10 %")
    assert alarms <= 13


@pytest.mark.parametrize("noise", [white, red])
def test_an_effect_that_is_there_is_found(noise):
    p, _ = least_p(np.random.default_rng(1), noise, hidden=0.3)
    assert int(np.argmin(p)) == 3
    assert p[3] <= 0.002


def test_the_colour_is_that_of_the_noise_not_of_a_strong_effect():
    """A slow effect of ten times the noise: the whitened noise is white all the same."""
    rng = np.random.default_rng(2)
    psi, S, groups, e = problem(rng, white)
    evidence = gather(e + 10.0 * S[:, 3], psi, S, PARTS, groups)
    assert np.sum(evidence.colour[0][1:] ** 2) < 0.05 * evidence.colour[0][0] ** 2
    assert evidence.inflation < 1.5


def test_inflation_counts_dependent_rows():
    """Red noise that nobody whitened scatters a slow score by its memory."""
    rng = np.random.default_rng(3)
    S = slow(rng, 40, 100.0)
    assert inflation(white(rng), S, PARTS) < 1.3
    assert inflation(slow(rng, 1, 10.0)[:, 0], S, PARTS) > 5.0


def test_no_chance_is_smaller_than_the_blocks_support():
    """Ten blocks: no p below 2 / 2^10, however clear the effect."""
    parts = (Stretch(0, 0, slice(0, 200), np.ones(200, dtype=bool)),)
    rng = np.random.default_rng(4)
    S = slow(rng, 1, 5.0)[:200]
    blocks = 200 // lag_window(parts)
    [found] = against_chance(S[:, 0] + 1e-6 * white(rng)[:200], S[:, :0], S, [(0,)], parts)
    assert found.p_value >= 1.0 / 2.0**blocks


@pytest.mark.parametrize("columns", [(40,), (40, 41)])
def test_what_shows_in_one_block_alone_does_not_beat_all_others(columns):
    """It fits that block whatever its sign, so chance does as well, and the clear one is clear."""
    rng = np.random.default_rng(6)
    psi, S, groups, e = problem(rng, white)
    brief = np.zeros((N, 2))
    brief[: lag_window(PARTS)] = rng.standard_normal((lag_window(PARTS), 2))
    S = np.hstack([S, brief])
    found = against_chance(e + 0.3 * S[:, 3], psi[:, :0], S, [*groups, columns], PARTS)
    assert found[3].p_value <= 0.002
    assert found[-1].p_value > 0.5


def test_the_same_every_time():
    one, _ = least_p(np.random.default_rng(5), red)
    other, _ = least_p(np.random.default_rng(5), red)
    assert one == other
