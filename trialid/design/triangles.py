"""What trials show of the unknowns of a fit to come, and what one more adds to it.

A record is long, and what it shows fits into a triangle for each output: tests are rated beside it
one after another, and only they are sailed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trialid.accuracy.equations import relative_sensitivities
from trialid.arrays import Vector
from trialid.design.rating import Goal, Noise, fit_to_come, linearisation
from trialid.identification.output_error import Problem, Unknown, row_scale, stretches
from trialid.least_squares.fold import triangle
from trialid.trial import Trial


@dataclass(frozen=True)
class Triangles:
    """What trials show.

    Attributes
    ----------
    names
        The unknowns, those of the last trial last.
    of_output
        Of each output's sensitivities by the unknowns' sizes [SI]; (n_theta, n_theta) each.
    """

    trials: tuple[Trial, ...]
    names: tuple[str, ...]
    of_output: Mapping[str, Vector]

    def rows(self, noise: Mapping[str, Noise]) -> Vector:
        """The same in standard deviations of noise, all outputs; (n_y n_theta, n_theta)."""
        return np.concatenate([R / noise[c].sigma for c, R in self.of_output.items()])


def triangles(goal: Goal, trials: Sequence[Trial]) -> Triangles:
    """What these trials show. Raises DesignError as `rate`."""
    problem = fit_to_come(goal, trials)
    return Triangles(tuple(trials), _names(problem), _triangles(goal, problem))


def triangles_beside(goal: Goal, before: Triangles, trial: Trial) -> Triangles:
    """What a further trial shows beside those. Raises DesignError as `rate`."""
    trials = (*before.trials, trial)
    problem = fit_to_come(goal, trials)
    last, n = len(before.trials), len(problem.unknowns)
    own = [i for i, x in enumerate(problem.unknowns) if x.trial in (None, last)]
    alone = replace(
        problem,
        trials=(trial,),
        compared=problem.compared[-1:],
        unknowns=tuple(_of_one(problem, i) for i in own),
        roll=None,
    )
    both = {}
    for c, added in _triangles(goal, alone).items():
        old, new = np.zeros((len(before.names), n)), np.zeros((len(added), n))
        old[:, : len(before.names)], new[:, own] = before.of_output[c], added
        both[c] = triangle(np.concatenate([old, new]))
    return Triangles(trials, _names(problem), both)


def _of_one(problem: Problem, place: int) -> Unknown:
    """An unknown as it is called where its trial is the only one."""
    x = problem.unknowns[place]
    return x if x.trial is None else replace(x, trial=0)


def _names(problem: Problem) -> tuple[str, ...]:
    return tuple(x.name for x in problem.unknowns)


def _triangles(goal: Goal, problem: Problem) -> dict[str, Vector]:
    """By output: all of its rows, for noise of one unit."""
    unit = {c: replace(noise, sigma=1.0) for c, noise in goal.noise.items()}
    A, parts = _white(unit, problem), stretches(problem)
    return {
        name: triangle(np.concatenate([A[p.rows] for p in parts if p.output == c]))
        for c, name in enumerate(problem.outputs)
    }


def whiten_sensitivities(goal: Goal, trials: Sequence[Trial]) -> tuple[Vector, list[str]]:
    """Sensitivities in standard deviations of white noise, a column for each unknown's size; names.

    (M, n_theta), (n_theta,). Noise with a memory is made white by the filter that forgets as it
    does. Raises DesignError as `rate`.
    """
    problem = fit_to_come(goal, trials)
    return _white(goal.noise, problem), [*_names(problem)]


def _white(noises: Mapping[str, Noise], problem: Problem) -> Vector:
    _, psi = linearisation(problem)
    A = relative_sensitivities(psi, np.array([x.size for x in problem.unknowns]))
    scale = row_scale(problem)
    for part in stretches(problem):
        noise = noises[problem.outputs[part.output]]
        period = problem.trials[part.trial].period
        A[part.rows] = _forgotten(A[part.rows], noise.memory / period)
        A[part.rows] /= noise.sigma * scale[part.output]
    return A


def _forgotten(rows: Vector, memory: float) -> Vector:
    """Rows less what noise that forgets in `memory` samples would still hold of those before."""
    if memory <= 0.0:
        return rows
    kept = float(np.exp(-1.0 / memory))
    return np.concatenate([rows[:1], (rows[1:] - kept * rows[:-1]) / np.sqrt(1.0 - kept**2)])
