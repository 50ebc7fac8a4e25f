"""The linear response of a fitted model to a small force, along its own simulated path.

Along the path x(t) of a trial a force w in one equation moves the states by z with
dz/dt = J(t) z + W(t) w, the variational equation of the simulator with w in the place of a
parameter. The transition over one step is the exponential of the step's mean J, and w is held at
its mean over the step.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit
from trialid.identification.output_error import row_scale
from trialid.ship.effect import Steered
from trialid.ship.model import STANDSTILL
from trialid.ship.rigid_body import ROWS
from trialid.simulation.delay import shift
from trialid.simulation.graph import gradient
from trialid.simulation.integrate import Simulator, inputs
from trialid.simulation.reference import evaluator
from trialid.trial import Trial

Vector = NDArray[np.float64]

ORDER: Final = 6
"""Terms of the exponential's series; with the argument below 1/2 the rest is under 1e-6."""


@dataclass(frozen=True)
class Path:
    """One trial's simulated path on a clock of its own, and the linear system along it.

    Attributes
    ----------
    trial
        Its index among the trials to fit.
    at
        Samples of the trial that the clock keeps; (n,).
    signals
        States, inputs and recorded signals as they act on the ship, U and particulars [SI]; (n,).
    E, D
        Transition of the states over a step, and what a force in each equation adds; (n-1, n_x,
        n_x), (n-1, n_x, n_rows).
    C
        Normed outputs by states; (n, n_y, n_x).
    rows
        Equations that a force can act in: some of X, Y, K, N.
    """

    trial: int
    name: str
    at: NDArray[np.intp]
    t: Vector
    signals: Mapping[str, Vector]
    E: Vector
    D: Vector
    C: Vector
    delays: Vector
    rows: tuple[str, ...]

    @property
    def step(self) -> float:
        """Period of the clock [s]."""
        return float(self.t[1] - self.t[0])


def path(fit: Fit, index: int, every: int) -> Path:
    """The linear system along one fitted trial, on every so many samples."""
    problem, simulator = fit.problem, fit.problem.simulator
    trial = problem.trials[index]
    score = next(s for s in fit.scores if s.trial is trial)
    at = np.arange(0, trial.samples, every)
    values = {**simulator.fixed, **problem.values(fit.theta, index)}
    X, u = score.response.states[at], inputs(simulator, trial, values)[at]
    theta = np.array([values[n] for n in simulator.equations.parameters])
    symbols = [*X.T, *u.T, *theta]
    rows = tuple(ROWS[s] for s in simulator.equations.states if s in ROWS)
    J, W = _system(simulator, symbols, len(at))
    step, t = every * trial.period, np.asarray(at * trial.period, dtype=np.float64)
    E, P = _exponential(0.5 * step * (J[1:] + J[:-1]))
    D = step * P @ (0.5 * (W[1:] + W[:-1]))
    return Path(
        trial=index,
        name=trial.name,
        at=at,
        t=t,
        signals=_acting(simulator, trial, X, u, values, at),
        E=E,
        D=D,
        C=_slopes(simulator, symbols, len(at)) * row_scale(problem)[:, None],
        delays=np.asarray(_delays(simulator, symbols) / step),
        rows=rows,
    )


def _delays(simulator: Simulator, symbols: list[Vector]) -> Vector:
    """How late each output is, a drifting clock at its mean [s]; (n_y,)."""
    timings = (simulator.readout.delay[c] for c in simulator.outputs)
    return np.array([float(np.mean(t.value(symbols)[0])) for t in timings])


def _system(simulator: Simulator, symbols: list[Vector], n: int) -> tuple[Vector, Vector]:
    """J (n, n_x, n_x), and W of the force equations (n, n_x, n_rows)."""
    eq = simulator.equations
    names = (*eq.states, *eq.inputs, *eq.parameters)
    driven = [i for i, s in enumerate(eq.states) if s in ROWS]
    entries = [k for k in eq.W if k[1] in driven]
    run = evaluator([*eq.J.values(), *(eq.W[k] for k in entries)], names, scalar=False)
    found = iter(run(symbols))
    J, W = np.zeros((n, len(eq.states), len(eq.states))), np.zeros((n, len(eq.states), len(driven)))
    for i, j in eq.J:
        J[:, i, j] = next(found)
    for i, row in entries:
        W[:, i, driven.index(row)] = next(found)
    return J, W


def _slopes(simulator: Simulator, symbols: list[Vector], n: int) -> Vector:
    """Outputs by states; (n, n_y, n_x)."""
    eq = simulator.equations
    table = {node.value: node for node in eq.graph.nodes if node.op == "symbol"}
    states = [table[s] for s in eq.states]
    nodes = [d for c in simulator.outputs for d in gradient(eq.outputs[c], states)]
    found = evaluator(nodes, (*eq.states, *eq.inputs, *eq.parameters), scalar=False)(symbols)
    made = np.column_stack([np.broadcast_to(d, n) for d in found])
    return made.reshape(n, len(simulator.outputs), len(states))


def _exponential(A: Vector) -> tuple[Vector, Vector]:
    """exp(A) and the mean of exp(s A) over 0 < s < 1, of many matrices at once; (n, n_x, n_x)."""
    largest = float(np.abs(A).sum(axis=2).max(initial=0.0))
    halvings = max(int(np.ceil(np.log2(max(2.0 * largest, 1.0)))), 0)
    A = A / 2.0**halvings
    one = np.broadcast_to(np.eye(A.shape[1]), A.shape)
    term, mean = one, one.copy()
    for k in range(2, ORDER + 2):
        term = term @ A / k
        mean = mean + term
    whole = one + A @ mean
    for _ in range(halvings):
        mean = 0.5 * (mean + whole @ mean)
        whole = whole @ whole
    return whole, mean


def _acting(
    simulator: Simulator, trial: Trial, X: Vector, u: Vector, values: Mapping[str, float],
    at: NDArray[np.intp],
) -> dict[str, Vector]:  # fmt: skip
    """Every signal an effect could read, with what steering adds to the rudder; SI."""
    eq, model = simulator.equations, simulator.model
    signals = {n: x[at] for n, x in trial.signals.items()}
    signals |= dict(zip(eq.inputs, u.T, strict=True)) | dict(zip(eq.states, X.T, strict=True))
    signals |= {n: np.full(len(at), x) for n, x in model.ship.particulars.items()}
    theta = {n: values.get(n, 0.0) for n in model.parameters}
    for effect in model.effects:
        if Steered in effect.forms:
            for part in effect({**signals, **theta}):
                if isinstance(part, Steered):
                    signals |= {n: signals[n] + x for n, x in part.items()}
    speed = np.hypot(signals["u"], signals.get("v", np.zeros(len(at))))
    signals["U"] = np.hypot(speed, STANDSTILL)  # as it is simulated: by none no motion has a number
    return signals


def response(path: Path, row: str, forces: Vector) -> Vector:
    """Normed outputs that forces in one equation cause; (n, q) [SI] to (n, n_y, q)."""
    n, n_y = path.C.shape[:2]
    drive = path.D[:, :, path.rows.index(row)]
    held = 0.5 * (forces[1:] + forces[:-1])
    y = np.zeros((n, n_y, forces.shape[1]))
    z = np.zeros((path.E.shape[1], forces.shape[1]))
    for k in range(n - 1):
        z = path.E[k] @ z + np.multiply.outer(drive[k], held[k])
        np.matmul(path.C[k + 1], z, out=y[k + 1])
    for c, lag in enumerate(path.delays):
        if lag:
            y[:, c] = shift(y[:, c], lag)
    return y
