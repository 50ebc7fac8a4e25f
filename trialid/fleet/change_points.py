"""Changes of a ship's parameters in the course of her voyages: a step or a drift, and when.

The estimates of a parameter scatter about one level until something changes: from voyage k on they
lie at another level (a step), or leave it evenly (a drift). A single voyage may lie off alone: that
competes with changes, and is none. Such courses are fitted by least squares, each voyage weighted
by its likely range. What one takes off the sum of squares, over what
is left, follows Fisher's F where nothing changes; the scatter counts as it is found, and never less
than the noise leaves. The best course, or the best two at once, count as found where even the best
of all that were tried, over all parameters and ships of the fleet, would be as good by chance in
one fleet of twenty (Bonferroni). The voyages' errors are taken to be independent.

What a model lacks pushes its parameters alike in like trials. Where trials are sailed otherwise
from some voyage on, that push may change as far as the likely ranges go: only a change that exceeds
them is surely one of the ship, and each says whether it does.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
from scipy.stats import f, norm

from trialid.arrays import Vector
from trialid.result.fleet_rows import ChangeRow, FittedRow, RunRow

LEVEL: Final = 0.05
"""Share of fleets without any change in which one is found."""
FEWEST: Final = 6
"""Voyages from which on changes are sought: two on either side, and two for the scatter."""
EITHER_SIDE: Final = 2
"""Voyages that a level takes, so that a change is more than a voyage that lies off."""
MOST: Final = 3
"""Changes of one parameter in one record."""
TINY: Final = 1e-12
"""Share of a column's square below which it is explained by the others."""
SWEEPS: Final = 4
"""Times that the changes of a parameter are dated anew, each with the others as they stand."""
NORMAL: Final = float(norm.ppf(0.975))
"""Half of a range that holds 95 %, in standard deviations."""

Form = Literal["step", "drift", "alone"]
Course = tuple[Form, int]
"""What changes from which voyage on."""


@dataclass(frozen=True)
class Estimates:
    """Estimates of one parameter by voyage, (n,).

    Attributes
    ----------
    deviation
        Standard deviations that the likely ranges stand for: how the voyages are weighted.
    least
        The least variance of a weighted estimate, that of the noise alone.
    """

    x: Vector
    deviation: Vector
    least: float = 0.0

    def __len__(self) -> int:
        return len(self.x)


@dataclass(frozen=True)
class Found:
    """A change in a record: its size per unit of its course, its p-value, and when it can be."""

    course: Course
    size: float
    level: float
    p_value: float
    ends: tuple[int, int]


def changes(runs: Iterable[RunRow], fitted: Iterable[FittedRow]) -> Iterator[ChangeRow]:
    """Every change in a fleet's records, ship by ship; runs that carry no verdict have no say."""
    sound = {row.run for row in runs if row.failure is None and row.verdict != "no fit"}
    records = list(_records(row for row in fitted if row.run in sound))
    for rows in records:
        estimates, unit = _estimates(rows)
        for found in find_changes(estimates, LEVEL / len(records)):
            row = _row(rows, estimates, found, len(records))
            yield replace(row, size=row.size * unit)


def _records(fitted: Iterable[FittedRow]) -> Iterator[list[FittedRow]]:
    """The records that are long enough: one parameter of one ship, done in one way, by voyage."""
    courses: dict[tuple[object, ...], list[FittedRow]] = {}
    for row in fitted:
        if row.kind == "physical" and row.value is not None and _deviation(row) > 0.0:
            courses.setdefault((row.ship, *row.varied, row.parameter), []).append(row)
    yield from (rows for rows in courses.values() if len(rows) >= FEWEST)


def _estimates(rows: Sequence[FittedRow]) -> tuple[Estimates, float]:
    """Estimates in units of their usual deviation, and that unit."""
    x = np.array([row.value for row in rows], dtype=float)
    deviation = np.array([_deviation(row) for row in rows])
    noise = np.array([row.standard_error or 0.0 for row in rows])
    unit = float(np.median(deviation))
    least = float(np.median((noise / deviation) ** 2))
    return Estimates(x / unit, deviation / unit, least), unit


def _deviation(row: FittedRow) -> float:
    """The standard deviation that a likely range stands for; 0 where there is none."""
    if row.likely_low is None or row.likely_high is None:
        return 0.0
    wide = 0.5 * (row.likely_high - row.likely_low) / NORMAL
    return wide if np.isfinite(wide) else 0.0


def find_changes(y: Estimates, level: float) -> tuple[Found, ...]:
    """The changes of one record, in their order; `level`: how often there are some by chance."""
    tried = courses_of(len(y))
    most = min(MOST, len(y) // EITHER_SIDE - 2)
    chosen: list[Course] = []
    while more := _next(y, chosen, level, most - len(chosen)):
        chosen = _dated_anew(y, [*chosen, *more], tried)
    chosen = _worth_keeping(y, chosen, level)
    chosen.sort(key=lambda course: course[1])
    found = (_found(y, chosen, i, len(tried)) for i in range(len(chosen)))
    return tuple(one for one in found if one.course[0] != "alone")


def _next(y: Estimates, chosen: Sequence[Course], level: float, most: int) -> list[Course]:
    """The best course beside those chosen, else the best two at once; none where it is chance."""
    tried = [each for each in courses_of(len(y)) if each not in chosen]
    columns, target = _beside(y, chosen, tried)
    products, lengths = columns.T @ target, columns.T @ columns
    own = np.maximum(np.diag(lengths), TINY)
    alone = products**2 / own
    freedom = len(y) - len(chosen) - 2
    best, whole = int(np.argmax(alone)), float(target @ target)
    if most >= 1 and _chance(y, alone[best], whole, 1, freedom) * len(tried) <= level / 2.0:
        return [tried[best]]
    area = np.outer(own, own) - lengths**2
    area[area < TINY * np.outer(own, own)] = np.inf  # two that are one
    cross = 2.0 * lengths * np.outer(products, products)
    both = (np.outer(products**2, own) + np.outer(own, products**2) - cross) / area
    i, j = (int(k) for k in np.unravel_index(np.argmax(both), both.shape))
    pairs = len(tried) * (len(tried) - 1) / 2.0
    if most >= 2 and _chance(y, both[i, j], whole, 2, freedom - 1) * pairs <= level / 2.0:
        return [tried[i], tried[j]]
    return []


def _beside(
    y: Estimates, chosen: Sequence[Course], tried: Sequence[Course]
) -> tuple[Vector, Vector]:
    """Columns of the courses tried and the estimates, weighted, without what is explained."""
    known, _ = np.linalg.qr(_columns(y, chosen, level=True))
    columns, target = _columns(y, tried), y.x / y.deviation
    return columns - known @ (known.T @ columns), target - known @ (known.T @ target)


def _columns(y: Estimates, courses: Sequence[Course], level: bool = False) -> Vector:
    ones = [np.ones(len(y))] if level else []
    made = [*ones, *(column(each, len(y)) for each in courses)]
    return np.reshape(made, (len(made), len(y))).T / y.deviation[:, None]


def _chance(y: Estimates, gain: float, whole: float, courses: int, freedom: int) -> float:
    """How often chance takes so much off a sum of squares by so many courses."""
    scatter = max(y.least, (whole - gain) / freedom, TINY)
    return float(f.sf(gain / courses / scatter, courses, freedom))


def _worth_keeping(y: Estimates, chosen: list[Course], level: float) -> list[Course]:
    """Those that the others do not make needless, the most needless left out first."""
    tried = len(courses_of(len(y)))
    while chosen:
        worth = [_p_value(y, chosen, i, tried) for i in range(len(chosen))]
        worst = int(np.argmax(worth))
        if worth[worst] <= level:
            break
        chosen = chosen[:worst] + chosen[worst + 1 :]
    return chosen


def courses_of(voyages: int) -> list[Course]:
    """What is tried: a change from each voyage on that leaves enough on either side, each alone."""
    steps: list[Course] = [("step", k) for k in range(EITHER_SIDE, voyages - EITHER_SIDE + 1)]
    drifts: list[Course] = [("drift", k) for k in range(1, voyages - EITHER_SIDE - 1)]
    alone: list[Course] = [("alone", k) for k in range(voyages)]
    return steps + drifts + alone


def column(course: Course, voyages: int) -> Vector:
    """What a course adds to the level, by voyage: 1 from the step on; of a drift 1 at the end.

    Of a voyage alone 1 there.

    >>> column(("step", 2), 4).tolist(), column(("drift", 2), 4).tolist()
    ([0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.5, 1.0])
    """
    form, first = course
    at = np.arange(voyages)
    if form == "step":
        return (at >= first).astype(float)
    if form == "alone":
        return (at == first).astype(float)
    return np.clip((at - first + 1.0) / (voyages - first), 0.0, None)


def _left(y: Estimates, chosen: Sequence[Course]) -> float:
    """The sum of squares that these courses leave."""
    _, target = _beside(y, chosen, [])
    return float(target @ target)


def _best(y: Estimates, chosen: Sequence[Course], tried: Sequence[Course]) -> Course | None:
    """The course that leaves least beside those that are chosen."""
    open_ = [each for each in tried if each not in chosen]
    return min(open_, key=lambda each: _left(y, [*chosen, each]), default=None)


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


def _p_value(y: Estimates, chosen: Sequence[Course], place: int, tried: int) -> float:
    """How often chance makes as much of one of these, the best of all that were tried."""
    whole = _left(y, [*chosen[:place], *chosen[place + 1 :]])
    gain = whole - _left(y, chosen)
    return min(1.0, tried * _chance(y, gain, whole, 1, len(y) - len(chosen) - 1))


def _found(y: Estimates, chosen: Sequence[Course], place: int, tried: int) -> Found:
    columns = _columns(y, chosen, level=True)
    sizes = np.linalg.lstsq(columns, y.x / y.deviation, rcond=None)[0]
    scatter = max(y.least, TINY, _left(y, chosen) / (len(y) - len(sizes)))
    others = [*chosen[:place], *chosen[place + 1 :]]
    return Found(
        course=chosen[place],
        size=float(sizes[1 + place]),
        level=float(sizes[0]),
        p_value=_p_value(y, chosen, place, tried),
        ends=_ends(y, others, chosen[place][0], scatter),
    )


def _ends(y: Estimates, others: Sequence[Course], form: Form, scatter: float) -> tuple[int, int]:
    """The least range of voyages that holds 95 % of the likelihood of when it begins."""
    tried = [each for each in courses_of(len(y)) if each[0] == form and each not in others]
    left = np.array([_left(y, [*others, each]) for each in tried]) / scatter
    likelihood = np.exp(-0.5 * (left - left.min()))
    order = np.argsort(-likelihood)
    held = np.cumsum(likelihood[order]) / likelihood.sum()
    within = order[: int(np.searchsorted(held, 0.95)) + 1]
    first = [tried[int(i)][1] for i in within]
    return min(first), max(first)


def _row(rows: Sequence[FittedRow], y: Estimates, found: Found, records: int) -> ChangeRow:
    form, first = found.course
    wide = NORMAL * y.deviation
    open_ = np.hypot(np.median(wide[:first]), np.median(wide[first:]))
    return ChangeRow(
        ship=rows[0].ship,
        parameter=rows[0].parameter,
        unit=rows[0].unit,
        form="step" if form == "step" else "drift",
        voyage=rows[first].voyage,
        date=rows[first].date,
        earliest=rows[found.ends[0]].voyage,
        latest=rows[found.ends[1]].voyage,
        size=found.size,
        relative=found.size / abs(found.level) if found.level else None,
        p_value=min(1.0, records * found.p_value),
        beyond_likely=bool(abs(found.size) > open_),
    )
