"""Where a motion may lie: what follows an order goes no farther than that or itself."""

import numpy as np
import pytest
from s175q import MODEL, SHAFT
from typical import known_by

from trialid.design.helm import vessel
from trialid.design.prediction.predicted_motion import sail_manoeuvre
from trialid.design.prediction.ranged_motion import _possible
from trialid.workflow.use.orders import named_manoeuvre

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


def test_a_gear_that_overshoots_lies_as_far_beyond_as_nobody_knows() -> None:
    """Of second order, and damped by nobody knows how little."""
    after = np.exp(-(T % 10.0)) * np.sin(T % 10.0)  # how far it goes beyond
    motion = ORDER * (1.0 + 0.1 * after)
    off = 0.2 * np.abs(ORDER) * np.abs(after)
    _, upper = _possible("delta", {"delta": motion, "delta_order": ORDER}, (-off, off))
    assert upper.max() > motion.max() + 0.7 * off[np.argmax(motion)]


def test_where_its_range_is_not_known_the_rest_of_it_is() -> None:
    off = np.where(T < 3.0, np.nan, STEEP)
    _, upper = _possible("delta", {"delta": FOLLOWS, "delta_order": ORDER}, (-off, off))
    assert np.array_equal(np.isnan(upper), T < 3.0)


def test_what_nobody_ordered_may_be_anywhere_that_it_can() -> None:
    lower, upper = _possible("r", {"r": FOLLOWS}, (-STEEP, STEEP))
    assert np.array_equal(lower, FOLLOWS - STEEP)
    assert np.array_equal(upper, FOLLOWS + STEEP)


def test_no_number_of_a_manoeuvre_is_likely_below_zero():
    """Of an outsider's boat a tactical diameter was likely from -2214 m."""
    wide = known_by("Nr", 20.0 * abs(MODEL.value("Nr")))
    ship = vessel(MODEL, 0.5, {"n": SHAFT}, np.deg2rad(5.0))
    for words in (["circle", "35"], ["zigzag", "20", "20"]):
        numbers = sail_manoeuvre(ship, named_manoeuvre(words), wide, {}).numbers
        lows = [ends[0] for _, ends in numbers.values()]
        assert min(lows) == 0.0
        assert all(value < ends[1] for value, ends in numbers.values())
