"""How often likely ranges hold the truth, on seeds that nothing was built on."""

import numpy as np
import pytest
from coverage import CASES, count, share

RECORDS, FIRST = 24, 9000
COUNTED = (0, 1, 3, 4, 7, 12, 18, 19)
"""The cases of the page that are counted here: each kind of thing that may be wrong once."""


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("place", COUNTED, ids=lambda k: CASES[k].name.replace(" ", "_"))
def test_ranges_hold_the_truth(place):
    """Not fewer than asked for beyond chance; and no range as wide as Eq. 14's bound."""
    case = CASES[place]
    found = [count(case, seed) for seed in range(FIRST, FIRST + RECORDS)]
    done = [c for c in found if c is not None]
    held, low, high = share(done, "likely")
    widths = {
        k: float(np.median([w for c in done for w in c.widths[k]])) for k in ("likely", "Eq. 14")
    }
    print(f"{case.name}: {held:.1%} ({low:.0%}-{high:.0%}) of {len(done)} records; {widths}")
    assert len(done) > 0.9 * RECORDS
    assert high >= case.asked
    assert widths["likely"] < 0.5 * widths["Eq. 14"]


@pytest.mark.study(turn=2)
def test_standard_errors_alone_do_not():
    """What the ranges are for: with an effect hidden 1.96 x `+-` holds about half."""
    found = [count(CASES[0], seed) for seed in range(FIRST, FIRST + 8)]
    done = [c for c in found if c is not None]
    assert share(done, "1.96 +-")[0] < 0.8 < share(done, "likely")[0]


@pytest.mark.study(turn="each")
def test_a_record_counts_the_same_twice():
    assert count(CASES[0], 3) == count(CASES[0], 3)
