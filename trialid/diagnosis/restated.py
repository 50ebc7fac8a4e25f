"""Effects that say again what a free parameter of the model says: no doubt of it comes from them.

A metacentric height that was stated wrong is nothing beside one that is fitted: whatever the error,
what is fitted is the whole.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect, Force, Mass

PLACES: Final = 5
"""Draws of all signals at which two forces have to be one; two tell any two of the catalogue apart
already."""

ALIKE: Final = 1e-9
"""Of what rounding leaves."""


def restates(effect: Effect, fit: Fit) -> bool:
    """Whether an effect of one parameter does exactly what a free one of the model does."""
    free = {x.column for x in fit.problem.unknowns}
    if effect.forms == (Mass,):
        return {*effect.acts_on(Mass)} <= free
    if effect.forms != (Force,) or len(effect.parameters) != 1:
        return False
    [name] = effect.parameters
    return any(
        _is_one((effect, name), (other, own))
        for other in fit.problem.simulator.model.effects
        if other.forms == (Force,) and other.system == effect.system
        for own in free & {*other.parameters}
    )


def _is_one(here: tuple[Effect, str], there: tuple[Effect, str]) -> bool:
    """Whether a unit of the one is so many units of the other, whatever the ship does."""
    signals = sorted({*here[0].signals, *there[0].signals})
    drawn = np.random.default_rng(0).uniform(0.5, 1.5, (PLACES, len(signals)))
    each = [dict(zip(signals, row.tolist(), strict=True)) for row in drawn]
    one, other = (np.ravel([_push(*of, values) for values in each]) for of in (here, there))
    sizes = float(np.linalg.norm(one) * np.linalg.norm(other))
    return sizes > 0.0 and abs(float(one @ other)) > (1.0 - ALIKE) * sizes


def _push(effect: Effect, name: str, signals: Mapping[str, float]) -> Vector:
    """What a unit of a parameter adds to the forces; (4,)."""
    [with_it] = effect({**signals, **effect.nulls, name: 1.0})
    [without] = effect({**signals, **effect.nulls})
    assert isinstance(with_it, Force)
    assert isinstance(without, Force)
    return np.array(with_it) - np.array(without)
