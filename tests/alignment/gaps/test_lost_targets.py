"""Runs of many samples that a signal jumps to and back from: a lost target, a disturbance."""

import time

import numpy as np
import pytest

from trialid.alignment.brief_steps import long_dropouts, long_spikes
from trialid.alignment.clocks import Grid, Series
from trialid.alignment.faults import mask_faults
from trialid.names.quantities import SIGNALS

NOISE = 0.005


def at(rate: float, seconds: float = 60.0) -> np.ndarray:
    return np.arange(0.0, seconds, 1.0 / rate)


def speed(t: np.ndarray, seed: int = 1) -> np.ndarray:
    """Of a model that loses a fifth of 1.5 m/s in each turn."""
    noise = np.random.default_rng(seed).normal(scale=NOISE, size=len(t))
    return 1.5 - 0.15 * (1.0 - np.cos(0.4 * t)) + noise


def series(quantity: str, t: np.ndarray, y: np.ndarray) -> Series:
    return Series(SIGNALS[quantity], np.rint(t * 1e9).astype(np.int64), y, "made")


def masked(quantity: str, t: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Where nothing is left, and the remarks."""
    grid = Grid(0, 0.1, round(10 * t[-1]))
    left, remarks = mask_faults(series(quantity, t, y), grid, (), 0.0, "here")
    return ~np.isfinite(left.y), remarks


@pytest.mark.parametrize("rate", [20.0, 50.0, 100.0, 200.0])
@pytest.mark.parametrize("lasting", [0.6, 2.0, 4.5])
def test_a_speed_of_zero_for_seconds_is_no_speed_at_any_rate(rate, lasting):
    t = at(rate)
    lost = (t > 20.0) & (t < 20.0 + lasting)
    found, (words,) = masked("u", t, np.where(lost, 0.0, speed(t)))
    assert found.tolist() == lost.tolist()
    assert words.startswith(f"u: {lost.sum()} values dropped to zero, at 20.")
    assert words.endswith("masked")


@pytest.mark.parametrize("rate", [1.0, 2.0])
@pytest.mark.parametrize("lasting", [11.5, 20.0, 30.0])
def test_a_rate_and_a_speed_of_zero_for_as_long_as_a_tanker_needs_are_lost(rate, lasting):
    """Of 300 m, logged once a second: both end elsewhere than they began, by then."""
    t = at(rate, 900.0)
    lost = (t > 400.0) & (t < 400.0 + lasting)
    noise = np.random.default_rng(3).normal(scale=2e-5, size=len(t))
    for quantity, y in (("r", 4e-3 * np.cos(0.015 * t)), ("u", 7.0 + 0.6 * np.cos(0.03 * t))):
        found, _ = masked(quantity, t, np.where(lost, 0.0, y + noise))
        assert found.tolist() == lost.tolist()


def test_motions_that_are_lost_at_once_are_all_lost():
    t = at(50.0)
    lost = (t > 20.0) & (t < 20.6)
    noise = np.random.default_rng(2).normal(scale=NOISE, size=len(t))
    for quantity, y in (("r", 0.1 * np.cos(0.3 * (t - 20.3))), ("psi", 2.0 + 0.01 * t)):
        found, _ = masked(quantity, t, np.where(lost, 0.0, y + noise / 10))
        assert found.tolist() == lost.tolist()


@pytest.mark.parametrize("rate", [50.0, 100.0])
@pytest.mark.parametrize("lasting", [0.1, 0.5])
def test_a_speed_off_by_as_much_for_many_samples_is_out_of_line(rate, lasting):
    t = at(rate)
    off = (t > 20.0) & (t < 20.0 + lasting)
    found, (words,) = masked("u", t, speed(t) + np.where(off, 3.0, 0.0))
    assert found.tolist() == off.tolist()
    assert "values out of line" in words


def test_two_of_both_in_one_record():
    t = at(50.0)
    zeros = ((t > 20.0) & (t < 20.6)) | ((t > 40.0) & (t < 43.0))
    off = ((t > 30.0) & (t < 30.1)) | ((t > 30.3) & (t < 30.4))
    y = np.where(zeros, 0.0, speed(t) + np.where(off, -0.8, 0.0))
    found, remarks = masked("u", t, y)
    assert found.tolist() == (zeros | off).tolist()
    assert len(remarks) == 2


def stopped(t):
    """At rest for two seconds, from half a metre a second in some four."""
    return 0.5 * np.tanh(np.clip(np.abs(t - 30.0) - 1.0, 0.0, None) / 3.0)


def steps(t):
    """A rudder order that goes to midships and on again at once."""
    return np.where((t > 20.0) & (t < 20.5), 0.0, 0.35)


def held(t):
    """A rate of turn in steps of its display, which stands at zero for a second now and then."""
    return np.repeat(np.round(0.05 * np.sin(np.arange(0.0, 60.0, 1.0)), 2), len(t) // 60)


def waves(t):
    return 0.02 * np.sign(np.sin(2.1 * t)) * np.ceil(2.0 * np.abs(np.sin(2.1 * t)))


def band(t):
    """A rate that is shown as none below a tenth of the largest, between turns to one side."""
    r = 0.05 * (1.0 - np.exp(-((t - 30.0) ** 2) / 4.5))
    return np.where(r < 0.0045, 0.0, r)


def crossing(t):
    """The same of a zig-zag."""
    r = 0.05 * np.tanh((t - 30.0) / 8.0)
    return np.where(np.abs(r) < 0.012, 0.0, r)


REAL = {
    "a display that shows no small rates": ("r", band),
    "one that shows none as she goes over to the other side": ("r", crossing),
    "a ship that stops and starts": ("u", stopped),
    "a rudder order to midships": ("delta_order", steps),
    "a display of two digits": ("r", held),
    "a motion of few levels": ("p", waves),
    "a shaft that is stopped for two seconds": (
        "n",
        lambda t: np.where((t > 20.0) & (t < 22.0), 0.0, 10.0 + 0.05 * np.sin(9.0 * t)),
    ),
    "an order of revolutions that stops her for a while": (
        "n",
        lambda t: np.where((t > 10.0) & (t < 30.0), 0.0, 10.0 + 0.05 * np.sin(9.0 * t)),
    ),
}


def test_a_speed_that_is_logged_too_seldom_may_have_been_lost_on_the_way():
    t = np.arange(0.0, 3000.0, 10.0)
    stopped_for_long = (t > 1000.0) & (t < 1150.0)
    noise = np.random.default_rng(4).normal(scale=NOISE, size=len(t))
    found, _ = masked("u", t, np.where(stopped_for_long, 0.0, 1.5 + noise))
    assert not found.any()


@pytest.mark.parametrize(("quantity", "made"), REAL.values(), ids=REAL)
def test_what_may_be_real_is_left(quantity, made):
    t = at(50.0)
    found, _ = masked(quantity, t, made(t))
    assert not found.any()


@pytest.mark.parametrize("seed", range(10))
def test_noise_alone_has_none(seed):
    t = at(50.0)
    heavy = np.random.default_rng(seed).standard_t(3, size=len(t))
    assert not list(long_spikes(series("r", t, 0.01 * heavy), 0.0))
    coarse = np.round(0.3 * heavy) / 10
    assert not list(long_dropouts(series("r", t, coarse), 0.0))


def test_a_day_takes_a_second_however_long_the_runs():
    t = at(10.0, 86_400.0)
    y = speed(t)
    for k in range(1000, len(t), 1000):
        y[k : k + 45] = 0.0
    began = time.perf_counter()
    (found,) = long_dropouts(series("u", t, y), 0.0)
    assert not list(long_spikes(series("u", t, np.where(found.samples, np.nan, y)), 0.0))
    assert time.perf_counter() - began < 5.0
    assert found.samples.sum() == (y == 0.0).sum()
