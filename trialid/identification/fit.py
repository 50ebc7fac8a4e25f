"""From trials and a model to a fit: what is unknown, where it starts, and the search."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.errors import NotIdentifiable, SimulationError
from trialid.identification.gauss_newton import REASONS, Iteration, Minimum, minimise
from trialid.identification.output_error import (
    Problem,
    linearise,
    loss,
    measured,
    output_error,
    respond_all,
    row_scale,
    scores,
    where_compared,
)
from trialid.identification.pose import Settings, pose
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import (
    Departure,
    Response,
    guess,
    initial,
    respond,
)
from trialid.threads import one_thread
from trialid.trial import Mask, Trial

Vector = NDArray[np.float64]
HUBER: Final = 1.345
"""Residuals beyond this many standard deviations count by their size, not its square."""

TOLERANCE: Final = 1e-5
"""Share of the residual left along the sensitivities: a thousandth of a standard error."""

PASSES: Final = 12

SETTLED: Final = 1e-6
"""Typical sizes that a further pass may move any parameter when it is the last."""

SAME_OPTIMUM: Final = 1e-6

START_STEPS: Final = 3
"""Steps to where a held-out trial starts: nearly linear, and quickly forgotten."""


@dataclass(frozen=True)
class Score:
    """How one trial came out: eps_RMSn of each output, and the simulated response."""

    trial: Trial
    response: Response
    compared: Mask
    eps_rmsn: Mapping[str, float]
    counts: Mapping[str, int]


@dataclass(frozen=True)
class Fit:
    """The result of a search.

    Attributes
    ----------
    model
        The model with the fitted values of the shared parameters.
    theta
        All unknowns; (n_theta,).
    residual, psi
        Normed residual (M,) and normed gradient (M, n_theta) at the optimum, without priors.
    scores
        Trials to fit, then trials to check.
    iterations
        The whole history, over all passes of the search that won.
    agreeing
        How many of the starts reached this optimum, of how many.
    """

    model: ShipModel
    settings: Settings
    problem: Problem
    theta: Vector
    residual: Vector
    psi: Vector
    scores: tuple[Score, ...]
    iterations: tuple[Iteration, ...]
    reason: str
    converged: bool
    agreeing: tuple[int, int]

    @property
    def V(self) -> float:
        """Eq. 4 at the optimum, in normed outputs."""
        return loss(self.residual)

    @property
    def eps_rmsn(self) -> float:
        """Error of all outputs over all trials to fit, each output normed."""
        return float(np.sqrt(np.mean(np.square(list(self.eps_by_output.values())))))

    @property
    def eps_by_output(self) -> dict[str, float]:
        """The same, output by output."""
        return _pooled([s for s in self.scores if s.trial.use == "fit"])

    @property
    def eps_check(self) -> float | None:
        """Error over the held-out trials, None where there are none."""
        pooled = list(self.eps_check_by_output.values())
        return float(np.sqrt(np.mean(np.square(pooled)))) if pooled else None

    @property
    def eps_check_by_output(self) -> dict[str, float]:
        """The same, output by output; empty where there are none."""
        return _pooled([s for s in self.scores if s.trial.use == "check"])

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


def _pooled(scored: Sequence[Score]) -> dict[str, float]:
    """Root mean square of each output over all compared samples of these trials."""
    squares, counts = dict[str, float](), dict[str, int]()
    for score in scored:
        for c, eps in score.eps_rmsn.items():
            squares[c] = squares.get(c, 0.0) + eps**2 * max(score.counts[c], 1)
            counts[c] = counts.get(c, 0) + max(score.counts[c], 1)
    return {c: float(np.sqrt(squares[c] / counts[c])) for c in squares}


Progress = Callable[[Iteration], None]


@one_thread
def identify(
    trials: Sequence[Trial],
    model: ShipModel,
    settings: Settings,
    progress: Progress = lambda iteration: None,
    near: Mapping[str, float] | None = None,
) -> Fit:
    """Eq. 5: the parameters with the smallest output error over all trials marked `fit`.

    `near` holds better starts by the unknown's name, from a fit of a neighbouring model.

    Raises
    ------
    NotIdentifiable
        Nothing excites the ship, there are fewer values than unknowns, nothing can be compared.
    SimulationError
        No start can be simulated.
    """
    problem = pose(trials, model, settings, near or {})
    starts = _starts(problem, settings)
    ends = [_search(problem, settings, start, progress) for start in starts]
    best = min(ends, key=lambda end: end.minimum.V if end.minimum.iterations else np.inf)
    if not best.minimum.iterations:
        raise SimulationError(_why_no_start(problem))
    same = [e.minimum.iterations and _same(e.minimum.V, best.minimum.V) for e in ends]
    return _finish(model, problem, trials, settings, best, (sum(map(bool, same)), len(starts)))


@one_thread
def revived(
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
    problem = pose(trials, model, settings, estimates)
    missing = [x.name for x in problem.unknowns if x.name not in estimates]
    if missing:
        raise NotIdentifiable(f"there is no value for {', '.join(missing[:3])}")
    point = linearise(problem, problem.start)
    if isinstance(point, Departure):
        raise SimulationError(f"the model cannot be simulated with these values: {point}")
    minimum = Minimum(problem.start, *point, (), "orthogonal", 0)
    return _finish(model, problem, trials, settings, _End(minimum, ()), (1, 1))


def _same(V: float, best: float) -> bool:
    return best * (1.0 + SAME_OPTIMUM) + 1e-20 >= V


def _starts(problem: Problem, settings: Settings) -> list[Vector]:
    """The stated start, then random ones; (n_theta,) each."""
    rng = np.random.default_rng(settings.seed)
    physical = np.array([x.kind == "physical" for x in problem.unknowns])
    starts = [problem.start]
    for _ in range(settings.starts - 1):
        factor = 1.0 + settings.spread * rng.uniform(-1.0, 1.0, len(physical))
        starts.append(np.where(physical, problem.start * factor, problem.start))
    return starts


@dataclass(frozen=True)
class _End:
    """Where a search ended, with the history of all its passes."""

    minimum: Minimum
    path: tuple[Iteration, ...]


def _search(problem: Problem, settings: Settings, start: Vector, progress: Progress) -> _End:
    """Minimise; again with new weights while a robust loss or a prior asks for it.

    A prior weighs in by the noise level of the record, and a robust loss by the residual, both of
    which are known only after a fit: hence the passes, until nothing changes. The first pass takes
    the error of the start for noise, so that a prior holds what the record alone would not.
    """
    once = settings.loss == "squares" and not any(x.prior for x in problem.unknowns)
    weights, noise = None, 0.0 if once else _noise(problem, start)
    path: tuple[Iteration, ...] = ()
    for passed in range(1 if once else PASSES):
        minimum = minimise(
            _evaluator(problem, weights, noise),
            start,
            np.array([x.size for x in problem.unknowns]),
            np.array([x.low for x in problem.unknowns]),
            np.array([x.high for x in problem.unknowns]),
            settings.max_iterations,
            TOLERANCE,
            progress,
        )
        path += minimum.iterations
        moved = np.max(np.abs(minimum.theta - start) / [x.size for x in problem.unknowns])
        if once or not minimum.iterations or (passed and moved < SETTLED):
            break
        start = minimum.theta
        point = linearise(problem, start)
        assert not isinstance(point, Departure)
        weights = _huber(point[0]) if settings.loss == "huber" else None
        noise = _noise(problem, start)
    return _End(minimum, path)


def _noise(problem: Problem, theta: Vector) -> float:
    """Root mean square of a row of the residual, zero where nothing can be simulated."""
    point = linearise(problem, theta)
    if isinstance(point, Departure):
        return 0.0
    return float(np.linalg.norm(point[0])) / np.sqrt(len(point[0]) - len(theta))


def _evaluator(
    problem: Problem, weights: Vector | None, noise: float
) -> Callable[[Vector], tuple[Vector, Vector] | None]:
    """Residual and gradient with robust weights and with one row for each prior."""
    held = [(i, x.prior) for i, x in enumerate(problem.unknowns) if x.prior and noise > 0.0]

    def evaluate(theta: Vector) -> tuple[Vector, Vector] | None:
        point = linearise(problem, theta)
        if isinstance(point, Departure):
            return None
        residual, psi = point
        if weights is not None:
            residual, psi = residual * weights, psi * weights[:, None]
        for i, (mean, deviation) in held:
            row = np.zeros((1, len(theta)))
            row[0, i] = noise / deviation
            residual = np.append(residual, (mean - theta[i]) * noise / deviation)
            psi = np.concatenate([psi, row])
        return residual, psi

    return evaluate


def _huber(residual: Vector) -> Vector:
    """Square roots of Huber's weights, by a scale that outliers do not move; (M,)."""
    scale = 1.4826 * float(np.median(np.abs(residual)))
    ratio = np.abs(residual) / max(HUBER * scale, 1e-300)
    return np.asarray(1.0 / np.sqrt(np.maximum(ratio, 1.0)))


def _why_no_start(problem: Problem) -> str:
    departure = linearise(problem, problem.start)
    simulator = problem.simulator
    finer = replace(problem, simulator=replace(simulator, substeps=16 * simulator.substeps))
    if not isinstance(respond_all(finer, problem.start, False), Departure):
        step = problem.trials[0].period / simulator.substeps
        return (
            f"steps of {step:g} s are too long for this model: {departure}, with finer steps not; "
            "choose a shorter [align] period, or more [identify] substeps"
        )
    return (
        f"the model cannot be simulated at its start values: {departure}; give nearer values in "
        "[model.values] or in the ship file, or narrower [identify] bounds"
    )


def _finish(
    model: ShipModel,
    problem: Problem,
    trials: Sequence[Trial],
    settings: Settings,
    end: _End,
    agreeing: tuple[int, int],
) -> Fit:
    theta = end.minimum.theta
    point = linearise(problem, theta)
    assert not isinstance(point, Departure)
    shared = {x.column: float(a) for x, a in zip(problem.unknowns, theta, strict=True)
              if x.trial is None}  # fmt: skip
    return Fit(
        model.with_values(shared), settings, problem, theta, *point,
        tuple(_score(problem, theta, t) for t in trials), end.path, end.minimum.reason,
        end.minimum.converged, agreeing,
    )  # fmt: skip


def of_trial(
    problem: Problem, theta: Vector, trial: Trial
) -> tuple[dict[str, float], dict[str, float]]:
    """Parameters and initial states with which a fit simulates one trial.

    A trial to check has no parameters of its own but where its motion starts, if the fit leaves
    that free too: sensors keep the mean of the fitted ones.
    """
    if trial.use == "fit":
        place = [t.name for t in problem.trials].index(trial.name)
        values = problem.values(theta, place)
        return values, {n[:-3]: a for n, a in values.items() if n.endswith("(0)")}
    values = _mean_values(problem, theta)
    compared = where_compared(trial, problem.simulator)
    return values, _own_start(problem, trial, compared, values)


def _score(problem: Problem, theta: Vector, trial: Trial) -> Score:
    """Simulate one trial with the fitted parameters."""
    compared = where_compared(trial, problem.simulator)
    values, start = of_trial(problem, theta, trial)
    response = respond(problem.simulator, trial, values, start, sensitivities=False)
    if response.departure is None:
        eps = scores(trial, response, compared, problem.outputs, problem.y_rms)
    else:  # what was lost has no error, however good its beginning
        compared = compared & np.isfinite(response.y)
        eps = dict.fromkeys(problem.outputs, np.inf)
    counts = dict(zip(problem.outputs, map(int, compared.sum(axis=0)), strict=True))
    return Score(trial, response, compared, eps, counts)


def _own_start(
    problem: Problem, trial: Trial, compared: Mask, values: Mapping[str, float]
) -> dict[str, float]:
    """Where the motion of a trial to check starts; recorded samples alone would add their noise."""
    simulator = problem.simulator
    free = [s for s in simulator.model.states
            if any(x.column == initial(s) for x in problem.unknowns)]  # fmt: skip
    start = {s: guess(simulator.model, trial, s) for s in free}
    if not free:
        return start
    columns = [simulator.columns.index(initial(s)) for s in free]
    scale = np.broadcast_to(row_scale(problem), compared.shape)[compared]
    for _ in range(START_STEPS):
        response = respond(simulator, trial, values, start)
        if response.departure is not None or response.S is None:
            break
        gap = output_error(measured(trial, problem.outputs), response.y)[compared] * scale
        slopes = response.S[:, :, columns][compared] * scale[:, None]
        sizes = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
        step = np.linalg.lstsq(slopes / sizes, gap, rcond=1e-8)[0] / sizes
        start = {s: start[s] + float(x) for s, x in zip(free, step, strict=True)}
    return start


def _mean_values(problem: Problem, theta: Vector) -> dict[str, float]:
    """Shared parameters, and the mean over the trials of what belongs to a sensor."""
    gathered: dict[str, list[float]] = {}
    for x, a in zip(problem.unknowns, theta, strict=True):
        if not x.column.endswith("(0)"):
            gathered.setdefault(x.column, []).append(float(a))
    return {n: float(np.mean(a)) for n, a in gathered.items()}


def step_halving(fit: Fit) -> dict[str, float]:
    """Integration error of the fit: normed difference to the same run with half the step."""
    problem = fit.problem
    simulator = problem.simulator
    finer = replace(problem, simulator=replace(simulator, substeps=2 * simulator.substeps))
    coarse, fine = (respond_all(p, fit.theta, False) for p in (problem, finer))
    if isinstance(coarse, Departure) or isinstance(fine, Departure):
        return {}
    result = {}
    for c, name in enumerate(problem.outputs):
        gaps = [a.y[:, c] - b.y[:, c] for a, b in zip(coarse, fine, strict=True)]
        result[name] = float(np.sqrt(np.mean(np.concatenate(gaps) ** 2)) / problem.y_rms[c])
    return result
