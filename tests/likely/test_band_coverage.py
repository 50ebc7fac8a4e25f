"""How much of a replayed trial lies in the band of its prediction, on fresh seeds."""

import numpy as np
import pytest
from band_coverage import CASES, calibrated, count, share

RECORDS, FIRST = 24, 30000


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("place", range(len(CASES)), ids=lambda k: CASES[k].name.replace(" ", "_"))
def test_a_replayed_trial_lies_in_its_band(place):
    """In 90 to 97 % of its samples; whole records are drawn for the interval."""
    found = [count(CASES[place], seed) for seed in range(FIRST, FIRST + RECORDS)]
    done = [c for c in found if c]
    held, low, high = share([float(np.mean(list(one.values()))) for one in done])
    print(f"{CASES[place].name}: {held:.1%} ({low:.0%}-{high:.0%}) of {len(done)} records")
    assert len(done) > 0.9 * RECORDS
    assert calibrated(done)


def test_with_nothing_hidden_it_holds_about_95_of_100():
    done = [count(CASES[0], seed) for seed in range(FIRST, FIRST + 5)]
    shares = [x for one in done for x in one.values()]
    assert 0.92 < np.mean(shares) < 0.98
    assert count(CASES[0], FIRST) == done[0]
