"""The response of a ship model to a recorded input, with its exact sensitivities."""

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from trialid.errors import EffectError, NotIdentifiable, nearest
from trialid.names.quantities import SIGNALS
from trialid.ship.effect import Delayed, Effect, Steered
from trialid.ship.model import ShipModel, late, slope
from trialid.simulation import kernel
from trialid.simulation.delay import delay_samples
from trialid.simulation.kernel import Kernel
from trialid.simulation.readout import Readout, sensor_outputs
from trialid.simulation.reference import Reference
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

    def __reduce__(self) -> tuple[object, ...]:
        """By what it is made ready from: machine code is of one process."""
        engine = "compiled" if isinstance(self.engine, Kernel) else "numpy"
        made_of = (self.model, self.equations.free, self.outputs, engine, self.substeps)
        return prepare, made_of

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
    def readout(self) -> Readout:
        """How outputs follow from states."""
        return Readout(self.equations, self.outputs)


def initial(state: str) -> str:
    """The name of an initial state among the columns.

    >>> initial("v")
    'v(0)'
    """
    return f"{state}(0)"


def starts_of(values: Mapping[str, float]) -> dict[str, float]:
    """Initial states among the columns of a simulation, by the state's name."""
    return {n[:-3]: a for n, a in values.items() if n.endswith("(0)")}


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
            known = None if follows is None else record_for(trial, follows)
            return 0.0 if known is None else float(trial.signals[known][0])
    if state in trial.signals:
        return float(trial.signals[state][0])
    return model.ship.particulars["U0"] if state == "u" else 0.0


def record_for(trial: Trial, name: str) -> str | None:
    """The record that serves as this input: its own, or its order's, as of a perfect gear."""
    for candidate in (name, f"{name}_order"):
        if candidate in trial.signals:
            return candidate
    return None


def shared_record(trials: Sequence[Trial]) -> Trial:
    """The first trial with what every one of them has a record of."""
    first = trials[0]
    kept = {n: x for n, x in first.signals.items() if all(record_for(t, n) for t in trials)}
    return replace(first, signals=kept)


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
    for name, tau in late_by(model, known, trial.t).items():
        columns[name], by_lag = delay_samples(columns[name], tau / trial.period)
        columns[late(name)] = np.full(trial.samples, tau)
        columns[slope(name)] = by_lag / trial.period
    made = [columns[n] for n in simulator.equations.inputs]
    return np.column_stack(made) if made else np.zeros((trial.samples, 0))


def late_by(model: ShipModel, known: Mapping[str, float], t: Vector) -> dict[str, float | Vector]:
    """By how much each late input acts after it is recorded [s]; (N,) where its clock drifts.

    `t` are the times of the samples [s]; (N,).
    """
    total: dict[str, float | Vector] = dict.fromkeys(model.late_inputs, 0.0)
    for effect in model.effects if total else ():
        if set(effect.acts_on(Delayed)) & set(total):
            values = {p: known.get(p, 0.0) for p in effect.parameters}
            for part in effect(dict.fromkeys(effect.signals, 0.0) | {"t": t} | values):
                if isinstance(part, Delayed):
                    total |= {n: total[n] + x for n, x in part.items() if n in total}
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
