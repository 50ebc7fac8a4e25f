"""What a trial to check is simulated with: the parameters, and its sensors as they mostly are.

Trials do not tell a sensor's number equally well. Where a turn leaves the rudder's zero open by a
degree and two zig-zags know it to a fiftieth, the plain mean of all is nobody's.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.identification.output_error import Problem, linearise
from trialid.simulation.integrate import Departure

LEAST: Final = 1e-30
"""A variance that is none, of a record without noise; one over it is of what no record moves."""

UNKNOWN: Final = 1e-12
"""Squared sine of the angle to all other columns at which a record tells nothing of an unknown."""


@dataclass(frozen=True)
class Common:
    """What all trials have of something that is each one's own.

    Attributes
    ----------
    mean, variance
        Over the trials, and between them.
    places, weights
        Of each trial's own among the unknowns, and its part in the mean; (n,) each.
    """

    mean: float
    variance: float
    places: tuple[int, ...]
    weights: Vector


def common_values(problem: Problem, theta: Vector, level: float) -> Mapping[str, Common]:
    """Shared parameters, and of what belongs to each trial the mean over them; by the column.

    Parameters
    ----------
    level
        What one independent row of the fit is uncertain by: see `Weighing`.
    """
    gathered: dict[str, list[int]] = {}
    for i, x in enumerate(problem.unknowns):
        if not x.column.endswith("(0)"):
            gathered.setdefault(x.column, []).append(i)
    if all(len(places) == 1 for places in gathered.values()):
        return {n: Common(float(theta[i]), 0.0, (i,), np.ones(1)) for n, (i,) in gathered.items()}
    variances = _variances(problem, theta, level)
    found = {}
    for name, places in gathered.items():
        weights, between = weights_between(theta[places], variances[places])
        found[name] = Common(float(weights @ theta[places]), between, tuple(places), weights)
    return found


def weights_between(values: Vector, variances: Sequence[float] | Vector) -> tuple[Vector, float]:
    """Weights of values that are known unequally well and differ too; the variance between them.

    Each weighs by its own variance and that between them, which is what their scatter has beyond
    their own: DerSimonian & Laird (1986), Controlled Clinical Trials 7, 177-188.
    """
    weights, between = 1.0 / np.clip(variances, LEAST, 1.0 / LEAST), 0.0
    if len(values) > 1:
        mean = float(weights @ values) / float(weights.sum())
        excess = float(weights @ (values - mean) ** 2) - (len(values) - 1)
        span = float(weights.sum() - (weights @ weights) / weights.sum())
        between = max(excess, 0.0) / span if span > 0.0 else 0.0
        weights = 1.0 / (1.0 / weights + between)
    return weights / weights.sum(), between


def _variances(problem: Problem, theta: Vector, level: float) -> Vector:
    """Of all unknowns, with what is known beforehand; (n_theta,)."""
    point = linearise(problem, theta)
    assert not isinstance(point, Departure)
    normal = point[1].T @ point[1]
    for i, x in enumerate(problem.unknowns):
        normal[i, i] += (level / x.prior[1]) ** 2 if x.prior else 0.0
    size = np.sqrt(np.maximum(np.diag(normal), LEAST**2))
    unit = normal / np.outer(size, size) + UNKNOWN * np.eye(len(size))
    return np.asarray(level**2 * np.diag(np.linalg.inv(unit)) / size**2)
