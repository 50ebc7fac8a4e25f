"""Changes of a ship's parameters in the course of her voyages: a step or a drift, and when.

The estimates of a parameter scatter about one level until something changes: from voyage k on they
lie at another level (a step), or leave it evenly (a drift). Single voyages may lie off, each alone:
that competes with changes, and is none. Such courses are fitted by least squares, each voyage
weighted by its likely range. What one takes off the sum of squares, over what is left, follows
Fisher's F where nothing changes; the scatter counts as it is found, and never less than the noise
leaves. The best course, the best two at once, or the best change with some voyages off, count as
found where even the best of all that were tried, over all parameters and ships of the fleet, would
be as good by chance in one fleet of twenty (Bonferroni). The voyages' errors are taken to be
independent: changes that leave a season or an alternation explain nothing, and are not told.

What a model lacks pushes its parameters alike in like trials. Where trials are sailed otherwise
from some voyage on, that push may change as far as the likely ranges go: only a change that exceeds
them is surely one of the ship, and each says whether it does.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb
from typing import Final

import numpy as np
from scipy.stats import chi2

from trialid.arrays import Vector
from trialid.fleet.changes import trimmed
from trialid.fleet.changes.courses import (
    TINY,
    Course,
    Estimates,
    Form,
    chance,
    column,
    columns_of,
    courses_of,
    is_allowed,
    is_change,
    sizes_of,
    sum_of_rest,
    take_away,
)
from trialid.fleet.changes.rival_accounts import is_best_account

SWEEPS: Final = 4
"""Times that the changes of a parameter are dated anew, each with the others as they stand."""
WAYS: Final = 3
"""In which a course is sought: by itself, two at once, and one with some voyages off."""


@dataclass(frozen=True)
class Found:
    """A change in a record: its size per unit of its course, its p-value, and when it can be."""

    course: Course
    size: float
    level: float
    p_value: float
    ends: tuple[int, int]


@dataclass(frozen=True)
class Varies:
    """Estimates that differ from voyage to voyage, as no change tells: the furthest off its level.

    `beyond`: whether they differ by more than the likely ranges.
    """

    voyage: int
    size: float
    level: float
    p_value: float
    beyond: bool


@dataclass(frozen=True)
class Explained:
    """What is told of one record: changes in their order, and what they leave."""

    changes: tuple[Found, ...]
    varies: Varies | None


def explain(y: Estimates, level: float) -> Explained:
    """The changes of one record and what else varies; `level`: how often either is by chance."""
    tried = courses_of(y.time)
    chosen: list[Course] = []
    while more := _next(y, chosen, tried, level):
        chosen = _dated_anew(y, [*chosen, *more], tried)
    chosen = sorted(_worth_keeping(y, chosen, level), key=lambda course: course[1])
    found = tuple(_found(y, chosen, i) for i, one in enumerate(chosen) if is_change(one))
    if not found or is_best_account(y, chosen):
        return Explained(found, _varies(y, chosen, level))
    unlikely = min(each.p_value for each in found)
    return Explained((), _varies(y, [], level) or _furthest(y, [], unlikely, beyond=False))


def _next(
    y: Estimates, chosen: Sequence[Course], tried: Sequence[Course], level: float
) -> list[Course]:
    """The best course beside those chosen, or the best of several at once; none if it is chance."""
    tried = [each for each in tried if each not in chosen]
    columns, target = take_away(y, chosen, columns_of(y, tried))
    products, lengths = columns.T @ target, columns.T @ columns
    own = np.maximum(np.diag(lengths), TINY)
    freedom, whole = len(y) - len(chosen) - 2, float(target @ target)
    alone = products**2 / own
    one = _first_allowed(y, chosen, tried, alone)
    if one and chance(y, alone[one], whole, 1, freedom) * len(tried) <= level / WAYS:
        return [tried[i] for i in one]
    area = np.outer(own, own) - lengths**2
    area[area < TINY * np.outer(own, own)] = np.inf  # two that are one
    cross = 2.0 * lengths * np.outer(products, products)
    both = (np.outer(products**2, own) + np.outer(own, products**2) - cross) / area
    two = _first_allowed(y, chosen, tried, both)
    pairs = comb(len(tried), 2)
    if two and chance(y, both[two], whole, 2, freedom - 1) * pairs <= level / WAYS:
        return [tried[i] for i in two]
    return trimmed.change_with_voyages_off(y, chosen, tried, level / WAYS)


def _first_allowed(
    y: Estimates, chosen: Sequence[Course], tried: Sequence[Course], gains: Vector
) -> tuple[int, ...]:
    """The place of the largest gain whose courses may stand beside those chosen."""
    for flat in np.argsort(gains, axis=None)[::-1]:
        place = tuple(int(i) for i in np.unravel_index(flat, gains.shape))
        if is_allowed([*chosen, *(tried[i] for i in place)], len(y)):
            return place
    return ()


def _worth_keeping(y: Estimates, chosen: list[Course], level: float) -> list[Course]:
    """Those that the others do not make needless, the most needless left out first."""
    while chosen:
        worth = [_p_value(y, chosen, i) for i in range(len(chosen))]
        worst = int(np.argmax(worth))
        if worth[worst] <= level:
            break
        chosen = chosen[:worst] + chosen[worst + 1 :]
    return chosen


def _best(y: Estimates, chosen: Sequence[Course], tried: Sequence[Course]) -> Course | None:
    """The course that leaves least beside those that are chosen."""
    open_ = [one for one in tried if one not in chosen and is_allowed([*chosen, one], len(y))]
    return min(open_, key=lambda each: sum_of_rest(y, [*chosen, each]), default=None)


def _dated_anew(y: Estimates, chosen: list[Course], tried: Sequence[Course]) -> list[Course]:
    """Each change dated again with the others as they stand, until none moves."""
    for _ in range(SWEEPS):
        before = list(chosen)
        for i in range(len(chosen)):
            others = chosen[:i] + chosen[i + 1 :]
            chosen[i] = _best(y, others, tried) or chosen[i]
        if chosen == before:
            break
    return chosen


def _p_value(y: Estimates, chosen: Sequence[Course], place: int) -> float:
    """How often chance makes as much of one of these, the best of all that were tried.

    Which single voyages beside it lie off was chosen, too.
    """
    others = [*chosen[:place], *chosen[place + 1 :]]
    whole = sum_of_rest(y, others)
    off = sum(not is_change(each) for each in others)
    ways = len(courses_of(y.time)) * comb(len(y), off)
    gain = whole - sum_of_rest(y, chosen)
    return min(1.0, ways * chance(y, gain, whole, 1, len(y) - len(chosen) - 1))


def _found(y: Estimates, chosen: Sequence[Course], place: int) -> Found:
    sizes = sizes_of(y, chosen)
    scatter = max(y.least, TINY, sum_of_rest(y, chosen) / (len(y) - len(sizes)))
    others = [*chosen[:place], *chosen[place + 1 :]]
    return Found(
        course=chosen[place],
        size=float(sizes[1 + place]),
        level=float(sizes[0]),
        p_value=_p_value(y, chosen, place),
        ends=_ends(y, others, chosen[place][0], scatter),
    )


def _ends(y: Estimates, others: Sequence[Course], form: Form, scatter: float) -> tuple[int, int]:
    """The least range of voyages that holds 95 % of the likelihood of when it begins."""
    tried = [each for each in courses_of(y.time) if each[0] == form and each not in others]
    leaves = np.array([sum_of_rest(y, [*others, each]) for each in tried]) / scatter
    likelihood = np.exp(-0.5 * (leaves - leaves.min()))
    order = np.argsort(-likelihood)
    held = np.cumsum(likelihood[order]) / likelihood.sum()
    within = order[: int(np.searchsorted(held, 0.95)) + 1]
    first = [tried[int(i)][1] for i in within]
    return min(first), max(first)


def _varies(y: Estimates, chosen: Sequence[Course], level: float) -> Varies | None:
    """Whether changes leave more than the likely ranges; single voyages that lie off are left."""
    rest = _rest(y, chosen) / y.deviation
    freedom = len(y) - 1 - sum(map(is_change, chosen))
    p_value = float(chi2.sf(rest @ rest, freedom))
    return _furthest(y, chosen, p_value, beyond=True) if p_value <= level else None


def _furthest(y: Estimates, chosen: Sequence[Course], p_value: float, *, beyond: bool) -> Varies:
    rest = _rest(y, chosen)
    voyage = int(np.argmax(np.abs(rest / y.deviation)))
    size = float(rest[voyage])
    return Varies(voyage, size, float(y.x[voyage]) - size, p_value, beyond)


def _rest(y: Estimates, chosen: Sequence[Course]) -> Vector:
    """What the level and the changes leave of each estimate."""
    level, *sizes = sizes_of(y, chosen)
    told = [s * column(c, y.time) for s, c in zip(sizes, chosen, strict=True) if is_change(c)]
    return np.asarray(y.x - level - sum(told, np.zeros(len(y))))
