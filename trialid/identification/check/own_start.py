"""Where the motion of a trial that is not fitted starts: searched, but never from nowhere."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.effects.track import CURRENT
from trialid.identification.nuisance.of_each_trial import STATE_SIZE
from trialid.identification.nuisance.priors import limits, nuisance_prior
from trialid.identification.output_error import Problem, output_error, output_matrix, row_scale
from trialid.least_squares.gauss_newton import minimise
from trialid.simulation.integrate import Response, guess, initial, respond, starts_of
from trialid.trial import Trial

Vector = NDArray[np.float64]

START_STEPS: Final = 12
"""Steps at most to where a held-out trial starts. Two or three do where nothing but angles is
compared. With positions of 2 cm and a current 6 are too few: of 50 tactical diameters of the model
74 % were in their ranges, 90 % with 9, 12 or 40."""

RUDDERS_ZERO: Final = "delta_0"
"""A heading adds it up: a tenth of a degree turns a ship by degrees within two minutes, whatever
her model holds. So it is a held-out trial's own where a heading is compared: of real zig-zags
of a model of 5 m by her heading the speed that she loses took 90 % off the trials that were fitted
and made the one held out worse, by its rudder's zero alone."""

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
    model, free = problem.simulator.model, columns_of_its_own(problem)
    start = {c: guess(model, trial, c[:-3]) if c.endswith("(0)") else 0.0 for c in free}
    if not free or not compared.any():
        return start
    known = priors_of(problem, trial, free)
    evaluate = OwnRows(problem, trial, compared, values, known, level)
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


def columns_of_its_own(problem: Problem) -> list[str]:
    """Columns of what a trial to check has for itself, where the fit leaves it free."""
    columns = [*map(initial, problem.simulator.model.states), *CURRENT]
    columns += [RUDDERS_ZERO] if "psi" in problem.outputs else []
    own = {x.column for x in problem.unknowns if x.trial is not None}
    return [c for c in columns if c in own]


def priors_of(
    problem: Problem, trial: Trial, columns: Sequence[str]
) -> dict[str, tuple[float, float]]:
    """What is likely of these before the trial is looked at: mean and standard deviation."""
    model = problem.simulator.model
    sizes = {initial(s): STATE_SIZE[s] for s in model.states}
    sizes |= dict.fromkeys((*CURRENT, RUDDERS_ZERO), 0.0)
    return {c: nuisance_prior(model, trial, c, sizes[c]) for c in columns}


class OwnRows:
    """Residual of one trial and its gradient by what is its own, with rows of priors.

    One output after the other, as the rows of a fit.
    """

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
        self.scale = np.repeat(row_scale(problem), compared.sum(axis=0))

    def __call__(self, own: Vector) -> tuple[Vector, Vector] | None:
        """At these values of its own; None where the model is left."""
        values = {**self.values, **dict(zip(self.names, map(float, own), strict=True))}
        response = respond(self.problem.simulator, self.trial, values, starts_of(values))
        if response.departure is not None or response.S is None:
            return None
        return self.of(response, own)

    def of(self, response: Response, own: Vector) -> tuple[Vector, Vector]:
        """Rows of a simulation by what is its own."""
        assert response.S is not None
        y = output_matrix(self.trial, self.problem.outputs)
        gap = self.taken(output_error(y, response.y))
        slopes = self.taken(response.S[:, :, self.columns])
        priors = (self.means - own) * self.weigh
        return np.append(gap, priors), np.concatenate([slopes, np.diag(self.weigh)])

    def taken(self, values: Vector) -> Vector:
        """Normed rows of what there is at every sample; (N, n_y, ...) to (M, ...)."""
        rows = np.swapaxes(values, 0, 1)[self.compared.T]
        return np.asarray(rows * self.scale.reshape(-1, *(1,) * (rows.ndim - 1)))
