"""The least of a function over the unit cube, by evolution: for scores with kinks and steps.

Covariance matrix adaptation: Hansen, N. (2016), The CMA evolution strategy: a tutorial,
arXiv:1604.00772, with its own settings. Only the order of the scores counts, so that a penalty may
be of any size.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Score = Callable[[Vector], float]

SCATTER: Final = 0.1
"""Share of the candidates that is scattered over the cube at first."""
FIRST: Final = 0.25
"""Spread of the first generation about the best of them."""
FINE: Final = 1e-3
"""Spread at which a population has settled; then another begins elsewhere, twice as large."""


@dataclass(frozen=True)
class Best:
    """The best point that was tried, its score, and how many were tried."""

    x: Vector
    score: float
    tried: int


def evolve(score: Score, dimensions: int, candidates: int, seed: int) -> Best:
    """Try no more than so many candidates; the same seed gives the same best.

    >>> round(evolve(lambda x: float(np.sum((x - 0.3) ** 2)), 2, 300, 0).score, 6)
    0.0
    """
    rng = np.random.default_rng(seed)
    count = max(1, min(candidates, max(10, round(SCATTER * candidates))))
    best = _best(score, rng.random((count, dimensions)))
    size, start = 4 + int(3.0 * np.log(dimensions)), best.x
    while candidates - best.tried >= size:
        found = _population(score, start, size, candidates - best.tried, rng)
        tried = best.tried + found.tried
        winner = min(best, found, key=lambda b: b.score)
        best = Best(winner.x, winner.score, tried)
        size, start = 2 * size, rng.random(dimensions)
    return best


def _best(score: Score, points: Vector) -> Best:
    values = [score(x) for x in points]
    k = int(np.argmin(values))
    return Best(points[k], values[k], len(points))


def _population(
    score: Score, start: Vector, size: int, candidates: int, rng: np.random.Generator
) -> Best:
    """One population from a start until it has settled or the candidates are used up."""
    n, weights = len(start), _weights(size)
    mass = 1.0 / float(np.sum(weights**2))
    c_path, c_step, c_one, c_rank, damping = _rates(n, mass)
    expected = np.sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n**2))
    mean, sigma, C = start.copy(), FIRST, np.eye(n)
    path, step_path = np.zeros(n), np.zeros(n)
    best, tried = Best(start, np.inf, 0), 0
    while tried + size <= candidates and sigma > FINE:
        lengths, axes = _axes(C)
        drawn = mean + sigma * (rng.standard_normal((size, n)) * lengths) @ axes.T
        points = np.clip(drawn, 0.0, 1.0)
        values = np.array([score(x) for x in points])
        tried += size
        # of equals the one that was drawn less far outside
        order = np.lexsort((np.sum((drawn - points) ** 2, axis=1), values))
        if values[order[0]] < best.score:
            best = Best(points[order[0]], float(values[order[0]]), tried)
        steps = (points[order[: len(weights)]] - mean) / sigma
        y = weights @ steps
        mean = mean + sigma * y
        white = axes @ ((axes.T @ y) / lengths)
        step_path = (1.0 - c_step) * step_path + np.sqrt(c_step * (2.0 - c_step) * mass) * white
        pace = float(np.linalg.norm(step_path)) / expected
        path = (1.0 - c_path) * path
        if pace < 1.4 + 2.0 / (n + 1.0):
            path = path + np.sqrt(c_path * (2.0 - c_path) * mass) * y
        spread = (steps.T * weights) @ steps
        C = (1.0 - c_one - c_rank) * C + c_one * np.outer(path, path) + c_rank * spread
        sigma = min(sigma * float(np.exp(c_step / damping * (pace - 1.0))), 0.5)
    return Best(best.x, best.score, tried)


def _weights(size: int) -> Vector:
    """Weights of the better half, falling with the logarithm of the place; their sum is 1."""
    half = size // 2
    weights = np.log(half + 0.5) - np.log(np.arange(1, half + 1))
    return np.asarray(weights / weights.sum())


def _rates(n: int, mass: float) -> tuple[float, float, float, float, float]:
    """How fast the two paths and the covariance are learned, and the damping of the step."""
    c_path = (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n)
    c_step = (mass + 2.0) / (n + mass + 5.0)
    c_one = 2.0 / ((n + 1.3) ** 2 + mass)
    c_rank = min(1.0 - c_one, 2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0) ** 2 + mass))
    damping = 1.0 + 2.0 * max(0.0, np.sqrt((mass - 1.0) / (n + 1.0)) - 1.0) + c_step
    return c_path, c_step, c_one, c_rank, float(damping)


def _axes(C: Vector) -> tuple[Vector, Vector]:
    """Lengths and directions of the ellipsoid of a covariance; (n,), (n, n)."""
    squares, axes = np.linalg.eigh((C + C.T) / 2.0)
    return np.sqrt(np.maximum(squares, 1e-20)), axes
