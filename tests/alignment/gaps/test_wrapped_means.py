"""A heading that was interpolated through north number by number has values that are none."""

import numpy as np
import pytest

from trialid.alignment.clocks import Grid, Series
from trialid.alignment.faults import mask_faults
from trialid.alignment.wrapped_means import on_the_long_way
from trialid.inspection.sketch import sketch
from trialid.names.quantities import SIGNALS

PERIOD = 0.5


def turning(seed: int, least: float) -> tuple[np.ndarray, np.ndarray]:
    """True heading [rad] at 2 Hz, and as a log at 1.4 Hz gives it, brought onto that clock.

    It goes from `least` through a whole turn.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 400.0, 0.7)
    rate = np.deg2rad(rng.uniform(1.5, 5.0)) * np.sin(t / rng.uniform(8.0, 30.0)) + 0.02
    psi = np.cumsum(0.7 * rate) + np.deg2rad(0.2) * rng.standard_normal(len(t))
    grid = np.arange(0.0, 399.0, PERIOD)
    return np.interp(grid, t, psi), np.interp(grid, t, (psi - least) % (2 * np.pi) + least)


def off(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.abs((one - other + np.pi) % (2 * np.pi) - np.pi)


@pytest.mark.parametrize("least", [0.0, -np.pi])
def test_what_lies_between_both_ends_of_the_circle_is_found_and_nothing_else(least: float) -> None:
    wrong = found = taken = 0
    for seed in range(940, 980):
        true, logged = turning(seed, least)
        bad = off(logged, true) > np.deg2rad(15.0)
        masked = on_the_long_way(logged)
        wrong += int(bad.sum())
        found += int((bad & masked).sum())
        taken += int((masked & (off(logged, true) < 1e-9)).sum())
    assert wrong >= 60
    assert found >= 0.97 * wrong
    assert taken <= 0.03 * wrong


def means(seed: int, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """True heading [rad] of a zig-zag about north at 2 Hz, and means of five samples of its log."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, duration, PERIOD / 5.0)
    psi = np.deg2rad(40.0) * np.sin(t / rng.uniform(4.0, 8.0) + rng.uniform(0.0, 6.0))
    each = psi.reshape(-1, 5)
    return each.mean(axis=1), (each % (2 * np.pi)).mean(axis=1)


@pytest.mark.parametrize("duration", [40.0, 90.0])
def test_means_of_a_short_zig_zag_about_north_are_found(duration: float) -> None:
    """She passes it so often that one step in twenty is none of hers."""
    wrong = found = 0
    for seed in range(980, 1020):
        true, logged = means(seed, duration)
        bad = off(logged, true) > np.deg2rad(15.0)
        wrong += int(bad.sum())
        found += int((bad & on_the_long_way(logged)).sum())
    assert wrong >= 70
    assert found >= 0.95 * wrong


def test_a_heading_that_passes_north_as_logged_keeps_all_its_values() -> None:
    for seed in range(940, 980):
        true, _ = turning(seed, 0.0)
        assert not on_the_long_way(true % (2 * np.pi)).any()
        assert not on_the_long_way(true).any()  # one that counts turns


def test_a_boat_that_spins_is_no_interpolation() -> None:
    spin = np.deg2rad(60.0) * np.arange(200.0)  # a turn in six samples
    assert not on_the_long_way(spin % (2 * np.pi)).any()


def test_a_finer_clock_has_many_of_them() -> None:
    t = np.arange(0.0, 200.0, 1.0)
    fine = np.arange(0.0, 199.0, 0.1)
    psi = 0.05 * t
    true, logged = np.interp(fine, t, psi), np.interp(fine, t, psi % (2 * np.pi))
    masked = on_the_long_way(logged)
    assert masked.sum() >= 9
    assert not (off(logged, true)[~masked] > np.deg2rad(10.0)).any()


def test_a_sketch_goes_on_through_north() -> None:
    for seed in range(940, 960):
        true, logged = turning(seed, 0.0)
        t = (1e9 * PERIOD * np.arange(len(true))).astype(np.int64)
        seen = sketch(t, logged, 2 * np.pi)
        told = np.interp(t, seen.t, seen.y)
        assert np.ptp(told - true) < np.deg2rad(30.0)


@pytest.mark.parametrize(("true", "logged"), [turning(943, 0.0), means(981, 40.0)])
def test_what_is_found_is_masked_and_said(true: np.ndarray, logged: np.ndarray) -> None:
    t = (1e9 * PERIOD * np.arange(len(true))).astype(np.int64)
    log = Series(SIGNALS["psi"], t, logged, "made")
    left, remarks = mask_faults(log, Grid(0, PERIOD, len(t)), (), 0.0, "here")
    bad = off(logged, true) > np.deg2rad(15.0)
    assert bad.any()
    assert np.isnan(left.y[bad]).all()
    assert "interpolated the long way round" in remarks[0]
    assert remarks[0].endswith("masked")
