"""Where the motion of a trial that is not fitted starts: searched, but never from nowhere."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.effects.track import CURRENT
from trialid.identification.gauss_newton import minimise
from trialid.identification.nuisance_priors import limits, nuisance_prior
from trialid.identification.of_each_trial import STATE_SIZE
from trialid.identification.output_error import Problem, output_error, output_matrix, row_scale
from trialid.simulation.integrate import Response, guess, initial, respond
from trialid.trial import Trial

Vector = NDArray[np.float64]

START_STEPS: Final = 6
"""Steps to where a held-out trial starts: nearly linear, and quickly forgotten."""

NEAR_ENOUGH: Final = 1e-3
"""Share of the residual that may be left along the initial states."""


def own_start(
    problem: Problem, trial: Trial, compared: Mask, values: Mapping[str, float], level: float
) -> dict[str, float]:
    """Initial states of a held-out trial, and its current; by the name of the column.

    Recorded samples alone would add their noise. They are free where the fit leaves them free, and
    held by what the trial's first moments make likely: a stiff roll whose start is free can
    otherwise leave the model's domain at once. No trial tells another's current.

    Parameters
    ----------
    compared
        Where an output was measured; (N, n_y).
    level
        What one independent row of the fit is uncertain by: see `Weighing`.
    """
    model, free = problem.simulator.model, _of_its_own(problem)
    start = {c: guess(model, trial, c[:-3]) if c.endswith("(0)") else 0.0 for c in free}
    if not free or not compared.any():
        return start
    known = _priors(problem, trial, free)
    evaluate = _Rows(problem, trial, compared, values, known, level)
    bounds = np.array([limits(known[c]) for c in free])
    scale = np.array([known[c][1] for c in free])
    recorded = np.clip(np.array([start[c] for c in free]), bounds[:, 0], bounds[:, 1])
    for begin in (recorded, evaluate.means):
        end = minimise(
            evaluate=evaluate,
            start=begin,
            scale=scale,
            low=bounds[:, 0],
            high=bounds[:, 1],
            max_iterations=START_STEPS,
            tolerance=NEAR_ENOUGH,
        )
        if end.iterations:
            return dict(zip(free, map(float, end.theta), strict=True))
    return start


def _of_its_own(problem: Problem) -> list[str]:
    """Columns of what a trial to check has for itself, where the fit leaves it free."""
    columns = [*map(initial, problem.simulator.model.states), *CURRENT]
    own = {x.column for x in problem.unknowns if x.trial is not None}
    return [c for c in columns if c in own]


def _priors(
    problem: Problem, trial: Trial, columns: Sequence[str]
) -> dict[str, tuple[float, float]]:
    model = problem.simulator.model
    sizes = {initial(s): STATE_SIZE[s] for s in model.states} | dict.fromkeys(CURRENT, 0.0)
    return {c: nuisance_prior(model, trial, c, sizes[c]) for c in columns}


@dataclass(frozen=True)
class StartError:
    """What a start that was found for fitted parameters is uncertain by.

    Attributes
    ----------
    names, shared
        Columns of what the trial has for itself, and of the parameters that all trials share.
    by
        How what it has for itself moves with those; (n_own, n_shared).
    noise
        Root of the covariance by noise: noise noise^T; (n_own, n_own).
    """

    names: tuple[str, ...]
    shared: tuple[str, ...]
    by: Vector
    noise: Vector


def start_error(
    problem: Problem, trial: Trial, compared: Mask, values: Mapping[str, float], level: float
) -> StartError | None:
    """How sure `own_start` is; None where a trial has nothing for itself, or leaves the model.

    Noise of each output is what the trial itself is off its simulation.

    Parameters
    ----------
    values
        All the trial was simulated with, its start by the name of the column.
    """
    names = tuple(_of_its_own(problem))
    response = respond(problem.simulator, trial, values, starts_of(values))
    if not names or not compared.any() or response.departure is not None or response.S is None:
        return None
    rows = _Rows(problem, trial, compared, values, _priors(problem, trial, names), level)
    shared = tuple(x.column for x in problem.unknowns if x.trial is None)
    columns = [problem.simulator.columns.index(c) for c in shared]
    psi = response.S[:, :, columns][compared] * rows.scale[:, None]
    gap, own = rows.of(response, np.array([values[n] for n in names]))
    place = np.broadcast_to(np.arange(compared.shape[1]), compared.shape)[compared]
    squares = np.bincount(place, gap[: len(place)] ** 2) / np.maximum(np.bincount(place), 1)
    sizes = np.append(np.sqrt(squares[place]), np.full(len(names), level))
    scale = np.linalg.norm(own, axis=0)
    scale[scale == 0.0] = 1.0
    inverse = np.linalg.pinv((own / scale).T @ (own / scale), hermitian=True) / np.outer(
        scale, scale
    )
    root = np.asarray(np.linalg.qr((own * sizes[:, None]) @ inverse, mode="r"))
    return StartError(names, shared, -inverse @ own[: len(place)].T @ psi, root.T)


def starts_of(values: Mapping[str, float]) -> dict[str, float]:
    """Initial states among the columns of a simulation, by the state's name."""
    return {n[:-3]: a for n, a in values.items() if n.endswith("(0)")}


class _Rows:
    """Residual of one trial and its gradient by what is its own, with rows of priors."""

    def __init__(
        self,
        problem: Problem,
        trial: Trial,
        compared: Mask,
        values: Mapping[str, float],
        known: Mapping[str, tuple[float, float]],
        level: float,
    ) -> None:
        self.problem, self.trial, self.compared, self.values = problem, trial, compared, values
        self.names = list(known)
        self.means = np.array([mean for mean, _ in known.values()])
        self.weigh = level / np.array([deviation for _, deviation in known.values()])
        self.columns = [problem.simulator.columns.index(c) for c in known]
        self.scale = np.broadcast_to(row_scale(problem), compared.shape)[compared]

    def __call__(self, own: Vector) -> tuple[Vector, Vector] | None:
        values = {**self.values, **dict(zip(self.names, map(float, own), strict=True))}
        response = respond(self.problem.simulator, self.trial, values, starts_of(values))
        if response.departure is not None or response.S is None:
            return None
        return self.of(response, own)

    def of(self, response: Response, own: Vector) -> tuple[Vector, Vector]:
        """Rows of a simulation by what is its own."""
        assert response.S is not None
        y = output_matrix(self.trial, self.problem.outputs)
        gap = output_error(y, response.y)[self.compared] * self.scale
        slopes = response.S[:, :, self.columns][self.compared] * self.scale[:, None]
        priors = (self.means - own) * self.weigh
        return np.append(gap, priors), np.concatenate([slopes, np.diag(self.weigh)])
