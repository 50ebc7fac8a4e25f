"""From trials and a model to a fit: what is unknown, where it starts, and the search."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.errors import NotIdentifiable, SimulationError, StepsTooLong
from trialid.identification.arrive import arrive
from trialid.identification.check.common_values import Common, common_values
from trialid.identification.one_search import End, Progress, no_start
from trialid.identification.output_error import (
    Problem,
    linearise,
    loss,
    residual_at,
    step_halving,
)
from trialid.identification.problem import Settings, pose_problem
from trialid.identification.smaller import point_of_smaller
from trialid.identification.trial_score import Score, of_own_motion, pool_errors, score_trial
from trialid.identification.weighing import contradictions, level_of
from trialid.least_squares.gauss_newton import REASONS, Iteration
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Departure
from trialid.threads import one_thread
from trialid.trial import Trial

STEP_ERROR: Final = 0.05
"""Share of the error that integration may make up before steps are made finer."""


@dataclass(frozen=True, kw_only=True)
class Fit:
    """The result of a search.

    Attributes
    ----------
    model
        The model with the fitted values of the shared parameters.
    theta
        All unknowns; (n_theta,).
    residual
        Normed residual at the optimum, without priors; (M,).
    scores
        Trials to fit, then trials to check.
    iterations
        The whole history, over all passes of the search that won.
    agreeing
        How many of the starts reached this optimum, of how many.
    level
        What one independent row of the residual is uncertain by; priors weigh by it.
    told
        What the search did beyond going down from the stated start, in words.
    rivals
        Values of all unknowns by name, by GM, the smallest first, that fit as well or hardly worse:
        the record does not tell GM, whatever its standard error. Empty where it does.
    by_means
        The same fitted to means of several samples each, where trials are long and it was examined.
    """

    model: ShipModel
    settings: Settings
    problem: Problem
    theta: Vector
    residual: Vector
    scores: tuple[Score, ...]
    iterations: tuple[Iteration, ...]
    reason: str
    converged: bool
    agreeing: tuple[int, int]
    level: float = 0.0
    told: tuple[str, ...] = ()
    rivals: tuple[Mapping[str, float], ...] = ()
    by_means: "Fit | None" = None

    @cached_property
    def psi(self) -> Vector:
        """Normed gradient at the optimum, without priors, when first asked for; (M, n_theta)."""
        point = linearise(self.problem, self.theta)
        assert not isinstance(point, Departure)
        return point[1]

    @cached_property
    def of_all_trials(self) -> Mapping[str, Common]:
        """Shared parameters, and of each sensor the mean over the trials, by the column."""
        return common_values(self.problem, self.theta, self.level)

    @property
    def common(self) -> Mapping[str, float]:
        """What a trial has that was not fitted: shared parameters, and the mean of each sensor."""
        return {name: found.mean for name, found in self.of_all_trials.items()}

    @property
    def examined(self) -> "Fit":
        """What is looked at to judge it: itself, but where trials are long."""
        return self.by_means or self

    @property
    def trials(self) -> tuple[Trial, ...]:
        """Every trial, those to check too."""
        return tuple(s.trial for s in self.scores)

    @property
    def V(self) -> float:
        """Eq. 4 at the optimum, in normed outputs."""
        return loss(self.residual)

    @property
    def eps_rmsn(self) -> float:
        """Error of all outputs over all trials to fit, each output normed."""
        return float(np.sqrt(np.mean(np.square(list(self.eps_by_output.values())))))

    @property
    def eps_of_own(self) -> float:
        """The largest error of a trial to fit as a share of its own motion."""
        fitted = [s for s in self.scores if s.trial.use == "fit"]
        return max(of_own_motion(score, self.problem) for score in fitted)

    @property
    def eps_by_output(self) -> dict[str, float]:
        """The same, output by output."""
        return pool_errors([s for s in self.scores if s.trial.use == "fit"])

    @property
    def eps_check(self) -> float | None:
        """Error over the held-out trials, None where there are none."""
        pooled = list(self.eps_check_by_output.values())
        return float(np.sqrt(np.mean(np.square(pooled)))) if pooled else None

    @property
    def eps_check_by_output(self) -> dict[str, float]:
        """The same, output by output; empty where there are none."""
        return pool_errors([s for s in self.scores if s.trial.use == "check"])

    @property
    def explanation(self) -> str:
        """Why the search ended, in words."""
        return REASONS[self.reason]

    @property
    def estimates(self) -> dict[str, float]:
        """Every unknown by name."""
        return {x.name: float(a) for x, a in zip(self.problem.unknowns, self.theta, strict=True)}

    def value(self, name: str) -> float:
        """The fitted value of an unknown by its name."""
        return self.estimates[name]

    @property
    def weakly_identified(self) -> bool:
        """Whether the search ended in a valley that this record hardly tells the floor of."""
        return self.reason == "flat"

    @property
    def at_bounds(self) -> dict[str, float]:
        """Unknowns that ended at a bound, and the bound in the unknown's unit.

        Their value is the bound's, not the record's, and so may be those of their neighbours.
        """
        ended = zip(self.problem.unknowns, self.theta, strict=True)
        return {x.name: float(a) for x, a in ended if a <= x.low or a >= x.high}

    @property
    def contradicted(self) -> dict[str, float]:
        """Priors that the record speaks against: by how many standard deviations, with its sign."""
        return contradictions(self.problem, self.theta)


@one_thread
def identify(
    trials: Sequence[Trial],
    model: ShipModel,
    settings: Settings,
    progress: Progress = lambda iteration: None,
    near: Mapping[str, float] | None = None,
    finer: Callable[[int], None] = lambda substeps: None,
    smaller: Fit | None = None,
) -> Fit:
    """Eq. 5: the parameters with the smallest output error over all trials marked `fit`.

    Where the stated start does not arrive, others are tried: see `Fit.told`. Where the integration
    would make up more than `STEP_ERROR` of the error, or leave the domain where a search would
    begin, the search is done again with finer steps.

    Parameters
    ----------
    near
        Better starts by the unknown's name, from a fit of a neighbouring model.
    finer
        Told how many steps a sample has then.
    smaller
        The fit that this model grew from, on the same trials: the end is never worse than that.

    Raises
    ------
    NotIdentifiable
        Nothing excites the ship, there are fewer values than unknowns, nothing can be compared.
    SimulationError
        No start can be simulated.
    """
    fit = None
    while fit is None:
        try:
            fit = _searched(trials, model, settings, progress, near or {}, smaller)
        except StepsTooLong:
            if settings.substeps >= settings.most_substeps:
                raise
            settings = replace(settings, substeps=2 * settings.substeps)
            finer(settings.substeps)
    while _coarse(fit) and fit.settings.substeps < settings.most_substeps:
        again = replace(fit.settings, substeps=2 * fit.settings.substeps)
        finer(again.substeps)
        fit = _searched(trials, model, again, progress, fit.estimates, smaller)
    return fit


def _coarse(fit: Fit) -> bool:
    """Whether integration makes up a share of the error that can be seen."""
    errors = step_halving(fit.problem, fit.theta)
    return max(errors.values(), default=0.0) > STEP_ERROR * fit.eps_rmsn


def _searched(
    trials: Sequence[Trial],
    model: ShipModel,
    settings: Settings,
    progress: Progress,
    near: Mapping[str, float],
    smaller: Fit | None,
) -> Fit:
    """The best end of all starts, with the steps as they are."""
    problem = pose_problem(trials, model, settings, near)
    embedded = None
    if smaller is not None:
        embedded = point_of_smaller(problem, smaller.estimates, smaller.problem.simulator.model)
    arrival = arrive(problem, settings, progress, embedded)
    if not arrival.best.began:
        raise no_start(problem)
    fit = _finish(model, problem, trials, settings, arrival.best, (arrival.same, arrival.tried))
    rivals = arrival.rivals or (() if smaller is None else smaller.rivals)
    return replace(fit, told=arrival.told, rivals=rivals)


@one_thread
def revive(
    trials: Sequence[Trial], model: ShipModel, settings: Settings, estimates: Mapping[str, float]
) -> Fit:
    """A fit whose search is over, from every unknown's value by name; it has no iterations.

    Raises
    ------
    NotIdentifiable
        An unknown without a value: they are of another model, or of other trials.
    SimulationError
        The model cannot be simulated with these values.
    """
    problem = pose_problem(trials, model, settings, estimates)
    missing = [x.name for x in problem.unknowns if x.name not in estimates]
    if missing:
        raise NotIdentifiable(f"there is no value for {', '.join(missing[:3])}")
    return _finish(model, problem, trials, settings, None, (1, 1))


def _finish(
    model: ShipModel,
    problem: Problem,
    trials: Sequence[Trial],
    settings: Settings,
    end: End | None,
    agreeing: tuple[int, int],
) -> Fit:
    """The fit at the end of a search; at the start, without any search, where there is none."""
    theta = problem.start if end is None else end.minimum.theta
    residual = residual_at(problem, theta)
    if isinstance(residual, Departure):
        raise SimulationError(f"the model cannot be simulated with these values: {residual}")
    level = level_of(problem, residual)
    ended = zip(problem.unknowns, theta, strict=True)
    own = model.parameters  # a current is none of hers
    shared = {x.column: float(a) for x, a in ended if x.trial is None and x.column in own}
    fit = Fit(
        model=model.with_values(shared),
        settings=settings,
        problem=problem,
        theta=theta,
        residual=residual,
        scores=(),
        iterations=() if end is None else end.path,
        reason="orthogonal" if end is None else end.minimum.reason,
        converged=end is None or end.minimum.converged,
        agreeing=agreeing,
        level=level,
    )
    return replace(fit, scores=tuple(score_trial(fit, t) for t in trials))
