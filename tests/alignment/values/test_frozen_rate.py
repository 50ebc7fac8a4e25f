"""A rate of turn that freezes while the heading goes on otherwise, beside one that is steady."""

import numpy as np
import pytest

from trialid.alignment.clocks import Grid, Series
from trialid.alignment.faults import _turns_otherwise, find_stuck
from trialid.names.quantities import SIGNALS

PERIOD = 0.5
T = np.arange(0.0, 900.0, PERIOD)
NS = np.round(T * 1e9).astype(np.int64)
RATE = 0.01 * np.sign(np.sin(2.0 * np.pi * (T + 0.1) / 200.0))
"""[rad/s] To and fro, 100 s each; then a long turn, beside which what goes before is little."""
RATE = np.where(T > 600.0, 0.02, RATE)
RATE[T > 870.0] = -0.01


def series(name, y, shift=0.0):
    return Series(SIGNALS[name], NS + round(shift * 1e9), y, "column t")


def frozen(begin, length=40.0, gain=1.0, noise=1e-4):
    """Rate and heading; the rate keeps from there on what it was, however she turns."""
    psi = np.cumsum(RATE) * PERIOD
    shown = gain * RATE + noise * np.random.default_rng(3).normal(size=len(T))
    held = (begin <= T) & (begin + length > T)
    shown[held] = gain * RATE[np.argmax(held)]
    return series("r", shown), series("psi", psi, 0.2), (int(NS[held][0]), int(NS[held][-1]))


@pytest.mark.parametrize("gain", [1.0, 1.1])
@pytest.mark.parametrize(
    ("begin", "told"), [(180.0, True), (85.0, True), (120.0, False), (860.0, True)]
)
def test_only_where_she_turns_otherwise_than_it_says(begin, told, gain):
    """A gyro that reads a tenth too much is so everywhere, and is not frozen for it."""
    rate, heading, ends = frozen(begin, gain=gain)
    assert _turns_otherwise(rate, heading, ends) is told


def test_it_is_masked_though_the_heading_spreads_by_far_more_elsewhere():
    """An outsider's froze for 40 s in a zig-zag of 20 deg, and no word was said."""
    rate, heading, _ = frozen(180.0)
    found = find_stuck((rate, heading), 0, Grid(0, PERIOD, len(T)))
    assert found is not None
    assert 75 < found.samples.sum() < 85
    rate, heading, _ = frozen(120.0)
    assert find_stuck((rate, heading), 0, Grid(0, PERIOD, len(T))) is None


def test_of_a_heading_that_ends_before_nothing_is_said():
    """She is not taken to lie still where no compass was recorded."""
    rate, heading, ends = frozen(660.0)
    ended = np.where(T < 650.0, heading.y, np.nan)
    assert not _turns_otherwise(rate, Series(heading.quantity, heading.t, ended, "t"), ends)
    begun = np.where(T > 650.0, heading.y, np.nan)
    rate, _, ends = frozen(500.0)
    assert not _turns_otherwise(rate, Series(heading.quantity, heading.t, begun, "t"), ends)


def test_of_a_heading_without_samples_nothing_is_said():
    rate, heading, ends = frozen(180.0)
    blind = Series(heading.quantity, heading.t, np.full(len(T), np.nan), heading.clock)
    assert not _turns_otherwise(rate, blind, ends)
