"""The rudder's zero of a ship that nobody has sailed yet, as her trials tell it.

A rudder that has to stand off amidships for a straight course is a screw's push to one side, or a
feedback that reads wrong. The record cannot tell them apart: by the recorded rudder she turns to
both sides unlike in either case, by the true one in the first alone.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.accuracy.likely import Standing
from trialid.arrays import Vector
from trialid.effects import CATALOGUE
from trialid.identification.check.common_values import Common
from trialid.identification.fit import Fit
from trialid.ship.model import ShipModel

ZERO: Final = "delta_0"
OFFSET: Final = CATALOGUE["rudder_offset"]
FEEDBACKS: Final = 0.5
"""How likely it is the feedback's, which a ship has not: nothing is known of it beforehand. A range
then reaches 1.39 times as far as from the one to the other; with half of it 0.98 times, short of a
ship without, with twice 1.96 times."""


def with_rudders_zero(fit: Fit) -> ShipModel:
    """The fitted model with the zero that her trials have together, where each has its own."""
    found = _of_each_trial(fit)
    return fit.model if found is None else with_zero_at(fit.model, found.mean)


def with_zero_at(model: ShipModel, zero: float) -> ShipModel:
    """A model whose rudder stands off its record by so much [rad]; its own where it has one."""
    return model if _has_it(model) else (model + OFFSET).with_values({ZERO: zero})


def _of_each_trial(fit: Fit) -> Common | None:
    return None if _has_it(fit.model) else fit.of_all_trials.get(ZERO)


def _has_it(model: ShipModel) -> bool:
    return OFFSET.name in {effect.name for effect in model.effects}


@dataclass(frozen=True)
class OfUnknowns:
    """What is known of the unknowns of a fit: their columns, covariance, and how models stand."""

    names: tuple[str, ...]
    covariance: Vector
    standing: Standing


def extend_by_zero(fit: Fit, known: OfUnknowns) -> OfUnknowns:
    """The same with the ship's own zero behind the others; as it is where trials have none.

    It is uncertain by the trials' own, whose mean it is, by what they differ by, as the next trial
    will, and by what it would be if it were the feedback's alone: none.
    """
    found = _of_each_trial(fit)
    if found is None:
        return known
    from_own = np.zeros((1, len(known.names)))
    from_own[0, [*found.places]] = found.weights
    every = np.concatenate([np.eye(len(known.names)), from_own])
    covariance = every @ known.covariance @ every.T
    covariance[-1, -1] += found.variance + FEEDBACKS * found.mean**2
    reduced = replace(known.standing.known, moves=every @ known.standing.known.moves)
    standing = replace(known.standing, known=reduced)
    return OfUnknowns((*known.names, ZERO), covariance, standing)
