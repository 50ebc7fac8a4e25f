"""Where a search cannot begin."""

import numpy as np

from trialid.identification.gauss_newton import minimise

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
