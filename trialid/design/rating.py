"""How well a trial that was only simulated would find the parameters: Eq. 8 to 14, beforehand.

The trial is what the full model would record without noise. Its sensitivities by the parameters of
the model that is to be fitted, the noise of the sensors and the difference of the two models give
the errors that a fit of the real record may be expected to have.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.accuracy.coloured import toeplitz_times
from trialid.accuracy.equations import (
    correlation_ratio,
    minimum_sensitivity,
    relative_sensitivities,
    sensitivity,
    sensitivity_range,
)
from trialid.accuracy.weak import without_nuisance
from trialid.errors import DesignError, NotIdentifiable
from trialid.identification.output_error import (
    Problem,
    linearise,
    row_scale,
    stretches,
)
from trialid.identification.problem import Settings, question, ready
from trialid.least_squares.fold import triangle
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Departure, Simulator
from trialid.trial import Trial

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Noise:
    """What a sensor adds: standard deviation [SI] and how long it remembers [s], 0 for white."""

    sigma: float
    memory: float = 0.0


@dataclass(frozen=True)
class Goal:
    """What a test is for.

    Attributes
    ----------
    model
        The model that is to be fitted, at what is known of its parameters beforehand.
    settings
        Free parameters, outputs and nuisance of the fit to come.
    noise
        By output.
    wanted
        The parameters that matter, of the free ones.
    scale
        What a parameter is multiplied with before R and S_min, by name; 1 for the others.
    """

    model: ShipModel
    settings: Settings
    noise: Mapping[str, Noise]
    wanted: tuple[str, ...]
    scale: Mapping[str, float]
    simulator: Simulator
    shared: tuple[str, ...]
    per_trial: tuple[str, ...]


@dataclass(frozen=True)
class ParameterRating:
    """One parameter in a test; errors are shares of `reference`, the parameter's size.

    Attributes
    ----------
    noise_error
        One standard deviation from the noise of the sensors.
    bias
        What the full model's remainder would move it by; 0 where full and fitted model are alike.
    bound
        Eq. 14's second part: the most any remainder of that size could move it by.
    partner, likeness
        The parameter whose error goes most with this one's, and their correlation.
    """

    name: str
    unit: str
    value: float
    reference: float
    S_i: float
    S_imin: float
    R_i: float
    noise_error: float
    bias: float
    bound: float
    partner: str | None
    likeness: float

    @property
    def error(self) -> float:
        """What to expect: noise and the full model's remainder, as independent errors."""
        return float(np.hypot(self.noise_error, self.bias))


@dataclass(frozen=True)
class Rating:
    """What a test is worth for a goal.

    `S_min`, `S_max` and `R` are of the wanted parameters in their scale, everything projected out
    that the others can mimic; `noise` and `undermodelling` are eps^x_RMSn and eps^m_RMSn, and
    `log_volume` the logarithm of the volume of their error ellipsoid (D criterion).
    """

    parameters: tuple[ParameterRating, ...]
    S_min: float
    S_max: float
    R: float
    noise: float
    undermodelling: float
    log_volume: float

    def of(self, name: str) -> ParameterRating:
        """One parameter's row."""
        return next(p for p in self.parameters if p.name == name)


def goal(
    model: ShipModel,
    settings: Settings,
    noise: Mapping[str, Noise],
    wanted: Sequence[str] = (),
    scale: Mapping[str, float] | None = None,
) -> Goal:
    """Make a goal ready; all free parameters are wanted unless told.

    Raises
    ------
    DesignError
        An output without noise, or a wanted parameter that is not free.
    """
    for c in settings.outputs:
        if c not in noise:
            raise DesignError(f"no noise is stated for output {c!r}; without it no error follows")
    for name in wanted:
        if name not in settings.free:
            raise DesignError(f"{name!r} is wanted and not free; add it to the free parameters")
    simulator, shared, per_trial = ready(model, settings)
    names = tuple(wanted) or settings.free
    return Goal(
        model=model,
        settings=settings,
        noise=noise,
        wanted=names,
        scale=dict(scale or {}),
        simulator=simulator,
        shared=shared,
        per_trial=per_trial,
    )


def fit_to_come(goal: Goal, trials: Sequence[Trial]) -> Problem:
    """The fit to come, at what is known beforehand. Raises DesignError as `rate`."""
    try:
        return question(goal.simulator, trials, goal.settings, goal.shared, goal.per_trial)
    except NotIdentifiable as error:
        why = str(error).partition(";")[0]  # its advice is about logs
        raise DesignError(f"the test moves too little to find anything: {why}") from error


def linearisation(problem: Problem) -> tuple[Vector, Vector]:
    """Its residual there (M,), and gradient (M, n_theta). Raises DesignError as `rate`."""
    found = linearise(problem, problem.start)
    if isinstance(found, Departure):
        raise DesignError(f"the model to be fitted cannot follow this test: {found}")
    return found


def rate(goal: Goal, trials: Sequence[Trial]) -> Rating:
    """Rate trials that are to be fitted together, as recorded by the full model without noise.

    Raises
    ------
    DesignError
        The model to be fitted leaves its domain in one of them, or nothing moves in all of them.
    """
    problem = fit_to_come(goal, trials)
    remainder, psi = linearisation(problem)
    A = relative_sensitivities(psi, np.array([x.size for x in problem.unknowns]))
    inverse = np.asarray(np.linalg.pinv(triangle(A)))
    covariance = _covariance(goal, problem, A, inverse)
    shift = inverse @ (inverse.T @ (A.T @ remainder))
    rows = _rows(goal, problem, A, covariance, shift, float(np.linalg.norm(remainder)))
    return _rating(goal, problem, A, covariance, rows, float(np.linalg.norm(remainder)))


def _covariance(goal: Goal, problem: Problem, A: Vector, inverse: Vector) -> Vector:
    """Covariance of the relative parameters from the sensors' noise; (n_theta, n_theta).

    A sandwich, because a fit weighs outputs by y_RMS and not by their noise.
    """
    scale = row_scale(problem)
    meat = np.zeros((A.shape[1], A.shape[1]))
    for part in stretches(problem):
        trial, c = problem.trials[part.trial], problem.outputs[part.output]
        rows = A[part.rows] * (goal.noise[c].sigma * scale[part.output])
        meat += rows.T @ _remembered(rows, goal.noise[c].memory / trial.period)
    return np.asarray(inverse @ inverse.T @ meat @ inverse @ inverse.T)


def _remembered(rows: Vector, memory: float) -> Vector:
    """Rows times the correlation matrix of noise that forgets in `memory` samples."""
    if memory <= 0.0:
        return rows
    lags = np.arange(min(len(rows), int(20 * memory) + 2))
    return toeplitz_times(rows, np.exp(-lags / memory))


def _rows(
    goal: Goal, problem: Problem, A: Vector, covariance: Vector, shift: Vector, remainder: float
) -> tuple[ParameterRating, ...]:
    R = triangle(A)
    S_i, S_imin, R_i = sensitivity(R), minimum_sensitivity(R), correlation_ratio(R)
    error = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    error = np.where(S_imin > 0.0, error, np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        alike = np.nan_to_num(covariance / np.outer(error, error))
        bound = remainder / S_imin
    physical = [i for i, x in enumerate(problem.unknowns) if x.name in goal.settings.free]
    made = []
    for i in physical:
        x = problem.unknowns[i]
        others = [j for j in physical if j != i]
        k = max(others, key=lambda j: abs(alike[i, j]), default=None)
        made.append(
            ParameterRating(
                name=x.name,
                unit=x.unit,
                value=x.start,
                reference=x.size,
                S_i=float(S_i[i]),
                S_imin=float(S_imin[i]),
                R_i=float(R_i[i]),
                noise_error=float(error[i]),
                bias=float(shift[i]),
                bound=float(bound[i]),
                partner=None if k is None else problem.unknowns[k].name,
                likeness=0.0 if k is None else float(alike[i, k]),
            )
        )
    return tuple(made)


def _rating(
    goal: Goal, problem: Problem, A: Vector, covariance: Vector,
    rows: tuple[ParameterRating, ...], remainder: float,
) -> Rating:  # fmt: skip
    names = [x.name for x in problem.unknowns]
    wanted = np.isin(names, goal.wanted)
    scale = np.array([goal.scale.get(n, 1.0) for n in names])
    S_min, S_max, R = sensitivity_range((without_nuisance(A, wanted)) * scale[wanted])
    noise = np.array([goal.noise[c].sigma for c in problem.outputs]) / problem.y_rms
    block = covariance[np.ix_(wanted, wanted)]
    sign, log_det = np.linalg.slogdet(block)
    return Rating(
        parameters=rows,
        S_min=S_min,
        S_max=S_max,
        R=R,
        noise=float(np.sqrt(np.mean(noise**2))),
        undermodelling=remainder,
        log_volume=float(log_det) / 2.0 if sign > 0 else float("inf"),
    )
