"""A signal read later or earlier than it was sampled, smoothly and with its exact derivative."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
SLOPE: Final = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0
"""Fourth-order central difference: the slope per sample at the middle of five samples."""

REACH: Final = 3
"""Samples on either side that an interpolated value looks at."""


def taps(w: float) -> tuple[Vector, Vector]:
    """Weights of six neighbours for the value at fraction w after the third, and d/dw; (6,), (6,).

    Cubic Hermite between the third and fourth sample with slopes by central differences: it
    passes through the samples, its slope is continuous, and cubics are exact.

    >>> value, slope = taps(0.5)
    >>> ramp = np.arange(6.0)
    >>> round(float(value @ ramp), 12), round(float(slope @ ramp), 12)
    (2.5, 1.0)
    """
    value = _hermite(1 - 3 * w**2 + 2 * w**3, 3 * w**2 - 2 * w**3, w - 2 * w**2 + w**3, w**3 - w**2)
    slope = _hermite(-6 * w + 6 * w**2, 6 * w - 6 * w**2, 1 - 4 * w + 3 * w**2, 3 * w**2 - 2 * w)
    return value, slope


def _hermite(left: float, right: float, slope_left: float, slope_right: float) -> Vector:
    weights = np.zeros(6)
    weights[2] += left
    weights[3] += right
    weights[0:5] += slope_left * SLOPE
    weights[1:6] += slope_right * SLOPE
    return weights


def delayed(y: Vector, lag: float) -> tuple[Vector, Vector]:
    """The samples y(k - lag) and their derivative by the lag [1/sample]; like y, (N, ...).

    Beyond the ends the outermost sample stands; `margin` says how many samples that spoils.
    """
    whole = int(np.ceil(lag))
    value, slope = taps(whole - lag)
    return _weighed(y, whole, value), _weighed(y, whole, -slope)


def shifted(y: Vector, lag: float) -> Vector:
    """The first of `delayed` alone: what a delay makes of sensitivities; like y, (N, ...)."""
    whole = int(np.ceil(lag))
    return _weighed(y, whole, taps(whole - lag)[0])


def _weighed(y: Vector, whole: int, weights: Vector) -> Vector:
    """Six neighbours of each sample, all moved by whole samples, times their weights."""
    n = len(y)
    near = y[np.clip(np.arange(-whole - 2, n - whole + 3), 0, n - 1)]
    total = weights[0] * near[:n]
    for i in range(1, 6):
        total += weights[i] * near[i : i + n]
    return np.asarray(total)


def margin(low: float, high: float, period: float) -> int:
    """Samples at each end that a delay between low and high [s] may spoil."""
    return int(np.ceil(max(abs(low), abs(high)) / period)) + REACH
