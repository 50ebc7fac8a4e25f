"""Courses that a parameter can take in a ship's voyages, and what least squares leaves of each.

A step or a drift changes the ship; a single voyage that lies off changes nothing, and stands beside
them. A drift is linear in time where the voyages have dates, else in their number.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from scipy.stats import f

from trialid.arrays import Vector

EITHER_SIDE: Final = 2
"""Voyages that a level takes, so that a change is more than a voyage that lies off."""
MOST: Final = 3
"""Changes of one parameter in one record."""
OFF: Final = 0.25
"""Largest share of voyages that lie off, each alone. Of 40 records of 16 voyages with a step of
eight times their scatter, and three voyages off by twelve times, it is found in 17; with half of it
in none, with twice of it in 16."""
SIDE: Final = 0.34
"""The same of the voyages before and of those after a change. With two voyages off the step is
found in 33 of those 40; with half of it in 21, with twice of it in 33."""
TINY: Final = 1e-12
"""Share of a column's square below which it is explained by the others."""

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
    days
        When the voyages were, in their order; None where that is not known.
    """

    x: Vector
    deviation: Vector
    least: float = 0.0
    days: Vector | None = None

    def __len__(self) -> int:
        return len(self.x)

    @property
    def time(self) -> Vector:
        """What a drift is linear in."""
        return np.arange(float(len(self))) if self.days is None else self.days


def courses_of(time: Vector) -> list[Course]:
    """What is tried: a change from each voyage on that leaves enough on either side, each alone.

    A drift begins at the voyage before its first; of voyages on one day at the last.
    """
    n = len(time)
    steps: list[Course] = [("step", k) for k in range(EITHER_SIDE, n - EITHER_SIDE + 1)]
    first = range(1, n - EITHER_SIDE - 1)
    drifts: list[Course] = [("drift", k) for k in first if time[k] > time[k - 1]]
    alone: list[Course] = [("alone", k) for k in range(n)]
    return steps + drifts + alone


def is_change(course: Course) -> bool:
    """Whether a course is one of the ship, and no single voyage's."""
    return course[0] != "alone"


def is_allowed(courses: Sequence[Course], voyages: int) -> bool:
    """Whether changes and single voyages are few enough, and each change has voyages to show it."""
    off = {k for form, k in courses if form == "alone"}
    changed = [each for each in courses if is_change(each)]
    most = min(MOST, voyages // EITHER_SIDE - 2)
    sides = [
        side
        for form, first in changed
        for side in (range(first if form == "step" else 0), range(first, voyages))
        if side
    ]
    return (
        len(changed) <= most
        and len(off) <= OFF * voyages
        and all(len({*side} - off) >= EITHER_SIDE for side in sides)
        and all(len({*side} & off) <= SIDE * len(side) for side in sides)
    )


def column(course: Course, time: Vector) -> Vector:
    """What a course adds to the level, by voyage: 1 from the step on; of a drift 1 at the end.

    Of a voyage alone 1 there.

    >>> column(("step", 2), np.arange(4.0)).tolist(), column(("drift", 2), np.arange(4.0)).tolist()
    ([0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.5, 1.0])
    >>> column(("drift", 1), np.array([0.0, 10.0, 40.0])).tolist()
    [0.0, 0.25, 1.0]
    """
    form, first = course
    at = np.arange(len(time))
    if form == "step":
        return (at >= first).astype(float)
    if form == "alone":
        return (at == first).astype(float)
    return np.clip((time - time[first - 1]) / (time[-1] - time[first - 1]), 0.0, None)


def columns_of(y: Estimates, courses: Sequence[Course], level: bool = False) -> Vector:
    """The weighted columns of courses, (n, number), the level's before them if asked for."""
    ones = [np.ones(len(y))] if level else []
    made = [*ones, *(column(each, y.time) for each in courses)]
    return np.reshape(made, (len(made), len(y))).T / y.deviation[:, None]


def take_away(y: Estimates, chosen: Sequence[Course], columns: Vector) -> tuple[Vector, Vector]:
    """Weighted columns and the weighted estimates, without what the chosen courses explain."""
    known, _ = np.linalg.qr(columns_of(y, chosen, level=True))
    target = y.x / y.deviation
    return columns - known @ (known.T @ columns), target - known @ (known.T @ target)


def rest_of(y: Estimates, chosen: Sequence[Course]) -> Vector:
    """What these courses leave of the weighted estimates."""
    return take_away(y, chosen, np.empty((len(y), 0)))[1]


def sum_of_rest(y: Estimates, chosen: Sequence[Course]) -> float:
    """The sum of squares that these courses leave."""
    rest = rest_of(y, chosen)
    return float(rest @ rest)


def sizes_of(y: Estimates, chosen: Sequence[Course]) -> Vector:
    """The level, and how much each course adds to it, by least squares."""
    columns = columns_of(y, chosen, level=True)
    return np.asarray(np.linalg.lstsq(columns, y.x / y.deviation, rcond=None)[0])


def chance(y: Estimates, gain: float, whole: float, courses: int, freedom: int) -> float:
    """How often chance takes so much off a sum of squares by so many courses."""
    if freedom < 1:
        return 1.0
    scatter = max(y.least, (whole - gain) / freedom, TINY)
    return float(f.sf(gain / courses / scatter, courses, freedom))
