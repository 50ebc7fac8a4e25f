"""One sample in fifty is a spike, and some stand beside each other to either side."""

import numpy as np
import pytest

from trialid.alignment.clocks import Series
from trialid.alignment.spikes import spikes
from trialid.names.quantities import SIGNALS

N = 2000
T = np.arange(N, dtype=np.int64) * 500_000_000


def spiked(share, seed, size=0.09):
    """A rate of turn in zig-zags with its noise [rad/s], and where spikes were put into it."""
    rng = np.random.default_rng(seed)
    r = 0.01 * np.sin(0.05 * np.arange(N)) + rng.normal(0.0, 3e-4, N)
    at = rng.choice(np.arange(4, N - 4), round(share * N), replace=False)
    r[at] += size * rng.choice([-1.0, 1.0], len(at))
    there = np.zeros(N, np.bool_)
    there[at] = True
    return r, there


def found_in(r):
    series = Series(SIGNALS["r"], T, r, "clock")
    masks = [fault.samples for fault in spikes(series, 0.0)]
    return np.any(masks, axis=0) if masks else np.zeros(N, np.bool_)


@pytest.mark.parametrize("share", [0.0, 0.002, 0.005, 0.01, 0.02, 0.025])
def test_spikes_are_found_however_many_and_nothing_else(share):
    """With 2 % of them none was found, and `she never moves` was said of a ship in zig-zags.

    But for samples between two of them, no more than a spike may have.
    """
    for seed in range(4120, 4130):
        r, there = spiked(share, seed)
        found = found_in(r)
        at = np.flatnonzero(there)
        for k in np.flatnonzero(found & ~there):
            assert at[np.searchsorted(at, k)] - at[np.searchsorted(at, k) - 1] <= 4
        assert found.sum() >= 0.98 * there.sum()


def test_two_beside_each_other_to_either_side_are_two():
    r, _ = spiked(0.0, 4130)
    r[[700, 701]] += [0.09, -0.09]
    assert np.flatnonzero(found_in(r)).tolist() == [700, 701]


def test_steps_and_what_is_everywhere_are_none():
    r, _ = spiked(0.0, 4131)
    steps = np.where(np.arange(N) % 100 < 50, 0.1, -0.1)
    assert not found_in(r + steps).any()
    assert not found_in(spiked(0.15, 4132)[0]).any()
