"""How often ranges of IMO's measures hold what the true ship does, on fresh seeds."""

import numpy as np
import pytest
from measures_coverage import CASES, MEASURES, count, fit_of, hidden_world, ranges, sails, share
from worlds import EVERY

from trialid.design.following import vessel_of
from trialid.design.standard import predict
from trialid.effects import CATALOGUE

RECORDS, FIRST = 16, 30000
COUNTED = (0, 1, 3, 5, 7, 9, 13)
"""The cases of the page that are counted here: each kind of thing that may be wrong once."""


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("place", COUNTED, ids=lambda k: CASES[k].name.replace(" ", "_"))
def test_ranges_hold_what_the_true_ship_does(place):
    """Not fewer than asked for beyond chance; overshoots told to a tenth, the circle to a fifth."""
    case = CASES[place]
    seeds = [seed for seed in range(FIRST, FIRST + RECORDS) if sails(case, seed)]
    found = [count(case, seed) for seed in seeds]
    done = [c for c in found if c is not None]
    held, low, high = share(done)
    widths = {n: float(np.nanmedian([c.widths[n] for c in done])) for n in MEASURES}
    print(f"{case.name}: {held:.1%} ({low:.0%}-{high:.0%}) of {len(done)} records; {widths}")
    assert len(seeds) > 0.8 * RECORDS
    assert len(done) > 0.9 * len(seeds)
    assert high >= case.asked
    assert max(widths.values()) < 0.2
    assert max(w for n, w in widths.items() if "overshoot" in n) < 0.1


@pytest.mark.study(turn=13)
def test_a_record_counts_the_same_twice():
    assert count(CASES[0], 3) == count(CASES[0], 3)


@pytest.mark.study(turn=14)
def test_what_noise_leaves_alone_does_not():
    """What the ranges are for: with an effect hidden the parameters' errors hold about half."""
    held = {"whole": [], "noise": []}
    for seed in range(FIRST, FIRST + 8):
        ship = hidden_world(CASES[0].conditions, seed, EVERY)
        fit = fit_of(CASES[0], ship, seed)
        truth = {m.criterion.name: m.value for m in predict([vessel_of(fit, ship.true.model)])}
        for kind, catalogue in (("whole", CATALOGUE), ("noise", {})):
            for m in ranges(fit, catalogue):
                low, high = m.interval
                held[kind].append(low <= truth[m.criterion.name] <= high)
    assert np.mean(held["whole"]) > 0.9
    assert np.mean(held["noise"]) < 0.8
