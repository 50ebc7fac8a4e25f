"""What a sensor counts in is told from values that merely do not come near each other."""

import numpy as np
import pytest

from trialid.diagnosis.noise.coarse_counts import count_of

T = np.arange(0.0, 150.0, 0.5)
SWUNG = 8.0 * np.sin(T / 7.0)


@pytest.mark.parametrize("seed", range(900, 920))
def test_positions_of_a_ship_that_goes_on_are_counted_in_nothing(seed):
    rng = np.random.default_rng(seed)
    way = np.cumsum(0.5 * (1.2 + 0.2 * np.sin(T / 7.0))) + 0.05 * rng.standard_normal(len(T))
    assert count_of(way) == 0.0


@pytest.mark.parametrize("count", [0.1, 0.5, 1.0])
@pytest.mark.parametrize("finer", [3.3, 8.7, 1000.0])
def test_counts_are_found_though_they_are_rounded_again(count, finer):
    counted, grain = np.deg2rad(count * np.rint(SWUNG / count)), np.deg2rad(count) / finer
    again = grain * np.rint(counted / grain)
    assert count_of(again) == pytest.approx(np.deg2rad(count), rel=0.03)


def test_one_value_is_no_count():
    assert count_of(np.ones(9)) == 0.0
