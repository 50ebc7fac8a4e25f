"""The response of a ship model to a recorded input, with its exact sensitivities."""

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from trialid.errors import EffectError, NotIdentifiable, nearest
from trialid.names.quantities import SIGNALS
from trialid.ship.effect import Delayed, Effect, Steered
from trialid.ship.model import ShipModel, late, slope
from trialid.simulation import kernel
from trialid.simulation.delay import delay_samples, lag_samples, shift
from trialid.simulation.graph import Node, gradient
from trialid.simulation.kernel import Kernel
from trialid.simulation.reference import Reference, evaluator
from trialid.simulation.trace import Equations, trace
from trialid.trial import Trial

Vector = NDArray[np.float64]
Engine = Literal["compiled", "numpy"]

DOMAIN: Final = {"phi": 1.4, "p": 10.0}
"""Bounds of a motion that do not depend on the ship: 80 deg of heel, 10 rad/s of roll."""


@dataclass(frozen=True)
class Departure:
    """Where a simulation left the domain of its model."""

    state: str
    t: float
    value: float

    def __str__(self) -> str:
        """Say it in words, in the unit of reports."""
        quantity = SIGNALS.get(self.state)
        factor = np.rad2deg(1.0) if quantity and quantity.shown.startswith("deg") else 1.0
        unit = quantity.shown if quantity else ""
        value = f"{self.value * factor:.3g} {unit}" if np.isfinite(self.value) else "not a number"
        return f"{self.state} left the model's domain at t = {self.t:.1f} s ({value})"


@dataclass(frozen=True)
class Response:
    """What a model does in one trial.

    Attributes
    ----------
    states
        (N, n_x); NaN after a departure.
    y
        Simulated outputs as recorded: with bias and delay; (N, n_y).
    S
        dy / d(columns); (N, n_y, n_columns), or None when not asked for.
    departure
        Where the simulation left the domain, or None.
    """

    states: Vector
    y: Vector
    S: Vector | None
    departure: Departure | None


@dataclass(frozen=True)
class Simulator:
    """A model made ready to run: traced, and compiled on first use.

    Attributes
    ----------
    columns
        What sensitivities are by: free parameters, then the initial states as `v(0)`.
    """

    model: ShipModel
    equations: Equations
    engine: Kernel | Reference
    outputs: tuple[str, ...]
    substeps: int

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the sensitivity columns, in the order of `Response.S`."""
        return (*self.equations.free, *(initial(s) for s in self.equations.states))

    @functools.cached_property
    def fixed(self) -> dict[str, float]:
        """Values of the parameters that are not free."""
        eq = self.equations
        return {n: self.model.value(n) for n in eq.parameters if n not in eq.free}

    @functools.cached_property
    def readout(self) -> "_Readout":
        """How outputs follow from states."""
        return _Readout(self.equations, self.outputs)


def initial(state: str) -> str:
    """The name of an initial state among the columns.

    >>> initial("v")
    'v(0)'
    """
    return f"{state}(0)"


def prepare(
    model: ShipModel,
    free: Sequence[str],
    outputs: Sequence[str],
    engine: Engine = "compiled",
    substeps: int = 1,
) -> Simulator:
    """Trace a model for these free parameters and outputs.

    Raises
    ------
    EffectError
        An output or free parameter the model does not have.
    """
    for name in free:
        if name not in model.parameters:
            known = nearest(name, model.parameters)
            raise EffectError(f"free parameter {name!r} is in no effect of the model; {known}")
    equations = trace(model, free, outputs)
    compiled = engine == "compiled" and kernel.available()
    made = Kernel(equations) if compiled else Reference(equations)
    return Simulator(model, equations, made, tuple(outputs), substeps)


def respond(
    simulator: Simulator,
    trial: Trial,
    values: Mapping[str, float],
    start: Mapping[str, float],
    sensitivities: bool = True,
) -> Response:
    """Eq. 2: the simulated output, from the recorded input and the parameters alone.

    Parameters
    ----------
    values
        The free parameters.
    start
        Initial states that are not to be guessed from the record.
    """
    run, h = simulator.engine, trial.period
    theta, x0, u, limit = arguments(simulator, trial, values, start)
    if not sensitivities:
        X, left = run.simulate(theta, x0, u, limit, h, simulator.substeps)
        y, _ = sensor_outputs(simulator, h, X, None, u, theta)
        return Response(X, y, None, departure(simulator, X, left, h, limit))
    X, S, left = run.sensitivities(theta, x0, u, limit, h, simulator.substeps)
    y, dy = sensor_outputs(simulator, h, X, S, u, theta)
    return Response(X, y, dy, departure(simulator, X, left, h, limit))


def arguments(
    simulator: Simulator, trial: Trial, values: Mapping[str, float], start: Mapping[str, float]
) -> tuple[Vector, Vector, Vector, Vector]:
    """Parameters, initial states, inputs and bounds of a run; (n_p,), (n_x,), (N, n_u), (n_x,)."""
    eq = simulator.equations
    known = {**simulator.fixed, **values}
    theta = np.array([known[n] for n in eq.parameters])
    x0 = np.array([start.get(s, guess(simulator.model, trial, s)) for s in eq.states])
    return theta, x0, inputs(simulator, trial, known), domain(simulator.model)


def guess(model: ShipModel, trial: Trial, state: str) -> float:
    """Where a state starts when nobody says: as recorded, else at rest on a straight course."""
    for effect in model.effects:
        if state in effect.states:
            follows = effect.states[state]
            known = follows is not None and follows in trial.signals
            return float(trial.signals[follows][0]) if follows and known else 0.0
    if state in trial.signals:
        return float(trial.signals[state][0])
    return model.ship.particulars["U0"] if state == "u" else 0.0


def record_for(trial: Trial, name: str) -> str | None:
    """The record that serves as this input: its own, or its order's, as of a perfect gear."""
    for candidate in (name, f"{name}_order"):
        if candidate in trial.signals:
            return candidate
    return None


def inputs(simulator: Simulator, trial: Trial, known: Mapping[str, float]) -> Vector:
    """The recorded signals the equations need; (N, n_u). Speed not recorded is the approach speed.

    Parameters
    ----------
    known
        Values of all parameters: some may delay an input.

    Raises
    ------
    NotIdentifiable
        The trial lacks a signal.
    """
    model = simulator.model
    shifts = {word for n in model.late_inputs for word in (late(n), slope(n))}
    columns = {n: _input(model, trial, n) for n in simulator.equations.inputs if n not in shifts}
    for name, tau in late_by(model, known).items():
        columns[name], by_lag = delay_samples(columns[name], tau / trial.period)
        columns[late(name)] = np.full(trial.samples, tau)
        columns[slope(name)] = by_lag / trial.period
    made = [columns[n] for n in simulator.equations.inputs]
    return np.column_stack(made) if made else np.zeros((trial.samples, 0))


def late_by(model: ShipModel, known: Mapping[str, float]) -> dict[str, float]:
    """By how much each late input acts after it is recorded [s]."""
    total = dict.fromkeys(model.late_inputs, 0.0)
    for effect in model.effects if total else ():
        if set(effect.acts_on(Delayed)) & set(total):
            values = {p: known.get(p, 0.0) for p in effect.parameters}
            for part in effect(dict.fromkeys(effect.signals, 0.0) | values):
                if isinstance(part, Delayed):
                    total |= {n: total[n] + float(x) for n, x in part.items() if n in total}
    return total


def _input(model: ShipModel, trial: Trial, name: str) -> Vector:
    if name == "t":
        return trial.t
    source = record_for(trial, name)
    if source is not None:
        return trial.signals[source]
    if name == "u":
        return np.full(trial.samples, model.ship.particulars["U0"])
    users = [e.name for e in model.effects if name in signals_of(e)] or ["kinematics"]
    raise NotIdentifiable(
        f"trial {trial.name!r} has no signal {name!r}, which effect {', '.join(users)!r} needs: "
        "map it in [trial.signals], simulate it in [model] states, or leave the effect out"
    )


def signals_of(effect: Effect) -> tuple[str, ...]:
    """Every signal an effect reads, adds to as it acts, or delays."""
    return (*effect.signals, *effect.acts_on(Steered, Delayed))


def domain(model: ShipModel) -> Vector:
    """Bounds on |x| beyond which the equations mean nothing; (n_x,).

    Speeds are held against the larger of the approach speed and sqrt(g L), turning against the
    same speed over a third of the length; headings and added states are free.
    """
    L, g, U0 = (model.ship.particulars[n] for n in ("L", "g", "U0"))
    speed = max(U0, float(np.sqrt(g * L)))
    bounds = {**DOMAIN, "u": 3.0 * speed, "v": 2.0 * speed, "r": 3.0 * speed / L}
    return np.array([bounds.get(s, np.inf) for s in model.all_states])


def departure(
    simulator: Simulator, X: Vector, left: int, period: float, limit: Vector
) -> Departure | None:
    """Where states left their bounds, from the sample at which they did; None where it is 0."""
    if left == 0:
        return None
    outside = int(np.flatnonzero(~(np.abs(X[left]) < limit))[0])
    return Departure(simulator.equations.states[outside], left * period, float(X[left, outside]))


class _Readout:
    """Outputs and their derivatives by states and parameters, as functions of arrays."""

    def __init__(self, eq: Equations, outputs: tuple[str, ...]) -> None:
        symbols = (*eq.states, *eq.inputs, *eq.parameters)
        table = {n.value: n for n in eq.graph.nodes if n.op == "symbol"}
        self.kept = [eq.states[i] for i in eq.kept]
        by = [table[s] for s in (*self.kept, *eq.free) if s in table]
        self.by = [n.value for n in by]
        nodes = [eq.outputs[c] for c in outputs]
        slopes = [gradient(n, by) for n in nodes]
        self.entries = [
            (c, i) for c, row in enumerate(slopes) for i, d in enumerate(row) if not _zero(d)
        ]
        states = [(c, self.by[i], slopes[c][i]) for c, i in self.entries if self.by[i] in self.kept]
        alike = len(self.kept) == len(outputs) and all(d.is_constant(1.0) for *_, d in states)
        self.plain = alike and [(c, s) for c, s, _ in states] == list(enumerate(self.kept))
        # every output is a state of its own: S is what is asked for
        self.value = evaluator(nodes, symbols, scalar=False)
        self.slope = evaluator([slopes[c][i] for c, i in self.entries], symbols, scalar=False)
        self.delay = {c: _Timing(eq, eq.delays[c], table) for c in outputs}
        self.lags = {c: [_Timing(eq, lag, table) for lag in eq.lags[c]] for c in outputs}


class _Timing:
    """A delay or a time constant, and its derivatives by the free parameters."""

    def __init__(self, eq: Equations, node: Node, table: Mapping[str, Node]) -> None:
        symbols = (*eq.states, *eq.inputs, *eq.parameters)
        slopes = gradient(node, [table[s] for s in eq.free])
        self.absent = _zero(node)
        self.by = [i for i, d in enumerate(slopes) if not _zero(d)]
        self.value = evaluator([node], symbols, scalar=False)
        self.slopes = evaluator([slopes[i] for i in self.by], symbols, scalar=False)


def _zero(node: Node) -> bool:
    return node.is_constant(0.0)


def sensor_outputs(
    simulator: Simulator, period: float, X: Vector, S: Vector | None, u: Vector, theta: Vector
) -> tuple[Vector, Vector | None]:
    """Outputs as a sensor records them, from states; (N, n_y), (N, n_y, n_columns)."""
    read = simulator.readout
    symbols = [*X.T, *u.T, *theta]
    y = np.column_stack([np.broadcast_to(c, len(X)) for c in read.value(symbols)])
    if S is None:
        return _late(simulator, period, y, None, symbols)
    dy = _slopes(simulator, S, read.slope(symbols))
    return _late(simulator, period, y, dy, symbols)


def _slopes(simulator: Simulator, S: Vector, slopes: Sequence[Vector | float]) -> Vector:
    """Sensitivities of the outputs from those of the kept states, in place where they are alike."""
    read, free, width = simulator.readout, simulator.equations.free, len(simulator.columns)
    dy = S[..., :width] if read.plain else np.zeros((len(S), len(simulator.outputs), width))
    for (c, i), factor in zip(read.entries, slopes, strict=True):
        name = read.by[i]
        if name not in read.kept:
            dy[:, c, free.index(name)] += factor
        elif not read.plain:
            wide = np.broadcast_to(factor, len(S))[:, None]
            dy[:, c] += wide * S[:, read.kept.index(name), :width]
    return dy


def _late(
    simulator: Simulator, period: float, y: Vector, dy: Vector | None, symbols: Sequence[Any]
) -> tuple[Vector, Vector | None]:
    """Apply the low-passes and delays of the outputs, with the derivatives by their parameters."""
    read = simulator.readout
    for c, output in enumerate(simulator.outputs):
        for lag in read.lags[output]:
            [tau] = lag.value(symbols)
            y[:, c], by_tau = lag_samples(y[:, c], float(tau), period)
            if dy is not None:
                dy[:, c] = lag_samples(dy[:, c], float(tau), period)[0]
                _add_slopes(dy[:, c], lag, by_tau, symbols)
        if read.delay[output].absent:
            continue
        [tau] = read.delay[output].value(symbols)
        y[:, c], by_lag = delay_samples(y[:, c], tau / period)
        if dy is not None:
            dy[:, c] = shift(dy[:, c], tau / period)
            _add_slopes(dy[:, c], read.delay[output], by_lag / period, symbols)
    return y, dy


def _add_slopes(dy: Vector, timing: _Timing, by_time: Vector, symbols: Sequence[Any]) -> None:
    """Chain rule, in place: what a parameter does to a time, and the time to the output."""
    for i, slope_ in zip(timing.by, timing.slopes(symbols), strict=True):
        dy[:, i] += by_time * slope_
