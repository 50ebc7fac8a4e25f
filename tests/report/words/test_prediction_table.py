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
