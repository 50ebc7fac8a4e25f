"""Whether the record tells GM: other valleys as deep, or a valley that is hardly one."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.gauss_newton import minimise
from trialid.identification.one_search import End
from trialid.identification.output_error import Problem, ranges, stretches
from trialid.identification.record_starts import Part, rows_of
from trialid.identification.weighing import Weighing

Vector = NDArray[np.float64]

FAR: Final = 1.5
"""Factor by which GM must be known to be worth stating: a fifth of the roll period."""

RIVAL: Final = 12.0
"""Two ends are rivals when twice their log likelihoods differ by less, by the residual's colour:
odds of 400 to 1, because the colour is an estimate itself."""

TOLD_BY: Final = 36.0
"""Twice the log likelihood that must be lost where GM is `FAR` off and all else is fitted again,
for the record to tell it: six standard errors. Those of a resonance that is hardly excited are
known to be two to twelve times too small. Half and twice of it: the benchmark of the search."""

GROWS: Final = 0.02
"""Share by which the squared roll error must grow there: a hundredth of the error is what a small
fault of sensors or model makes, and longer records make it no more certain."""

NEIGHBOUR_STEPS: Final = 10
NEIGHBOUR_NEAR: Final = 1e-3

ALIKE: Final = 1.1
"""Factor within which two rivals are one in words."""


def rival_GM(problem: Problem, ends: Sequence[End], best: End) -> tuple[float, ...]:
    """Metacentric heights [m] among which the record does not choose, smallest first; else empty.

    Parameters
    ----------
    ends, best
        All searches of the problem, and the one that is taken.
    """
    roll = problem.roll
    if roll is None:
        return ()
    limit = best.cost(best.colour) + RIVAL
    near = [float(e.minimum.theta[roll.GM]) for e in ends if e.cost(best.colour) < limit]
    if max(near) <= FAR * min(near):
        near += _hardly_worse(problem, best)
    near.sort()
    if near[-1] < FAR * near[0] * 0.999:
        return ()
    distinct = near[:1]
    for GM in near:
        distinct += [GM] if ALIKE * distinct[-1] < GM else []
    return tuple(distinct)


def roll_error(problem: Problem, end: End) -> float:
    """Normed error of the roll outputs."""
    squares = float(np.sum(end.residual[rows_of(problem, ("phi", "p"))] ** 2))
    return float(np.sqrt(squares * len(problem.outputs)))


def _hardly_worse(problem: Problem, best: End) -> list[float]:
    """GM a factor to either side, where all else fitted again is hardly worse."""
    assert problem.roll is not None
    place, rows = problem.roll.GM, rows_of(problem, ("phi", "p"))
    found = []
    for factor in (1.0 / FAR, FAR):
        theta = best.minimum.theta.copy()
        theta[place] *= factor
        if problem.roll.Kp is not None:
            theta[problem.roll.Kp] *= np.sqrt(factor)
        there = _with_GM_held(problem, theta, best.colour)
        if there is None:
            continue
        lost = there.cost(best.colour) - best.cost(best.colour)
        grown = np.sum(there.residual[rows] ** 2) / np.sum(best.residual[rows] ** 2) - 1.0
        if lost < TOLD_BY or grown < GROWS:
            found.append(float(theta[place]))
    return found


def _with_GM_held(problem: Problem, theta: Vector, colour: float) -> End | None:
    """The end of a short search of everything but GM, None where it cannot begin."""
    assert problem.roll is not None
    moving = np.ones(len(theta), dtype=bool)
    moving[problem.roll.GM] = False
    chosen = [x for x, moves in zip(problem.unknowns, moving, strict=True) if moves]
    rows = np.arange(stretches(problem)[-1].rows.stop)
    part = Part(problem, theta, rows, moving)
    end = minimise(
        part, theta[moving], *ranges(chosen), NEIGHBOUR_STEPS, NEIGHBOUR_NEAR, keep=False
    )
    if not end.iterations:
        return None
    there = theta.copy()
    there[moving] = end.theta
    pulls = Weighing(problem).pulls(there)
    return End(end, end.iterations, end.residual[: len(rows)], colour, pulls)
