"""A ship that leaves her model's domain ends a prediction, unless it ended long before."""

import numpy as np
import pytest

from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.simulation.integrate import Departure


@pytest.mark.parametrize(
    ("at", "ends"), [(10.0, True), (10.2, True), (146.2, False), (None, False)]
)
def test_what_ended_before_she_left_is_whole(at, ends):
    gone = None if at is None else Departure("r", at, -4.2)
    t = np.arange(0.0, 10.05, 0.1)
    made = PredictedMotion(t=t, given={}, motion={}, ranges={}, departure=gone)
    assert made.ended_by_departure is ends
