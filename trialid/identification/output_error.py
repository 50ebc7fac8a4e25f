"""The output error of a model against recorded trials, and its exact gradient (Eq. 3, 4, 6, 7).

The paper is written for one output. Here the residuals of each output are divided by the output's
own y_RMS (Eq. 8) and all outputs count alike unless weights are given, so that
V = 1/(2 n_y) sum_c 1/N_c sum_k (eps_c(k) / y_RMS,c)^2, which for one output and y_RMS = 1 is Eq. 4.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.identification.nuisance.delays import spoilt_by_delay
from trialid.identification.roll.roll_range import RollRange
from trialid.simulation.by_parts import respond_by_parts
from trialid.simulation.integrate import Departure, Response, Simulator, record_for, respond
from trialid.threads import side_by_side
from trialid.trial import Trial
from trialid.trial_rows import Kind, Stretch

Vector = NDArray[np.float64]
Norm = Literal["mean", "zero"]


@dataclass(frozen=True)
class Unknown:
    """One entry of theta.

    `column` is the simulator's name of it; `trial` the index of the only trial it acts in, None
    for a parameter that all trials share. What belongs to one trial or to a sensor is nuisance.
    """

    name: str
    column: str
    trial: int | None
    start: float
    size: float
    low: float
    high: float
    unit: str
    kind: Kind
    prior: tuple[float, float] | None = None


def ranges(unknowns: Sequence[Unknown]) -> tuple[Vector, Vector, Vector]:
    """Typical size, lower and upper bound of each; (n_theta,) each."""
    size, low, high = ([getattr(x, k) for x in unknowns] for k in ("size", "low", "high"))
    return np.array(size), np.array(low), np.array(high)


@dataclass(frozen=True)
class Problem:
    """Trials, a simulator and the unknowns: everything a residual is made of.

    Attributes
    ----------
    compared
        Per trial where measurement and simulation are compared; (N, n_y) each.
    y_rms, weights
        Norm of each output [SI] and its weight; (n_y,).
    roll
        What is known of any ship's roll, where her GM is free.
    """

    simulator: Simulator
    trials: tuple[Trial, ...]
    unknowns: tuple[Unknown, ...]
    compared: tuple[Mask, ...]
    y_rms: Vector
    weights: Vector
    roll: RollRange | None = None

    @property
    def start(self) -> Vector:
        """Start of every unknown; (n_theta,)."""
        return np.array([x.start for x in self.unknowns])

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the outputs."""
        return self.simulator.outputs

    def values(self, theta: Vector, trial: int) -> dict[str, float]:
        """Column name to value in one trial."""
        return {
            x.column: float(a)
            for x, a in zip(self.unknowns, theta, strict=True)
            if x.trial in (None, trial)
        }


def output_matrix(trial: Trial, outputs: Sequence[str]) -> Vector:
    """Recorded outputs; (N, n_y)."""
    return np.column_stack([trial.signals[c] for c in outputs])


def output_error(y: Vector, y_hat: Vector) -> Vector:
    """Eq. 3: eps(k) = y(k) - yhat(k), measured minus simulated; (N, n_y)."""
    return y - y_hat


def loss(residual: Vector) -> float:
    """Eq. 4: V = half the sum of squares of the normed, stacked residual."""
    return 0.5 * float(residual @ residual)


def gradient(problem: Problem, trial: int) -> tuple[list[int], list[int]]:
    """Eq. 6: Psi(k) = d yhat(k) / d theta by the variational equations: where it stands.

    The unknowns that act in this trial, and their columns among the simulator's sensitivities; by
    all others it is zero. (n,), (n,).
    """
    columns = {n: i for i, n in enumerate(problem.simulator.columns)}
    acting = [i for i, x in enumerate(problem.unknowns) if x.trial in (None, trial)]
    return acting, [columns[problem.unknowns[i].column] for i in acting]


def hessian(psi: Vector) -> Vector:
    """Eq. 7: H = 1/N sum Psi Psi^T, for the stacked normed gradient that holds the 1/N; (n, n).

    For printing only: steps and sensitivities come from `psi` itself.
    """
    return np.asarray(psi.T @ psi)


def respond_all(
    problem: Problem, theta: Vector, sensitivities: bool = True
) -> list[Response] | Departure:
    """Responses of all trials, or the first departure from the model's domain."""
    count, numbers = len(problem.trials), _numbers(problem, sensitivities)
    responses = []
    for one in side_by_side(partial(_respond, problem, theta, sensitivities), count, numbers):
        if one.departure is not None:
            return one.departure
        responses.append(one)
    return responses


def _numbers(problem: Problem, sensitivities: bool) -> int:
    """How many numbers a simulation of all trials works out."""
    equations = problem.simulator.equations
    columns = 1 + (equations.columns if sensitivities else 0)
    return sum(t.samples for t in problem.trials) * len(equations.states) * columns


def _respond(problem: Problem, theta: Vector, sensitivities: bool, trial: int) -> Response:
    values, start = _values_and_start(problem, theta, trial)
    return respond(problem.simulator, problem.trials[trial], values, start, sensitivities)


def _values_and_start(
    problem: Problem, theta: Vector, trial: int
) -> tuple[dict[str, float], dict[str, float]]:
    """Parameters by name, and the initial states among them by state."""
    values = problem.values(theta, trial)
    return values, {n[:-3]: a for n, a in values.items() if n.endswith("(0)")}


def residual_at(problem: Problem, theta: Vector) -> Vector | Departure:
    """Normed residual (M,), rows as in `stretches`."""
    responses = respond_all(problem, theta, sensitivities=False)
    if isinstance(responses, Departure):
        return responses
    scale = row_scale(problem)
    rows = [_rows_of(problem, p, responses[p.trial], scale) for p in stretches(problem)]
    return np.concatenate(rows)


def residual_of_trial(problem: Problem, theta: Vector, trial: int) -> Vector | Departure:
    """The rows of one trial alone, simulated without the others; (M_trial,)."""
    response = _respond(problem, theta, sensitivities=False, trial=trial)
    if response.departure is not None:
        return response.departure
    scale = row_scale(problem)
    mine = [p for p in stretches(problem) if p.trial == trial]
    return np.concatenate([_rows_of(problem, p, response, scale) for p in mine])


def _rows_of(problem: Problem, part: Stretch, response: Response, scale: Vector) -> Vector:
    """Normed residual of one output of one trial; (rows,)."""
    measured = problem.trials[part.trial].signals[problem.outputs[part.output]]
    eps = output_error(measured, response.y[:, part.output])
    return np.asarray(part.taken(eps) * scale[part.output])


def linearise(problem: Problem, theta: Vector, more: int = 0) -> tuple[Vector, Vector] | Departure:
    """Normed residual (M,) and normed gradient (M, n_theta), rows as in `stretches`.

    `more` rows below them are zero, for the caller to fill.
    """
    parts, scale = stretches(problem), row_scale(problem)
    residual = np.zeros(parts[-1].rows.stop + more)
    psi = np.zeros((len(residual), len(problem.unknowns)))

    def fill(i: int) -> Departure | None:
        mine = [p for p in parts if p.trial == i]
        response = _fill(problem, theta, i, [psi[p.rows] for p in mine], mine, scale)
        for part in mine if response.departure is None else ():
            residual[part.rows] = _rows_of(problem, part, response, scale)
        return response.departure

    departures = side_by_side(fill, len(problem.trials), _numbers(problem, True))
    departure = next((d for d in departures if d is not None), None)
    return departure or (residual, psi)


def _fill(
    problem: Problem,
    theta: Vector,
    trial: int,
    psi: Sequence[Vector],
    parts: Sequence[Stretch],
    scale: Vector,
) -> Response:
    """The response of a trial, its normed gradient written into the rows of each of its outputs.

    A whole gradient is larger than its rows: it comes part by part.
    """
    acting, places = gradient(problem, trial)
    begun = [0] * len(parts)

    def take(samples: slice, slopes: Vector) -> None:
        for k, part in enumerate(parts):
            some = part.within(samples, begun[k])
            rows = some.taken(slopes[:, part.output, places])
            rows *= scale[part.output]
            psi[k][some.rows, acting] = rows
            begun[k] = some.rows.stop

    values, start = _values_and_start(problem, theta, trial)
    response, added = respond_by_parts(
        problem.simulator, problem.trials[trial], values, start, take
    )
    for c, column, slopes in added if response.departure is None else ():
        for k, part in enumerate(parts):
            if part.output == c and column in places:
                psi[k][:, acting[places.index(column)]] += part.taken(slopes) * scale[c]
    return response


def row_scale(problem: Problem) -> Vector:
    """Weight / (y_RMS sqrt(N_c n_y)) of each output, so that squares sum to eps_RMSn^2; (n_y,)."""
    counts = np.sum([m.sum(axis=0) for m in problem.compared], axis=0)
    return np.asarray(problem.weights / (problem.y_rms * np.sqrt(counts * len(problem.outputs))))


def stretches(problem: Problem) -> tuple[Stretch, ...]:
    """Which rows are which output of which trial."""
    return stretches_of(problem.compared)


def stretches_of(compared: Sequence[Mask]) -> tuple[Stretch, ...]:
    """The same of trials whose outputs were compared at these samples; (N, n_y) each."""
    made, at = list[Stretch](), 0
    for i, masks in enumerate(compared):
        for c in range(masks.shape[1]):
            count = int(masks[:, c].sum())
            made.append(Stretch(i, c, slice(at, at + count), masks[:, c]))
            at += count
    return tuple(made)


def compared_mask(trial: Trial, simulator: Simulator) -> Mask:
    """Where an output and every input were measured, away from ends a delay may spoil; (N, n_y)."""
    inputs = np.ones(trial.samples, dtype=bool)
    for name in simulator.equations.inputs:
        source = record_for(trial, name)
        if source is not None and source in trial.valid:
            inputs &= trial.valid[source]
    columns = []
    for c in simulator.outputs:
        mask = inputs & trial.valid[c]
        edge = spoilt_by_delay(simulator, c, trial)
        if edge:
            mask[:edge] = mask[-edge:] = False
        columns.append(mask)
    return np.column_stack(columns)


def step_halving(problem: Problem, theta: Vector) -> dict[str, float]:
    """Integration error by output: normed difference to the same run with half the step."""
    simulator = problem.simulator
    finer = replace(problem, simulator=replace(simulator, substeps=2 * simulator.substeps))
    coarse, fine = (respond_all(p, theta, False) for p in (problem, finer))
    if isinstance(coarse, Departure) or isinstance(fine, Departure):
        return {}
    result = {}
    for c, name in enumerate(problem.outputs):
        gaps = [a.y[:, c] - b.y[:, c] for a, b in zip(coarse, fine, strict=True)]
        result[name] = float(np.sqrt(np.mean(np.concatenate(gaps) ** 2)) / problem.y_rms[c])
    return result
