"""A change that stands out once some voyages are left out, each off alone by whatever it was.

Two voyages with another cargo hide a step ten times its scatter: they are the scatter as it is
found. Which voyages lie off is not known beforehand. For each change a fit by least absolute values
says which are furthest from it, and the change counts by what it takes off without them, against
all choices of so many voyages.
"""

from collections.abc import Sequence
from math import comb
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Vector
from trialid.fleet.changes.courses import (
    OFF,
    TINY,
    Course,
    Estimates,
    chance,
    columns_of,
    is_allowed,
    is_change,
)

FEW: Final = 6
"""Voyages that are left out at most: where more lie off there are so many others that a step of
their size stands out beside them."""
TURNS: Final = 20
"""Steps of the fit by least absolute values, and of that to the voyages nearest to it."""


def change_with_voyages_off(
    y: Estimates, chosen: Sequence[Course], tried: Sequence[Course], level: float
) -> list[Course]:
    """The best change beside those chosen with two voyages off or more; none if it is chance."""
    changes = [each for each in tried if is_change(each)]
    free = int(OFF * len(y)) - sum(not is_change(each) for each in chosen)
    few = min(FEW, free)
    if few < 2 or not changes:
        return []
    base = columns_of(y, chosen, level=True)
    own = columns_of(y, changes).T[:, :, None]
    columns = np.concatenate([np.broadcast_to(base, (len(changes), *base.shape)), own], axis=2)
    target = y.x / y.deviation
    far = _furthest(columns, target, few)
    best: tuple[float, list[Course]] = (level, [])
    for off in range(2, few + 1):
        kept = _without(far[:, :off], len(y))
        whole, rest = (_left(each, target, kept) for each in (columns[:, :, :-1], columns))
        freedom = len(y) - len(chosen) - 2 - off
        ways = len(changes) * comb(len(y), off) * (few - 1)
        for i in np.argsort(rest / np.maximum(whole, TINY))[:FEW]:
            courses: list[Course] = [changes[i], *(("alone", int(k)) for k in far[i, :off])]
            if {*courses} & {*chosen} or not is_allowed([*chosen, *courses], len(y)):
                continue
            p_value = ways * chance(y, whole[i] - rest[i], whole[i], 1, freedom)
            best = min(best, (p_value, courses), key=lambda each: each[0])
    return best[1]


def _furthest(columns: Vector, target: Vector, few: int) -> NDArray[np.intp]:
    """The voyages furthest from each fit that leaves so many out, the furthest first."""
    kept = np.ones(columns.shape[:2])
    for _ in range(TURNS):
        off = np.abs(_rest(columns, target, kept))
        kept = 1.0 / np.maximum(off, 1e-6 * off.max(axis=1, keepdims=True) + TINY)
    for _ in range(TURNS):
        order = np.argsort(-np.abs(_rest(columns, target, kept)), axis=1)
        kept = _without(order[:, :few], columns.shape[1])
    return order


def _without(far: NDArray[np.intp], voyages: int) -> Vector:
    """Weights of the voyages of each fit: 0 of those far off, else 1."""
    kept = np.ones((len(far), voyages))
    np.put_along_axis(kept, far, 0.0, axis=1)
    return kept


def _rest(columns: Vector, target: Vector, weights: Vector) -> Vector:
    """What each fit leaves of the voyages, (fits, n)."""
    heavy = columns * weights[:, :, None]
    square = np.einsum("mnq,mnr->mqr", heavy, columns)
    square += TINY * np.trace(square, axis1=1, axis2=2)[:, None, None] * np.eye(columns.shape[2])
    sizes = np.linalg.solve(square, np.einsum("mnq,n->mq", heavy, target)[:, :, None])
    return np.asarray(target - (columns @ sizes)[:, :, 0])


def _left(columns: Vector, target: Vector, kept: Vector) -> Vector:
    """The sum of squares that each fit leaves of the voyages that are kept."""
    return np.asarray((kept * _rest(columns, target, kept) ** 2).sum(axis=1))
