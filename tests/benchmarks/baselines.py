"""What one would write without trialid: an integrator in Python and forward differences."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from trialid.simulation.reference import STAGES, evaluator
from trialid.simulation.trace import Equations

Vector = NDArray[np.float64]

RTOL = 1e-8
ATOL = 1e-12
"""Rates are around 0.01 rad/s: SciPy's own 1e-6 would spoil their fourth digit."""

STEP = 1e-5
"""Relative step of the forward differences."""


def slope(eq: Equations, scalar: bool) -> Callable[..., Any]:
    """dx/dt as plain Python, common parts computed once: better than what one writes by hand."""
    return evaluator(eq.f, (*eq.states, *eq.inputs, *eq.parameters), scalar=scalar)


def lsoda(eq: Equations, theta: Vector, x0: Vector, u: Vector, h: float) -> Vector:
    """States at the samples by `solve_ivp`, the input linear between samples; (N, n_x)."""
    f, th, rows, last = slope(eq, scalar=True), theta.tolist(), u.tolist(), len(u) - 2

    def rate(t: float, x: Vector) -> Any:
        k = min(int(t / h), last)
        w = t / h - k
        now = [a + w * (b - a) for a, b in zip(rows[k], rows[k + 1], strict=True)]
        return f([*x.tolist(), *now, *th])

    t = np.arange(len(u)) * h
    run = solve_ivp(rate, (0.0, t[-1]), x0, "LSODA", t_eval=t, rtol=RTOL, atol=ATOL)
    assert run.success, run.message
    return np.asarray(run.y.T)


def rk4(eq: Equations, theta: Vector, x0: Vector, u: Vector, h: float) -> Vector:
    """States at the samples by a fixed-step RK4 loop; (N, n_x) or (N, n_x, lanes).

    theta (n_p,) runs on Python floats; theta (n_p, lanes) runs all lanes at once on NumPy arrays.
    """
    scalar = theta.ndim == 1
    f, th = slope(eq, scalar), theta.tolist() if scalar else list(theta)
    x = x0.tolist() if scalar else [np.full(theta.shape[1], a) for a in x0]
    kept, rows = [x], u.tolist()
    for here, there in pairwise(rows):
        total, k = x, None
        for ahead, weight in STAGES:
            moved = x if k is None else [a + ahead * h * b for a, b in zip(x, k, strict=True)]
            now = [a + ahead * (b - a) for a, b in zip(here, there, strict=True)]
            k = f([*moved, *now, *th])
            total = [a + weight * h * b for a, b in zip(total, k, strict=True)]
        x = total
        kept.append(x)
    return np.array(kept)


def perturbed(eq: Equations, theta: Vector) -> tuple[Vector, Vector]:
    """The parameters, and beside them those with one moved, and the moves; (n_p, 1 + n), (n,)."""
    at = [eq.parameters.index(n) for n in eq.free]
    moves = STEP * theta[at]
    lanes = np.repeat(theta[:, None], len(at) + 1, axis=1)
    lanes[at, np.arange(1, len(at) + 1)] += moves
    return lanes, moves
