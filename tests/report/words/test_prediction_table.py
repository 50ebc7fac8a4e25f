"""The numbers of a predicted manoeuvre in a terminal."""

import numpy as np
import pytest

from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.report.terminal.prediction import prediction_table


@pytest.mark.parametrize(
    ("value", "ends", "shown"),
    [
        (-4.2e-16, (-0.15, 0.14), "0.000"),
        (4.2e-16, (-0.15, 0.14), "0.000"),
        (-4.2e-10, (-0.15, 0.14), "-4.200e-10"),
        (4.2e-16, (4.2e-16, 4.2e-16), "4.200e-16"),  # a range of no width tells no rounding
        (4.2e-16, None, "4.200e-16"),
    ],
)
def test_what_rounding_left_of_nothing_is_nothing(value, ends, shown):
    numbers = {"deviation [m]": (value, ends)}
    made = PredictedMotion(t=np.arange(3.0), given={}, motion={}, ranges={}, numbers=numbers)
    _, table, _ = prediction_table("stop", made, ())
    assert [str(cell) for cell in table.columns[1].cells] == [shown]


@pytest.mark.parametrize(("side", "shown"), [(1.0, "5 2.5 6"), (-1.0, "-5 -6 -2.5")])
def test_how_far_a_motion_goes_may_be_at_another_time(side, shown):
    """Of an outsider's speeds the range at the time of the lowest was a hundredth as wide."""
    t, motion = np.arange(4.0), side * np.array([0.0, 4.0, 5.0, 1.0])
    off = np.array([0.0, 2.0, 0.0, 0.0]), np.array([0.0, -1.5, -4.0, 0.0])
    lower, upper = sorted((motion + side * x for x in off), key=lambda x: x[1])
    made = PredictedMotion(t=t, given={}, motion={"v": motion}, ranges={"v": (lower, upper)})
    _, table = prediction_table("turn", made, ())
    cells = [str(next(iter(column.cells))) for column in table.columns[2:]]
    assert cells == [f"{float(x):#.4g}" for x in shown.split()]


def test_a_range_that_nobody_knows_is_a_dash():
    nobody = np.full(3, np.nan)
    motion = {"v": np.array([0.0, 1.0, 2.0])}
    made = PredictedMotion(
        t=np.arange(3.0), given={}, motion=motion, ranges={"v": (nobody, nobody)}
    )
    _, table = prediction_table("turn", made, ())
    assert [str(next(iter(column.cells))) for column in table.columns[3:]] == ["\u2013", "\u2013"]
