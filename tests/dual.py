"""Forward-mode automatic differentiation in a page: the oracle for the graph's reverse mode.

Nothing here is shared with `trialid.simulation`; only the physics (`trialid.ship.model`, effects)
is the same, and it does not know which of the two runs through it.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.maths import exp
from trialid.ship.effect import Delayed
from trialid.ship.model import ShipModel, late
from trialid.ship.model import slope as slope_of
from trialid.ship.motion import derivatives
from trialid.ship.readings import readings
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
    inputs = _inputs(model, trial, parameters)
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
    inputs: Mapping[str, Any],
    k: int,
    clock: tuple[int, int, float],
    theta: Mapping[str, Dual],
) -> dict[str, Any]:
    j, substeps, step = clock
    total: dict[str, Any] = dict.fromkeys(x, 0.0)
    rate: dict[str, Any] = dict.fromkeys(x, 0.0)
    for ahead, weight in RK4:
        along = (j + ahead) / substeps
        now = {s: u[k] * (1.0 - along) + u[k + 1] * along for s, u in inputs.items()}
        rate = derivatives(model, {s: x[s] + ahead * step * rate[s] for s in x}, now, theta)
        total = {s: total[s] + weight * step * rate[s] for s in x}
    return {s: x[s] + total[s] for s in x}


def _inputs(model: ShipModel, trial: Trial, theta: Mapping[str, Dual]) -> dict[str, Sequence[Any]]:
    """Recorded signals, a late one shifted as a dual number: nothing is left to correct for."""
    recorded = {**trial.signals, "t": trial.t}
    inputs: dict[str, Sequence[Any]] = {
        s: [float(a) for a in recorded[s]] for s in model.recorded if s in recorded
    }
    for name in model.late_inputs:
        [effect] = [e for e in model.effects if name in e.acts_on(Delayed)]
        [part] = effect(theta)
        inputs[name] = _late(inputs[name], [part[name] / trial.period] * trial.samples)
        inputs[late(name)] = [part[name]] * trial.samples
        inputs[slope_of(name)] = [0.0] * trial.samples
    return inputs


def _recorded(
    model: ShipModel,
    seen: list[dict[str, Any]],
    inputs: Mapping[str, Sequence[Any]],
    theta: Mapping[str, Dual],
    output: str,
    period: float,
) -> list[Any]:
    instants = []
    for k, x in enumerate(seen):
        here = {s: u[k] for s, u in inputs.items()}
        instants.append(readings(model, x, here, theta, derivatives(model, x, here, theta)))
    y = [now.measured[output] for now in instants]
    for tau in instants[0].lags.get(output, ()):
        y = _slow(y, tau / period)
    delays = [now.delay.get(output) for now in instants]
    return y if delays[0] is None else _late(y, [d / period for d in delays])


def _slow(y: list[Any], ratio: Any) -> list[Any]:
    """T dz/dt = y - z over each step with a straight y: the textbook solution."""
    z = [y[0]]
    fading = exp(-1.0 / ratio)
    for before, now in pairwise(y):
        tangent = now - before  # per sample; the particular solution is y - T slope
        z.append(now - ratio * tangent + (z[-1] - before + ratio * tangent) * fading)
    return z


def _late(y: Sequence[Any], lags: Sequence[Any]) -> list[Any]:
    """Textbook cubic Hermite through the samples, slopes by the five-point difference."""
    last = len(y) - 1

    def at(k: int) -> Any:
        return y[min(max(k, 0), last)]

    def rate(k: int) -> Any:
        return (at(k - 2) - 8.0 * at(k - 1) + 8.0 * at(k + 1) - at(k + 2)) / 12.0

    late = []
    for k, lag in enumerate(lags):
        whole = math.ceil(_value(lag))
        w = whole - lag
        a = k - whole
        ends = at(a) * (1.0 + 2.0 * w) * (1.0 - w) ** 2 + at(a + 1) * (w * w * (3.0 - 2.0 * w))
        late.append(ends + rate(a) * (w * (1.0 - w) ** 2) + rate(a + 1) * (w * w * (w - 1.0)))
    return late
