"""Steps of a search tell of those to come; where they lead astray they are asked more seldom."""

import numpy as np
import pytest

from trialid.arrays import Vector
from trialid.least_squares.anderson import REMEMBERED, Steps
from trialid.least_squares.gauss_newton import minimise

ALL = np.ones(REMEMBERED, dtype=np.bool_)
ONE = np.eye(REMEMBERED)


def contraction(seed: int) -> tuple[Vector, Vector]:
    """A map x -> A x + b that shrinks by up to 0.9, as many directions as points are remembered."""
    rng = np.random.default_rng(seed)
    Q = np.linalg.qr(rng.standard_normal((REMEMBERED, REMEMBERED)))[0]
    return Q @ np.diag(np.linspace(0.3, 0.9, REMEMBERED)) @ Q.T, rng.standard_normal(REMEMBERED)


@pytest.mark.parametrize("seed", range(5))
def test_of_a_linear_map_as_many_points_as_directions_tell_where_it_ends(seed: int) -> None:
    A, b = contraction(seed)
    end = np.linalg.solve(np.eye(REMEMBERED) - A, b)
    steps, x = Steps(), np.zeros(REMEMBERED)
    for _ in range(REMEMBERED + 1):
        step = A @ x + b - x
        mixed = steps.mixed(x, step, ALL, ONE)
        x = x + (step if mixed is None else mixed)
    np.testing.assert_allclose(x, end, atol=1e-9)


def test_points_at_which_a_bound_held_others_are_forgotten() -> None:
    steps = Steps()
    assert steps.mixed(np.zeros(REMEMBERED), np.ones(REMEMBERED), ALL, ONE) is None
    held = ALL.copy()
    held[0] = False
    assert steps.mixed(np.ones(REMEMBERED), 0.5 * np.ones(REMEMBERED), held, ONE) is None
    assert steps.mixed(np.ones(REMEMBERED), 0.2 * np.ones(REMEMBERED), held, ONE) is not None


def test_each_time_they_lead_astray_they_wait_twice_as_long() -> None:
    steps, asked = Steps(), []
    for k in range(40):
        point, step = np.full(REMEMBERED, float(k)), np.full(REMEMBERED, 1.0 / (k + 1.0))
        if steps.mixed(point, step, ALL, ONE) is not None:
            asked.append(k)
            steps.judge(False)
    assert np.diff(asked).tolist() == [2, 4, 8, 16]


@pytest.mark.parametrize(("bend", "most"), [(0.5, 10), (0.8, 12), (0.95, 20)])
def test_a_search_with_a_large_residual_arrives_in_a_few_steps(bend: float, most: int) -> None:
    """Of x + 1 and bend x^2 + x - 1 each step is `bend` of the last: 25, 68 and 236 points."""

    def evaluate(x: Vector) -> tuple[Vector, Vector]:
        model = np.array([x[0] + 1.0, bend * x[0] ** 2 + x[0] - 1.0])
        return -model, np.array([[1.0], [2.0 * bend * x[0] + 1.0]])

    found = minimise(evaluate, np.array([0.4]), np.ones(1), max_iterations=200)
    assert found.converged
    assert found.theta[0] == pytest.approx(0.0, abs=1e-7)
    assert found.evaluations <= most
