"""Whether changes are the best account of a record, or something that comes and goes is as good.

A season goes by date, loading by voyage, single voyages by themselves. Steps and drifts follow each
of them some way, and leave what is not independent from voyage to voyage; then they explain nothing
and are not told. What is told instead is that the parameter varies.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.stats import chi2

from trialid.arrays import Vector
from trialid.fleet.changes.courses import (
    EITHER_SIDE,
    OFF,
    TINY,
    Course,
    Estimates,
    chance,
    columns_of,
    courses_of,
    is_change,
    rest_of,
    sum_of_rest,
    take_away,
)

MARKED: Final = 0.1
"""Share of what changes take off the sum of squares that may be left beside them: a wave that
swings by half the size of a step in the middle. Of 40 records with a season and a step of its swing
39 are told as that step or as varying, with half of it all, with twice of it none."""
BETTER: Final = 0.5
"""Share of what another account leaves that one must leave to be markedly better: a wave than one
change, which says less than a wave; two changes than a wave, or those beside single voyages than
single voyages alone. Of 60 seasons of one swing in 16 voyages, six times the scatter, none is told
as a change with it, and 34 were where a wave was compared with all changes alike."""
NEAR: Final = 0.5
"""Share of a sum of squares that its smaller three quarters come to at most by chance: 0.40 with 40
voyages to 0.49 with eight, and 0.64 with six, at all levels from a half to 0.99."""
DOUBT: Final = 0.05
"""Share of changes that are taken for something else by chance."""


def is_best_account(y: Estimates, chosen: Sequence[Course]) -> bool:
    """Whether changes are markedly the best account of a record: nothing else is as good, or left.

    Else it is single voyages that lie off, a wave in the place of changes or beside them, or
    changes that leave more than the likely ranges do.
    """
    off, whole = [each for each in chosen if not is_change(each)], sum_of_rest(y, chosen)
    least = max(whole, y.least * (len(y) - len(chosen) - 1))
    changes, taken = len(chosen) - len(off), sum_of_rest(y, off) - whole
    if off and _left_by_single_voyages(y, len(off) + EITHER_SIDE * changes) < least / BETTER:
        return False
    waves = _waves(y)
    by_wave = min(_left_by(*take_away(y, [], wave)) for wave in waves)
    if by_wave < least * (BETTER if changes == 1 else 1.0 / BETTER):
        return False
    return not (_wave_beside(y, chosen, waves, MARKED * taken) or _unlike(y, chosen, taken))


def _wave_beside(
    y: Estimates, chosen: Sequence[Course], waves: Sequence[Vector], marked: float
) -> bool:
    """Whether a wave stands out beside the changes, or beside another change in their place."""
    whole, freedom = sum_of_rest(y, chosen), len(y) - len(chosen) - 3
    tried = [each for each in courses_of(y.time) if is_change(each)]
    off = [each for each in chosen if not is_change(each)]
    by_both = min(_left_by(*take_away(y, chosen, wave)) for wave in waves)
    by_other = min(_left_by_wave_and_change(y, off, wave, tried) for wave in waves)
    return any(
        whole - left > marked and ways * chance(y, whole - left, whole, 2, freedom) <= DOUBT
        for left, ways in ((by_both, len(waves)), (by_other, len(waves) * len(tried)))
    )


def _unlike(y: Estimates, chosen: Sequence[Course], taken: float) -> bool:
    """Whether changes leave more than the likely ranges; a quarter of the voyages may lie off."""
    near = np.sort(rest_of(y, chosen) ** 2)[: len(y) - int(OFF * len(y))]
    square = float(near.sum()) / NEAR
    return square > MARKED * taken and bool(chi2.sf(square, len(near) - 1) <= DOUBT)


def _left_by_single_voyages(y: Estimates, off: int) -> float:
    """The sum of squares that one level leaves of the voyages that are nearest to it."""
    order, kept = np.argsort(y.x), len(y) - off
    lefts = []
    for first in range(off + 1):
        near = order[first : first + kept]
        weight = y.deviation[near] ** -2
        level = np.average(y.x[near], weights=weight)
        lefts.append(float(weight @ (y.x[near] - level) ** 2))
    return min(lefts)


def _waves(y: Estimates) -> list[Vector]:
    """Weighted waves that the record holds whole: once in all of it up to each second voyage.

    Half-whole numbers of waves stand between, so that none is off by more than a quarter. By date
    no quarter of a wave falls between two voyages: three campaigns in three years lie on one
    whatever they show.
    """
    clocks = [(np.arange(float(len(y))), 0.5)]
    if y.days is not None and y.days[-1] > y.days[0]:
        clocks.append((y.days, 0.25))
    made = []
    for clock, part in clocks:
        share = (clock - clock[0]) / (clock[-1] - clock[0]) * (len(y) - 1) / len(y)
        for times in np.arange(1.0, part / np.diff(share).max() + 0.25, 0.5):
            angle = 2.0 * np.pi * times * share
            made.append(np.stack([np.cos(angle), np.sin(angle)], axis=1) / y.deviation[:, None])
    return made


def _left_by(columns: Vector, target: Vector) -> float:
    """The sum of squares that columns leave."""
    rest = _without(columns, target)
    return float(rest @ rest)


def _without(columns: Vector, target: Vector) -> Vector:
    return np.asarray(target - columns @ np.linalg.lstsq(columns, target, rcond=1e-6)[0])


def _left_by_wave_and_change(
    y: Estimates, off: Sequence[Course], wave: Vector, tried: Sequence[Course]
) -> float:
    """The sum of squares that a wave and the best change beside it leave."""
    both, target = take_away(y, off, np.hstack([wave, columns_of(y, tried)]))
    rest, changes = _without(both[:, :2], target), _without(both[:, :2], both[:, 2:])
    own = (changes**2).sum(axis=0)
    gains = np.where(own > TINY, (changes.T @ rest) ** 2 / np.maximum(own, TINY), 0.0)
    return float(rest @ rest - gains.max())
