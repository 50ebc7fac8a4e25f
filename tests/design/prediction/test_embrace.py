"""Ranges of a prediction hold what another model of the ship does, as far as that goes."""

import numpy as np
import pytest

from trialid.design.prediction.embrace import embrace
from trialid.design.prediction.ranged_motion import PredictedMotion


def predicted(t, low, high, **numbers):
    """A rate of turn likely between two ends, the same at all times."""
    t = np.asarray(t)
    ends = {"r": (np.full(len(t), low), np.full(len(t), high))}
    motion = {"r": np.full(len(t), 0.5 * (low + high))}
    return PredictedMotion(t=t, given={}, motion=motion, ranges=ends, numbers=numbers)


def test_it_holds_the_other_s_as_far_as_that_goes():
    own = predicted([0.0, 1.0, 2.0, 3.0], -1.0, 1.0)
    found = embrace(own, predicted([0.0, 0.7, 1.4, 2.1], 0.5, 4.0))
    assert found.ranges["r"][0] == pytest.approx([-1.0] * 4)
    assert found.ranges["r"][1] == pytest.approx([4.0, 4.0, 4.0, 1.0])
    assert found.motion["r"] == pytest.approx(own.motion["r"])


def test_numbers_keep_their_values_and_hold_the_other_s_ranges():
    own = predicted(
        [0.0], -1.0, 1.0, advance=(5.0, (4.0, 6.0)), transfer=(2.0, None), x=(1.0, (0, 2))
    )
    other = predicted([0.0], -1.0, 1.0, advance=(7.0, (5.5, 8.0)), transfer=(3.0, (1.0, 4.0)))
    assert embrace(own, other).numbers == {
        "advance": (5.0, (4.0, 8.0)),
        "transfer": (2.0, None),
        "x": (1.0, (0, 2)),
    }


def test_what_nobody_knows_stays_unknown():
    own = predicted([0.0, 1.0], -1.0, 1.0)
    own.ranges["r"][1][0] = np.nan
    other = predicted([0.0, 1.0], -3.0, 2.0)
    other.ranges["r"][0][1] = np.nan
    low, high = embrace(own, other).ranges["r"]
    assert low == pytest.approx([-3.0, -1.0])
    assert np.isnan(high[0])
    assert high[1] == 2.0
    own.ranges["phi"] = own.ranges["r"]
    assert embrace(own, other).ranges["phi"] is own.ranges["phi"]
