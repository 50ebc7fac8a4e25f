"""One search from one start: least squares, robust or not, with what is known beforehand."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.errors import SimulationError, StepsTooLong
from trialid.identification.nuisance.priors import time_per_length
from trialid.identification.output_error import (
    Problem,
    linearise,
    ranges,
    residual_at,
    respond_all,
)
from trialid.identification.problem import Settings, pose_problem
from trialid.identification.weighing import Weighing, colour_of
from trialid.least_squares.gauss_newton import Iteration, Minimum, minimise
from trialid.ship.effect import Parameter, Rate
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Departure
from trialid.threads import one_thread
from trialid.trial import Trial

Vector = NDArray[np.float64]
Progress = Callable[[Iteration], None]

HUBER: Final = 1.345
"""Residuals beyond this many standard deviations count by their size, not its square."""

TOLERANCE: Final = 1e-5
"""Share of the residual left along the sensitivities: a thousandth of a standard error."""

WORTH: Final = 0.02
"""Standard errors, all parameters together, that a slow search need not win any more: they are of
the record's weakest directions, and no printed digit depends on them."""

PASSES: Final = 12

OTHER_COLOUR: Final = 0.3
"""Change of the colour's logarithm at which priors weighed wrongly: their pull is off by a sixth of
what it is worth. Half of it searches more often for less than a tenth of a prior's pull."""

LOOKS_AGAIN: Final = 2
"""Passes for the colour alone."""

SETTLED: Final = 1e-6
"""Typical sizes that a further pass may move any parameter when it is the last."""


@dataclass(frozen=True)
class End:
    """Where a search ended, with the history of all its passes.

    Attributes
    ----------
    residual
        Of the record alone, weighted where the loss is robust; (M,), empty where nothing could
        be simulated.
    colour
        How many rows say the same there: see `colour_of`.
    pulls
        Sum of squares of all priors, in their standard deviations.
    """

    minimum: Minimum
    path: tuple[Iteration, ...]
    residual: Vector
    colour: float
    pulls: float

    @property
    def began(self) -> bool:
        """Whether the start could be simulated."""
        return bool(self.minimum.iterations)

    @property
    def V(self) -> float:
        """Half the sum of squares of the record's rows, inf where nothing could be simulated."""
        return 0.5 * float(self.residual @ self.residual) if self.began else np.inf

    def cost(self, colour: float) -> float:
        """What a search makes small: N log(2 V) and the pull of the priors, N = rows / colour."""
        return _cost(self.residual, colour, self.pulls) if self.began else np.inf


def _cost(residual: Vector, colour: float, pulls: float) -> float:
    squares = float(residual @ residual)
    return len(residual) / colour * float(np.log(max(squares, 1e-300))) + pulls


def cost_at(problem: Problem, settings: Settings, theta: Vector, colour: float) -> float:
    """What a search makes small, at a point where none is begun; inf where it cannot be simulated.

    Parameters
    ----------
    colour
        How many rows say the same at the end that it is held against.
    """
    residual = residual_at(problem, theta)
    if isinstance(residual, Departure):
        return np.inf
    if settings.loss == "huber":
        residual = residual * huber(residual)
    with np.errstate(over="ignore", invalid="ignore"):
        return _cost(residual, colour, Weighing(problem).pulls(theta))


def search(
    problem: Problem,
    settings: Settings,
    start: Vector,
    progress: Progress = lambda iteration: None,
    max_iterations: int | None = None,
) -> End:
    """Minimise; again with new weights while a robust loss or the residual's colour asks for it."""
    robust = settings.loss == "huber"
    weights: Vector | None = None
    colour: float | None = None
    path: tuple[Iteration, ...] = ()
    for passed in range(PASSES):
        weighing = Weighing(problem, weights, colour)
        minimum = _minimise(weighing, settings, start, progress, max_iterations)
        path += minimum.iterations
        moved = np.max(np.abs(minimum.theta - start) / [x.size for x in problem.unknowns])
        if not minimum.iterations or (passed and moved < SETTLED):
            break
        residual = minimum.residual[: weighing.rows]
        colour = colour_of(residual, weighing.parts)
        stale = weighing.knows and abs(np.log(colour / weighing.colour)) > OTHER_COLOUR
        if not robust and not (stale and passed < LOOKS_AGAIN):
            break
        start = minimum.theta
        weights = huber(_plain(problem, start)) if robust else None
    return _end(weighing, minimum, path)


@one_thread
def left_by_one(trials: Sequence[Trial], model: ShipModel, settings: Settings) -> float:
    """Normed error that one search from the stated start leaves; inf where it cannot begin.

    Raises
    ------
    NotIdentifiable
        As `identify` does, which searches from other starts, too.
    StepsTooLong
        The integration asks for finer steps than `settings.substeps`.
    """
    problem = pose_problem(trials, model, settings, {})
    return float(np.sqrt(2.0 * search(problem, settings, problem.start).V))


def _minimise(
    weighing: Weighing,
    settings: Settings,
    start: Vector,
    progress: Progress,
    max_iterations: int | None,
) -> Minimum:
    size, low, high = ranges(weighing.problem.unknowns)
    return minimise(
        evaluate=weighing,
        start=start,
        scale=size,
        low=low,
        high=high,
        max_iterations=settings.max_iterations if max_iterations is None else max_iterations,
        tolerance=TOLERANCE,
        progress=progress,
        again=weighing.again,
        worth=lambda: WORTH * float(np.sqrt(weighing.colour)),
        rows=weighing.rows,
        keep=False,
    )


def _plain(problem: Problem, theta: Vector) -> Vector:
    """Residual of the record without weights; (M,)."""
    residual = residual_at(problem, theta)
    assert not isinstance(residual, Departure)
    return residual


def _end(weighing: Weighing, minimum: Minimum, path: tuple[Iteration, ...]) -> End:
    residual = minimum.residual[: weighing.rows]
    if not len(residual):
        return End(minimum, path, residual, 1.0, 0.0)
    colour = weighing.colour if weighing.knows else colour_of(residual, weighing.parts)
    return End(minimum, path, residual, colour, weighing.pulls(minimum.theta))


def huber(residual: Vector) -> Vector:
    """Square roots of Huber's weights, by a scale that outliers do not move; (M,)."""
    scale = 1.4826 * float(np.median(np.abs(residual)))
    ratio = np.abs(residual) / max(HUBER * scale, 1e-300)
    return np.asarray(1.0 / np.sqrt(np.maximum(ratio, 1.0)))


def influence(residual: Vector) -> Vector:
    """Residual of the least squares that errs as the robust fit does; (M,).

    Huber's psi over the share of rows it leaves as they are: Huber & Ronchetti (2009), Robust
    Statistics, 7.6.
    """
    limit = HUBER * 1.4826 * float(np.median(np.abs(residual)))
    inside = float(np.mean(np.abs(residual) <= limit))
    return np.asarray(np.clip(residual, -limit, limit) / inside)


def random_starts(problem: Problem, count: int, spread: float, seed: int) -> list[Vector]:
    """So many starts about the stated one, its physical parameters moved; (n_theta,) each."""
    rng = np.random.default_rng(seed)
    physical = np.array([x.kind == "physical" for x in problem.unknowns])
    starts = []
    for _ in range(count):
        factor = 1.0 + spread * rng.uniform(-1.0, 1.0, len(physical))
        starts.append(np.where(physical, problem.start * factor, problem.start))
    return starts


def _is_quicker(model: ShipModel, step: float) -> bool:
    """Whether a gear or a drive of hers follows in less than a step [s]."""
    of_rates = (e for e in model.effects if Rate in e.forms)
    times = [n for e in of_rates for n, p in e.parameters.items() if p.unit == "s"]
    return any(0.0 < model.value(n) < step for n in times)


def no_start(problem: Problem) -> SimulationError:
    """Why nothing can be simulated where a search would begin, and what to do.

    Steps are too long where samples come before she has gone her length: her motion is seen, and a
    gear's need not be. Of a container ship, 24 s, samples of 30 s are no trial however fine the
    steps between them. A gear that is quicker than a step is one reason, whatever else a start
    does: of a boat whose gear took 0.05 s nothing could be simulated in steps of 0.2.
    """
    departure = linearise(problem, problem.start)
    simulator = problem.simulator
    step = problem.trials[0].period / simulator.substeps
    finer = replace(problem, simulator=replace(simulator, substeps=16 * simulator.substeps))
    sailed = not isinstance(respond_all(finer, problem.start, False), Departure)
    if sailed or _is_quicker(simulator.model, step):
        seen = problem.trials[0].period < time_per_length(simulator.model, problem.trials)
        return (StepsTooLong if seen else SimulationError)(
            f"steps of {step:g} s are too long for this model: {departure}; "
            "choose a shorter [align] period, or more [identify] substeps"
        )
    over = isinstance(departure, Departure) and departure.state in ("phi", "p")
    GM = "; the GM of her file lets her capsize: state hers, or her period of roll" if over else ""
    return SimulationError(
        f"the model cannot be simulated at its start values: {departure}{GM}; give nearer values "
        f"in [model.values] or in the ship file, or narrower [identify] bounds{_outside(problem)}"
    )


def _ends(p: Parameter) -> str:
    """The range of a parameter that has one."""
    if np.isfinite(p.low) and np.isfinite(p.high):
        return f"{p.low:g} to {p.high:g}"
    return f"at most {p.high:g}" if np.isfinite(p.high) else f"at least {p.low:g}"


def _outside(problem: Problem) -> str:
    """Values that no ship has, as far as the effects say, which are the first to look at."""
    model = problem.simulator.model
    found = (
        f"{n} = {model.value(n):g}, usually {_ends(p)}"
        for n, p in model.parameters.items()
        if not p.low <= model.value(n) <= p.high
    )
    said = ", ".join(found)
    return f" (first of all of {said})" if said else ""
