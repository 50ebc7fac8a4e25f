"""Outputs as sensors record them, from states: their noiseless value, late and low-passed."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trialid.simulation.delay import delay_samples, lag_samples, shift
from trialid.simulation.graph import Node, gradient
from trialid.simulation.reference import evaluator
from trialid.simulation.trace import Equations

if TYPE_CHECKING:
    from trialid.simulation.integrate import Simulator

Vector = NDArray[np.float64]
Added = tuple[int, int, Vector]
"""An output, a column, and what is added to its sensitivity at every sample; (N,)."""


class Readout:
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
        self.delay = {c: Timing(eq, eq.delays[c], table) for c in outputs}
        self.lags = {c: [Timing(eq, lag, table) for lag in eq.lags[c]] for c in outputs}


class Timing:
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
    simulator: "Simulator", period: float, X: Vector, S: Vector | None, u: Vector, theta: Vector
) -> tuple[Vector, Vector | None]:
    """Outputs as a sensor records them, from states; (N, n_y), (N, n_y, n_columns)."""
    symbols = [*X.T, *u.T, *theta]
    dy = None if S is None else output_slopes(simulator, S, symbols)
    return late_outputs(simulator, period, len(X), symbols, dy), dy


def output_slopes(simulator: "Simulator", S: Vector, symbols: Sequence[Any]) -> Vector:
    """Sensitivities of the outputs, before what they are late by, from those of the states."""
    return _slopes(simulator, S, simulator.readout.slope(symbols))


def _slopes(simulator: "Simulator", S: Vector, slopes: Sequence[Vector | float]) -> Vector:
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


def late_outputs(
    simulator: "Simulator",
    period: float,
    samples: int,
    symbols: Sequence[Any],
    dy: Vector | None,
    added: list[Added] | None = None,
) -> Vector:
    """Outputs through their low-passes and delays, (N, n_y); what they are by goes into `dy`.

    Without `dy` the derivatives by the parameters of low-passes and delays go to `added`.
    """
    read = simulator.readout
    y = np.column_stack([np.broadcast_to(c, samples) for c in read.value(symbols)])
    valued = dy is None and added is None
    for c, output in enumerate(simulator.outputs):
        slow = _slow_output(simulator, period, c, y, dy, symbols)
        delay = read.delay[output]
        if not delay.absent:
            [tau] = delay.value(symbols)
            if valued:  # nobody asks for slopes
                y[:, c] = shift(y[:, c], tau / period)
                continue
            y[:, c], by_lag = delay_samples(y[:, c], tau / period)
            if dy is not None:
                dy[:, c] = shift(dy[:, c], tau / period)
            slow = [(c, i, shift(more, tau / period)) for _, i, more in slow]
            slow += _add_slopes(dy, c, delay, by_lag / period, symbols)
        if added is not None:
            added += slow
    return y


def _slow_output(
    simulator: "Simulator",
    period: float,
    c: int,
    y: Vector,
    dy: Vector | None,
    symbols: Sequence[Any],
) -> list[Added]:
    """One output through its low-passes, in place; what was not added to `dy`."""
    slow: list[Added] = []
    for lag in simulator.readout.lags[simulator.outputs[c]]:
        [tau] = lag.value(symbols)
        y[:, c], by_tau = lag_samples(y[:, c], float(tau), period)
        if dy is not None:
            dy[:, c] = lag_samples(dy[:, c], float(tau), period)[0]
        slow += _add_slopes(dy, c, lag, by_tau, symbols)
    return slow


def _add_slopes(
    dy: Vector | None, c: int, timing: Timing, by_time: Vector, symbols: Sequence[Any]
) -> list[Added]:
    """Chain rule: what a parameter does to a time, and that to the output; in place, or told."""
    told: list[Added] = []
    for i, slope_ in zip(timing.by, timing.slopes(symbols), strict=True):
        if dy is None:
            told.append((c, i, by_time * slope_))
        else:
            dy[:, c, i] += by_time * slope_
    return told
