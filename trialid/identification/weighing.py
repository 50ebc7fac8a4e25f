"""What a search makes small: the record's rows, and one row for each thing known beforehand.

A prior weighs by the level of the record's error: standard deviation of a row times the root of
how many rows say the same once, 1 + 2 sum(rho). That level is known only where the search stands,
so it is taken anew at every accepted point: what is minimised is then
N log(sum of squares) + sum of ((mean - theta) / deviation)^2, in one search instead of many.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.output_error import Problem, linearise, stretches
from trialid.simulation.integrate import Departure
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]
Point = tuple[Vector, Vector]

UNLIKE: Final = 0.05
"""Autocorrelation below which two rows say different things."""

FEWEST: Final = 50
"""Independent rows that a record is never thought to have fewer of, however coloured."""

NO_NOISE: Final = 0.3
"""Normed error beyond which it is the start's or the model's, never the level of noise: priors
that weigh by the error of a bad start lead the first steps into other valleys."""

LOOKS: Final = 15
"""Accepted points at which the colour is taken anew. Then it stays: it jumps where a correlation
crosses `UNLIKE`, and a search would swing between two points for ever."""


CONTRADICTS: Final = 3.0
"""Standard deviations of a prior from which on the record speaks against it. Half would be chance
in every eighth; twice lets an inclinometer pass that is two seconds early."""


def contradictions(problem: Problem, theta: Vector) -> dict[str, float]:
    """Priors that the record speaks against: by how many standard deviations, with its sign.

    Either the sensor is unlike others of its kind, or the model puts an error of its own there.
    """
    off = deviations(problem, theta)
    if problem.roll is not None:
        off |= problem.roll.off(theta)
    return {problem.unknowns[i].name: z for i, z in off.items() if abs(z) > CONTRADICTS}


def deviations(problem: Problem, theta: Vector) -> dict[int, float]:
    """Standard deviations of its own prior by which each unknown is off, by its place in theta."""
    ended = enumerate(zip(problem.unknowns, theta, strict=True))
    return {i: (float(a) - x.prior[0]) / x.prior[1] for i, (x, a) in ended if x.prior}


class Weighing:
    """Residual and gradient with robust weights and with rows of priors; state: their level.

    Attributes
    ----------
    level
        Weight of a prior's row times its deviation: what one independent row is uncertain by.
    colour
        How many rows say the same; `looks` times it is still taken anew, never where it is given.
    """

    def __init__(
        self, problem: Problem, weights: Vector | None = None, colour: float | None = None
    ) -> None:
        self.problem, self.weights = problem, weights
        priors = [(i, *x.prior) for i, x in enumerate(problem.unknowns) if x.prior]
        self.held = np.array([p[0] for p in priors], dtype=int)
        self.means = np.array([p[1] for p in priors])
        self.deviations = np.array([p[2] for p in priors])
        self.parts = stretches(problem)
        self.rows = self.parts[-1].rows.stop
        roll = problem.roll
        self.more = len(priors) + (0 if roll is None else len(roll.off(problem.start)))
        self.level, self.colour = -1.0, colour or 1.0
        self.looks = 0 if colour else LOOKS

    def __call__(self, theta: Vector) -> Point | None:
        """Rows at a point, None where it cannot be simulated."""
        point = linearise(self.problem, theta, self.more)
        if isinstance(point, Departure):
            return None
        residual, psi = point
        if self.weights is not None:
            residual[: self.rows] *= self.weights
            psi[: self.rows] *= self.weights[:, None]
        if self.level < 0.0 and self.knows:
            self._settle(residual[: self.rows], len(theta))
        return self._with_priors(theta, residual, psi)

    @property
    def knows(self) -> bool:
        """Whether anything is known beside the record."""
        return bool(len(self.held)) or self.problem.roll is not None

    def again(self, theta: Vector, point: Point) -> Point:
        """The same point with priors weighed by its own level; it takes the other's place."""
        if not self.knows:
            return point
        self._settle(point[0][: self.rows], len(theta))
        return self._with_priors(theta, point[0].copy(), point[1])

    def pulls(self, theta: Vector) -> float:
        """Sum of squares of all priors, in their standard deviations."""
        off = (self.means - theta[self.held]) / self.deviations
        rolls = [] if self.problem.roll is None else list(self.problem.roll.off(theta).values())
        return float(np.sum(off**2) + np.sum(np.square(rolls)))

    def _settle(self, residual: Vector, unknowns: int) -> None:
        if self.looks > 0:
            self.colour = colour_of(residual, self.parts)
            self.looks -= 1
        self.level = _level(residual, unknowns, self.colour)

    def _with_priors(self, theta: Vector, residual: Vector, psi: Vector) -> Point:
        if not self.knows:
            return residual, psi
        weigh = self.level / self.deviations
        held = self.rows + np.arange(len(self.held))
        residual[held] = (self.means - theta[self.held]) * weigh
        psi[held, self.held] = weigh
        if self.problem.roll is not None:
            off, slopes = self.problem.roll.rows(theta)
            below = slice(self.rows + len(held), None)
            residual[below], psi[below] = off * self.level, slopes * self.level
        return residual, psi


def level_of(problem: Problem, residual: Vector) -> float:
    """The level by which priors weigh at a residual of this problem."""
    return _level(residual, len(problem.unknowns), colour_of(residual, stretches(problem)))


def _level(residual: Vector, unknowns: int, colour: float) -> float:
    """The rows' squares sum to the squared normed error."""
    error = min(float(np.linalg.norm(residual)), NO_NOISE)
    return error * float(np.sqrt(colour / max(len(residual) - unknowns, 1)))


def colour_of(residual: Vector, parts: Sequence[Stretch]) -> float:
    """How many rows say the same: 1 + 2 sum(rho) up to where rho falls below `UNLIKE`; >= 1."""
    longest = max(p.rows.stop - p.rows.start for p in parts)
    total = np.zeros(longest)
    for part in parts:
        e = residual[part.rows]
        size = 1 << (2 * max(len(e), 1) - 1).bit_length()
        power = np.abs(np.fft.rfft(e - e.mean() if len(e) else e, size)) ** 2
        total[: len(e)] += np.fft.irfft(power, size)[: len(e)]
    if not total[0] > 0.0:
        return 1.0
    rho = total / total[0]
    low = np.flatnonzero(rho < UNLIKE)
    alike = 1.0 + 2.0 * float(np.sum(rho[1 : low[0] if len(low) else None]))
    return min(alike, max(len(residual) / FEWEST, 1.0))
