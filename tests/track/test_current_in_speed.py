"""A current in a speed over ground is said where it is more than what nobody knows of it."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.design.wind_and_current import in_speed


def told(north, east, error):
    """What is said of this current, of either part so uncertain [m/s], in a boat of 5 m/s."""
    rows = [SimpleNamespace(name=n, freedom=np.inf) for n in ("Nv", "Uc_N", "Uc_E")]
    known = SimpleNamespace(parameters=rows, covariance=np.diag([1.0, error**2, error**2]))
    ship = SimpleNamespace(particulars={"U0": 5.0})
    fit = SimpleNamespace(theta=np.array([0.0, north, east]), model=SimpleNamespace(ship=ship))
    return in_speed(fit, known)


@pytest.mark.parametrize(
    ("north", "east", "words"),
    [(0.0, 0.8, "0.8 +-0.06 m/s to 090 +-4 deg"), (-0.3, 0.0, "to 180 +-11 deg")],
)
def test_one_that_is_sure_is_told_with_its_range_and_where_it_sets(north, east, words):
    [said] = told(north, east, 0.03)
    assert words in said


@pytest.mark.parametrize("error", [0.03, 0.0, np.nan])
def test_one_that_may_be_none_that_is_slight_or_unknown_is_not(error):
    """0.1 m/s is under two ranges of 0.06; 0.04 is under a hundredth of her speed."""
    assert told(0.1 if error else 0.04, 0.0, error) == ()
