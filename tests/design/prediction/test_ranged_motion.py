"""Where a motion may lie: what follows an order is nowhere that it was never told to be."""

import numpy as np
import pytest

from trialid.design.prediction.ranged_motion import _possible

T = np.arange(0.0, 40.0, 0.1)
ORDER = np.deg2rad(20.0) * np.sign(np.sin(2.0 * np.pi * T / 20.0 + 0.1))
FOLLOWS = np.convolve(ORDER, np.ones(5) / 5.0)[: len(T)]
"""In half a second; what comes of an instant that is not known is steep there."""

STEEP = 5.0 * np.abs(np.gradient(FOLLOWS))


@pytest.mark.parametrize("off", [0.0, np.deg2rad(0.5)])
def test_a_quick_rudder_lies_within_its_orders(off: float) -> None:
    signals = {"delta": FOLLOWS, "delta_order": ORDER}
    lower, upper = _possible("delta", signals, (-STEEP - off, STEEP + off))
    assert (FOLLOWS + STEEP).max() > np.deg2rad(25.0)
    assert upper.max() == pytest.approx(np.deg2rad(20.0) + off)  # a zero is off all the time
    assert lower.min() == pytest.approx(-np.deg2rad(20.0) - off)
    assert np.all(lower <= FOLLOWS)
    assert np.all(upper >= FOLLOWS)
    moved = STEEP > 0.0
    assert np.all((upper - lower)[moved] > 2.0 * off)


def test_what_nobody_ordered_may_be_anywhere_that_it_can() -> None:
    lower, upper = _possible("r", {"r": FOLLOWS}, (-STEEP, STEEP))
    assert np.array_equal(lower, FOLLOWS - STEEP)
    assert np.array_equal(upper, FOLLOWS + STEEP)
