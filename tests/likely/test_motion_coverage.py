"""How often the range of a predicted motion holds what the true ship does, on fresh seeds."""

import numpy as np
import pytest
from measures_coverage import CASES, fitted
from typical import spread_of

from trialid.design.following import sailed_ship, vessel_of
from trialid.design.helm import carry_out
from trialid.design.prediction.predicted_motion import sail_manoeuvre
from trialid.design.standard import LENGTHS, STEPS, STRAIGHT, in_calm
from trialid.effects import CATALOGUE
from trialid.workflow.use.orders import named_manoeuvre

RECORDS, FIRST = 12, 40000
ASKED = ("zigzag", "15", "15")
MOTIONS = ("r", "phi", "psi", "v")


def holds(case, seed):
    """Share of the times at which each motion's range holds the true ship's; None: no fit."""
    record = fitted(case, seed)
    if record is None:
        return None
    ship, fit = record
    spread = spread_of(fit, CATALOGUE)
    asked = named_manoeuvre(ASKED)
    found = sail_manoeuvre(sailed_ship(fit), asked, spread, {})
    true = in_calm(vessel_of(fit, ship.true.model))
    one = STEPS * true.period
    sailed = carry_out(true, asked.told(), STRAIGHT * one, LENGTHS * one).trial.signals
    n = min(len(found.t), len(sailed["psi"]))
    shares = []
    for motion in MOTIONS:
        low, high = (end[:n] for end in found.ranges[motion])
        moving = slice(round(STRAIGHT * STEPS) + 1, n)
        inside = (low <= sailed[motion][:n] + 1e-9) & (sailed[motion][:n] - 1e-9 <= high)
        shares.append(float(np.mean(inside[moving])))
    return shares


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("place", [0, 3], ids=lambda k: CASES[k].name.replace(" ", "_"))
def test_ranges_of_a_motion_hold_what_the_true_ship_does(place):
    """Nine times of ten at the least, in a zig-zag of angles that were not fitted."""
    found = [holds(CASES[place], seed) for seed in range(FIRST, FIRST + RECORDS)]
    done = np.array([shares for shares in found if shares is not None])
    each = {n: f"{x:.1%}" for n, x in zip(MOTIONS, done.mean(axis=0), strict=True)}
    print(f"{CASES[place].name}: {len(done)} records, {each}")
    assert len(done) > 0.8 * RECORDS
    assert done.mean() > 0.88
