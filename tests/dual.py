"""Forward-mode automatic differentiation in a page: the oracle for the graph's reverse mode.

Nothing here is shared with `trialid.simulation`; only the physics (`trialid.ship.model`, effects)
is the same, and it does not know which of the two runs through it.
"""

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.ship.model import ShipModel, derivatives, motion
from trialid.trial import Trial

Vector = NDArray[np.float64]
RK4 = ((0.0, 1 / 6), (0.5, 1 / 3), (0.5, 1 / 3), (1.0, 1 / 6))


class Dual:
    """A number and its derivatives by every independent variable."""

    __slots__ = ("d", "x")
    __array_ufunc__ = None

    def __init__(self, x: float, d: Any) -> None:
        self.x = x
        self.d = d

    def __add__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            return Dual(self.x + other.x, self.d + other.d)
        return Dual(self.x + other, self.d)

    __radd__ = __add__

    def __neg__(self) -> "Dual":
        return Dual(-self.x, -self.d)

    def __sub__(self, other: Any) -> "Dual":
        return self + (-other)

    def __rsub__(self, other: Any) -> "Dual":
        return -self + other

    def __mul__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            return Dual(self.x * other.x, self.x * other.d + other.x * self.d)
        return Dual(self.x * other, self.d * other)

    __rmul__ = __mul__

    def _inverse(self) -> "Dual":
        return Dual(1.0 / self.x, -self.d / (self.x * self.x))

    def __truediv__(self, other: Any) -> "Dual":
        return self * (other._inverse() if isinstance(other, Dual) else 1.0 / other)

    def __rtruediv__(self, other: Any) -> "Dual":
        return self._inverse() * other

    def __pow__(self, power: int) -> "Dual":
        return Dual(self.x**power, power * self.x ** (power - 1) * self.d)

    def __abs__(self) -> "Dual":
        return self if self.x >= 0.0 else -self

    def sin(self) -> "Dual":
        return Dual(math.sin(self.x), math.cos(self.x) * self.d)

    def cos(self) -> "Dual":
        return Dual(math.cos(self.x), -math.sin(self.x) * self.d)

    def sqrt(self) -> "Dual":
        root = math.sqrt(self.x)
        return Dual(root, self.d / (2.0 * root))

    def exp(self) -> "Dual":
        return Dual(math.exp(self.x), math.exp(self.x) * self.d)

    def tanh(self) -> "Dual":
        return Dual(math.tanh(self.x), self.d / math.cosh(self.x) ** 2)

    def arctan(self) -> "Dual":
        return Dual(math.atan(self.x), self.d / (1.0 + self.x * self.x))

    def clip_to(self, limit: Any) -> "Dual":
        if self.x > _value(limit):
            return 0.0 * self + limit
        return 0.0 * self - limit if self.x < -_value(limit) else self


def _value(number: Any) -> float:
    return number.x if isinstance(number, Dual) else float(number)


def independent(values: Mapping[str, float]) -> dict[str, Dual]:
    """Each value as an independent variable, in the order of the mapping."""
    unit = np.eye(len(values))
    return {name: Dual(float(x), unit[i]) for i, (name, x) in enumerate(values.items())}


def slope(number: Any, size: int) -> Vector:
    """Derivatives of a result; zeros when it does not depend on anything."""
    return number.d if isinstance(number, Dual) else np.zeros(size)


def simulate(
    model: ShipModel,
    trial: Trial,
    theta: Mapping[str, float],
    start: Mapping[str, float],
    outputs: Iterable[str],
    substeps: int,
) -> tuple[tuple[str, ...], Vector, Vector]:
    """RK4 of the model on dual numbers: columns, outputs (N, n_y) and their slopes (N, n_y, n).

    The columns are the parameters in `theta`, then the initial states as `v(0)`.
    """
    named = independent({**theta, **{f"{s}(0)": start[s] for s in model.all_states}})
    parameters = {n: named[n] for n in theta}
    x = {s: named[f"{s}(0)"] for s in model.all_states}
    inputs = {s: trial.signals[s] for s in model.recorded}
    step = trial.period / substeps
    seen = [x]
    for k in range(trial.samples - 1):
        for j in range(substeps):
            x = _advance(model, x, inputs, k, (j, substeps, step), parameters)
        seen.append(x)
    recorded = [_recorded(model, seen, inputs, parameters, c, trial.period) for c in outputs]
    y = np.array([[number.x for number in column] for column in recorded]).T
    dy = np.array([[slope(n, len(named)) for n in column] for column in recorded])
    return tuple(named), y, np.moveaxis(dy, 0, 1)


def _advance(
    model: ShipModel,
    x: Mapping[str, Any],
    inputs: Mapping[str, Vector],
    k: int,
    clock: tuple[int, int, float],
    theta: Mapping[str, Dual],
) -> dict[str, Any]:
    j, substeps, step = clock
    total: dict[str, Any] = dict.fromkeys(x, 0.0)
    rate: dict[str, Any] = dict.fromkeys(x, 0.0)
    for ahead, weight in RK4:
        along = (j + ahead) / substeps
        now = {s: float(u[k] * (1.0 - along) + u[k + 1] * along) for s, u in inputs.items()}
        rate = derivatives(model, {s: x[s] + ahead * step * rate[s] for s in x}, now, theta)
        total = {s: total[s] + weight * step * rate[s] for s in x}
    return {s: x[s] + total[s] for s in x}


def _recorded(
    model: ShipModel,
    seen: list[dict[str, Any]],
    inputs: Mapping[str, Vector],
    theta: Mapping[str, Dual],
    output: str,
    period: float,
) -> list[Any]:
    instants = [
        motion(model, x, {s: float(u[k]) for s, u in inputs.items()}, theta)
        for k, x in enumerate(seen)
    ]
    exact = [now.measured[output] for now in instants]
    delay = instants[0].delay.get(output)
    return exact if delay is None else _late(exact, delay / period)


def _late(y: list[Any], lag: Any) -> list[Any]:
    """Textbook cubic Hermite through the samples, slopes by the five-point difference."""
    last = len(y) - 1

    def at(k: int) -> Any:
        return y[min(max(k, 0), last)]

    def rate(k: int) -> Any:
        return (at(k - 2) - 8.0 * at(k - 1) + 8.0 * at(k + 1) - at(k + 2)) / 12.0

    whole = math.ceil(_value(lag))
    w = whole - lag
    late = []
    for k in range(len(y)):
        a = k - whole
        ends = at(a) * (1.0 + 2.0 * w) * (1.0 - w) ** 2 + at(a + 1) * (w * w * (3.0 - 2.0 * w))
        late.append(ends + rate(a) * (w * (1.0 - w) ** 2) + rate(a + 1) * (w * w * (w - 1.0)))
    return late
