import numpy as np
import pytest

from trialid.design.evolution import evolve


def bent_valley(x):
    """Rosenbrock's function on [-2, 2]; 0 at (1, 1)."""
    a, b = 4.0 * np.asarray(x) - 2.0
    return float((1 - a) ** 2 + 100 * (b - a**2) ** 2)


def test_the_least_of_a_bent_valley():
    best = evolve(bent_valley, 2, 1500, 0)
    assert best.score < 1e-4
    np.testing.assert_allclose(best.x, [0.75, 0.75], atol=0.01)


def test_the_least_of_a_stair():
    """A flat stair about (0.2, 0.7, 0.4): only the order of the scores counts."""
    least = np.array([0.2, 0.7, 0.4])
    best = evolve(lambda x: float(np.ceil(20 * np.abs(x - least)).sum()), 3, 800, 1)
    assert best.score <= 4.0


def test_the_least_may_lie_in_a_corner():
    best = evolve(lambda x: float(x.sum()), 4, 800, 2)
    np.testing.assert_allclose(best.x, 0.0, atol=0.01)


@pytest.mark.parametrize("candidates", [1, 9, 50, 333])
def test_no_more_candidates_than_allowed_all_in_the_cube(candidates):
    points = []

    def score(x):
        points.append(x.copy())
        return bent_valley(x)

    best = evolve(score, 2, candidates, 3)
    assert best.tried == len(points) <= candidates
    assert best.score == min(map(bent_valley, points))
    assert np.all((np.array(points) >= 0.0) & (np.array(points) <= 1.0))


def test_the_seed_decides():
    first, again, other = (evolve(bent_valley, 2, 200, seed) for seed in (5, 5, 6))
    np.testing.assert_array_equal(first.x, again.x)
    assert not np.array_equal(first.x, other.x)


def test_a_score_that_breaks_every_limit_alike_is_no_trouble():
    assert evolve(lambda x: 1e3, 3, 120, 0).score == 1e3
