"""Where a search cannot begin."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, zigzag

from trialid.identification.one_search import no_start
from trialid.identification.problem import pose_problem
from trialid.least_squares.gauss_newton import minimise

X = np.array([1.0, 2.0, 3.0, 4.0])


def test_where_nothing_can_be_simulated() -> None:
    end = minimise(lambda b: None, np.array([1.0, 2.0]), np.ones(2))
    assert end.reason == "start"
    assert not end.converged
    assert end.evaluations == 1
    assert end.iterations == ()
    np.testing.assert_array_equal(end.theta, [1.0, 2.0])


def test_where_squares_of_slopes_are_no_numbers() -> None:
    """An unstable ship from a random start: they passed as numbers and overflowed a step later."""
    end = minimise(lambda b: (X, 1e176 * X[:, None]), np.array([1.0]), np.ones(1))
    assert end.reason == "start"


def test_where_the_model_overflows_there_is_no_warning() -> None:
    def steep(b):
        y = np.exp(1e4 * b)
        return 1.0 - 0.0 * y, y[:, None]

    assert minimise(steep, np.array([1.0]), np.ones(1)).reason == "start"


@pytest.mark.parametrize(
    ("value", "said"), [(9.0, " (first of all of Kp = 9, usually at most 0)"), (None, "bounds")]
)
def test_a_value_that_no_ship_has_is_the_first_to_look_at(value, said) -> None:
    """Beside one that any may have, a rate of turn that grows by itself."""
    wrong = {"Nr": 5.0} if value is None else {"Nr": 5.0, "Kp": value}
    problem = pose_problem([zigzag(10)], MODEL.with_values(wrong), replace(SETTINGS, free=("Nv",)))
    assert str(no_start(problem)).endswith(said)
