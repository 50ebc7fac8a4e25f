"""The optimum of a smaller model as a point of the larger one that grew from it."""

from collections.abc import Mapping

import numpy as np

from trialid.arrays import Vector
from trialid.identification.output_error import Problem, Unknown
from trialid.ship.model import ShipModel


def point_of_smaller(
    problem: Problem, known: Mapping[str, float], smaller: ShipModel
) -> Vector | None:
    """Each unknown where the smaller model had it; None where it can have been nowhere.

    Parameters
    ----------
    known
        The smaller model's estimates, by the unknown's name.
    """
    point = []
    for x in problem.unknowns:
        absent = _absent(problem, x, smaller)
        if x.name not in known and absent is None:
            return None
        point.append(known.get(x.name, absent))
    return np.array(point, dtype=float)


def _absent(problem: Problem, x: Unknown, smaller: ShipModel) -> float | None:
    """What an unknown is in a smaller model that does not seek it: held fixed, or not there."""
    if x.column in smaller.parameters:
        return smaller.value(x.column)
    parameter = problem.simulator.model.parameters.get(x.column)
    return x.start if parameter is None else parameter.null
