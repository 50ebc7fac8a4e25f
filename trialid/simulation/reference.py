"""The same simulation in plain Python and NumPy: the reference, and the fallback without LLVM.

First the states run through RK4 step by step; then everything the sensitivities need is evaluated
at all stages at once; then the sensitivities run through the same RK4.
"""

import functools
import math
from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trialid.simulation.graph import CONSTANT, SYMBOL, Node, order
from trialid.simulation.trace import Equations

Vector = NDArray[np.float64]
STAGES: Final = ((0.0, 1 / 6), (0.5, 1 / 3), (0.5, 1 / 3), (1.0, 1 / 6))


def _expression(node: Node) -> str:
    args = [f"a{a.index}" for a in node.args]
    if node.op in "+-*/":
        return f"{args[0]} {node.op} {args[1]}"
    return f"{node.op}_({', '.join(args)})"


def evaluator(outputs: Sequence[Node], symbols: Sequence[str], scalar: bool) -> Callable[..., Any]:
    """A Python function of the symbols that returns the outputs; for floats or for arrays."""
    lines = []
    for node in order(outputs):
        if node.op == CONSTANT:
            lines.append(f"    a{node.index} = {node.value!r}")
        elif node.op == SYMBOL:
            lines.append(f"    a{node.index} = s[{symbols.index(node.value)}]")
        else:
            lines.append(f"    a{node.index} = {_expression(node)}")
    listed = "".join(f"a{n.index}, " for n in outputs)
    text = "\n".join(["def run(s):", *lines, f"    return ({listed})"])
    scope = dict(_FLOAT if scalar else _ARRAY)
    exec(text, scope)
    run: Callable[..., Any] = scope["run"]  # type: ignore[assignment]
    return run


_FLOAT: Final[dict[str, object]] = {
    "abs_": abs, "sign_": lambda x: math.copysign(1.0, x), "arctan_": math.atan,
    "sqrt_": lambda x: math.sqrt(x) if x >= 0.0 else math.nan,
    "sin_": lambda x: math.sin(x) if math.isfinite(x) else math.nan,
    "cos_": lambda x: math.cos(x) if math.isfinite(x) else math.nan,
    "exp_": lambda x: math.exp(x) if x < 700.0 else math.inf,
    "tanh_": math.tanh,
    "clip_": lambda x, a: min(max(x, -a), a),
    "inside_": lambda x, a: 1.0 if abs(x) < a else 0.0,
}  # fmt: skip
_ARRAY: Final[dict[str, object]] = {
    "abs_": np.abs, "sign_": lambda x: np.copysign(1.0, x), "arctan_": np.arctan,
    "sqrt_": np.sqrt, "sin_": np.sin, "cos_": np.cos, "exp_": np.exp, "tanh_": np.tanh,
    "clip_": lambda x, a: np.minimum(np.maximum(x, -a), a),
    "inside_": lambda x, a: np.where(np.abs(x) < a, 1.0, 0.0),
}  # fmt: skip


class Reference:
    """The equations of one model structure on plain Python; same calls as `kernel.Kernel`."""

    def __init__(self, equations: Equations) -> None:
        self.equations = equations
        self._symbols = (*equations.states, *equations.inputs, *equations.parameters)

    @functools.cached_property
    def _f(self) -> Callable[..., Any]:
        return evaluator(self.equations.f, self._symbols, scalar=True)

    @functools.cached_property
    def _drives(self) -> Callable[..., Any]:
        eq = self.equations
        nodes = [*eq.J.values(), *eq.W.values(), *(g for d in eq.G for g in d.values())]
        return evaluator(nodes, self._symbols, scalar=False)

    def simulate(
        self, theta: Vector, x0: Vector, u: Vector, limit: Vector, h: float, substeps: int
    ) -> tuple[Vector, int]:
        """States at every sample (N, n_x), and the sample at which they left the domain."""
        X, _, left = self._states(theta, x0, u, limit, h, substeps)
        return X, left

    def sensitivities(
        self, theta: Vector, x0: Vector, u: Vector, limit: Vector, h: float, substeps: int
    ) -> tuple[Vector, Vector, int]:
        """States, and d(kept states)/d(free parameters, initial states); (N, n_kept, columns)."""
        eq = self.equations
        X, stages, left = self._states(theta, x0, u, limit, h, substeps)
        n_x, free = len(eq.states), len(eq.free)
        s = np.zeros((n_x, eq.columns))
        s[np.arange(n_x), free + np.arange(n_x)] = 1.0
        S = np.full((len(u), len(eq.kept), eq.columns), np.nan)
        S[0] = s[list(eq.kept)]
        if len(stages) == 0:
            return X, S, left
        J, F = self._matrices(theta, stages)
        for step in range(len(J)):
            s = _step(s, J[step], F[step], h / substeps)
            if (step + 1) % substeps == 0:
                S[(step + 1) // substeps] = s[list(eq.kept)]
        return X, S, left

    def _states(
        self, theta: Vector, x0: Vector, u: Vector, limit: Vector, h: float, substeps: int
    ) -> tuple[Vector, Vector, int]:
        """States at the samples and all signals at every stage; (N, n_x), (steps, 4, n)."""
        step, th = h / substeps, [float(p) for p in theta]
        X = np.full((len(u), len(x0)), np.nan)
        X[0] = x0
        x, stages = [float(a) for a in x0], []
        for k in range(len(u) - 1):
            u0, du = u[k], u[k + 1] - u[k]
            for j in range(substeps):
                total, seen = [0.0] * len(x), []
                slope: Sequence[float] = [0.0] * len(x)
                for ahead, weight in STAGES:
                    now = [a + ahead * step * b for a, b in zip(x, slope, strict=True)]
                    signals = [*now, *(u0 + du * ((j + ahead) / substeps)).tolist(), *th]
                    slope = self._slope(signals)
                    total = [a + weight * step * b for a, b in zip(total, slope, strict=True)]
                    seen.append(signals)
                x = [a + b for a, b in zip(x, total, strict=True)]
                stages.append(seen)
            X[k + 1] = x
            if not all(abs(a) < b for a, b in zip(x, limit, strict=True)):
                return X, np.array(stages), k + 1
        return X, np.array(stages), 0

    def _slope(self, signals: list[float]) -> Sequence[float]:
        try:
            found: Sequence[float] = self._f(signals)
        except (ZeroDivisionError, OverflowError):
            found = [math.nan] * len(self.equations.states)
        return found

    def _matrices(self, theta: Vector, stages: Vector) -> tuple[Vector, Vector]:
        """J and W G at every stage; (steps, 4, n_x, n_x), (steps, 4, n_x, columns)."""
        eq = self.equations
        steps, n_x = len(stages), len(eq.states)
        with np.errstate(all="ignore"):
            values = iter(self._drives(np.moveaxis(stages, 2, 0)))
        J, W = (np.zeros((steps, 4, n_x, n_x)) for _ in range(2))
        G = np.zeros((steps, 4, n_x, eq.columns))
        for i, j in eq.J:
            J[..., i, j] = next(values)
        for i, row in eq.W:
            W[..., i, row] = next(values)
        for column, drive in enumerate(eq.G):
            for row in drive:
                G[..., row, column] = next(values)
        return J, W @ G


def _step(s: Vector, J: Vector, F: Vector, step: float) -> Vector:
    """One RK4 step of ds/dt = J s + F with J, F at the four stages."""
    total, slope = np.zeros_like(s), np.zeros_like(s)
    for i, (ahead, weight) in enumerate(STAGES):
        slope = J[i] @ (s + ahead * step * slope) + F[i]
        total = total + weight * slope
    moved: Vector = s + step * total
    return moved
