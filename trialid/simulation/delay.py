"""A signal read later than it was sampled, or through a slow sensor, with exact derivatives."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Whole = NDArray[np.int_]
SLOPE: Final = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0
"""Fourth-order central difference: the slope per sample at the middle of five samples."""

BLOCK: Final = 64
"""Samples of a recursion that one product of matrices steps through."""

TOGETHER: Final = 1 << 14
"""Numbers that are delayed at a time, 128 kB: of 7500 samples by 40 columns they take 0.9 ms, with
half as many 1.0, with twice 0.8; of 12 columns 0.30, 0.33 and 0.48."""

REACH: Final = 3
"""Samples on either side that an interpolated value looks at."""


def taps(w: float | Vector) -> tuple[Vector, Vector]:
    """Weights of six neighbours for the value at fraction w after the third, and d/dw; (6, ...).

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


def _hermite(
    left: float | Vector,
    right: float | Vector,
    slope_left: float | Vector,
    slope_right: float | Vector,
) -> Vector:
    weights = np.zeros((6, *np.shape(left)))
    weights[2] += left
    weights[3] += right
    weights[0:5] += np.multiply.outer(SLOPE, slope_left)
    weights[1:6] += np.multiply.outer(SLOPE, slope_right)
    return weights


def delay_samples(y: Vector, lag: float | Vector) -> tuple[Vector, Vector]:
    """The samples y(k - lag) and their derivative by the lag [1/sample]; like y, (N, ...).

    The lag is one number, or one for each sample where a clock drifts; (N,). Beyond the ends the
    outermost sample stands; `margin` says how many samples that spoils.
    """
    whole = np.ceil(lag).astype(int)
    value, slope = taps(whole - lag)
    return _weighed(y, whole, value), _weighed(y, whole, -slope)


def shift(y: Vector, lag: float | Vector) -> Vector:
    """The first of `delay_samples` alone: what a delay makes of sensitivities; like y, (N, ...)."""
    whole = np.ceil(lag).astype(int)
    return _weighed(y, whole, taps(whole - lag)[0])


def _weighed(y: Vector, whole: Whole, weights: Vector) -> Vector:
    """Six neighbours of each sample, moved by whole samples, times their weights."""
    n = len(y)
    if weights.ndim == 1:  # one delay for all: neighbours are slices of one longer record
        return _all_alike(y, _neighbours(int(whole), slice(0, n), n), weights)
    beside = (slice(None), *(None,) * (y.ndim - 1))  # weights of a sample, over all its columns
    first, total = np.arange(n) - whole - 2, np.zeros_like(y, dtype=float)
    for i in range(6):
        total += weights[i][beside] * y[np.clip(first + i, 0, n - 1)]
    return total


def shift_part(y: Vector, begin: int, lag: float, wanted: slice, samples: int) -> Vector:
    """As `shift` of a record of so many samples, of which `y` are some: the wanted ones.

    `y` begins at sample `begin` and holds those that `reach` says.
    """
    whole = int(np.ceil(lag))
    return _all_alike(y, _neighbours(whole, wanted, samples) - begin, taps(whole - lag)[0])


def reach(lag: float) -> tuple[int, int]:
    """How many samples before and behind itself a delayed sample is made of; below 0: none."""
    whole = int(np.ceil(lag))
    return whole + REACH - 1, REACH - whole


def _neighbours(whole: int, wanted: slice, samples: int) -> Whole:
    """Places of the first of the six of each wanted sample, and five more; ends stand for more."""
    return np.clip(np.arange(wanted.start - whole - 2, wanted.stop - whole + 3), 0, samples - 1)


def _all_alike(y: Vector, places: Whole, weights: Vector) -> Vector:
    """Six slices of one longer record, by rows that the cache holds until they are summed."""
    n = len(places) - 5
    total = np.empty((n, *y.shape[1:]))
    most = max(TOGETHER // (total[:1].size or 1), 1)
    beside = np.empty_like(total[:most])
    for at in range(0, n, most):
        rows = min(most, n - at)
        near = y[places[at : at + rows + 5]]
        part = np.multiply(near[:rows], weights[0], out=total[at : at + rows])
        for i in range(1, 6):
            part += np.multiply(near[i : i + rows], weights[i], out=beside[:rows])
    return total


def lag_samples(y: Vector, tau: float, period: float) -> tuple[Vector, Vector]:
    """What a first-order low-pass makes of samples, and its derivative by tau; like y, (N, ...).

    tau dz/dt = y - z, exact for a signal that is straight between samples, at rest when it starts.
    At tau = 0 it is the signal itself, and the derivative the backward difference.

    >>> z, slope = lag_samples(np.array([0.0, 1.0, 1.0]), 0.0, 1.0)
    >>> z, slope
    (array([0., 1., 1.]), array([ 0., -1.,  0.]))
    """
    y_before = np.concatenate([y[:1], y[:-1]])
    if tau == 0.0:
        return y, (y_before - y) / period
    ratio = tau / period
    a = np.exp(-1.0 / ratio)
    a_slope = a / ratio**2 / period
    kept = ratio * (1.0 - a)
    kept_slope = (1.0 - a) / period - ratio * a_slope
    z = y[:1] + _recursive((1.0 - kept) * (y - y[:1]) + (kept - a) * (y_before - y[:1]), a)
    z_before = np.concatenate([z[:1], z[:-1]])
    drive = a_slope * (z_before - y_before) + kept_slope * (y_before - y)
    return z, _recursive(drive, a)


@np.errstate(over="ignore", invalid="ignore")  # of a motion that has no end nothing is known
def _recursive(x: Vector, a: float) -> Vector:
    """z(k) = a z(k-1) + x(k) from rest, block by block; like x, (N, ...).

    The last block is filled up, so that a longer record has the same beginning bit for bit.
    """
    columns = x.reshape(len(x), -1)
    ahead = np.subtract.outer(np.arange(BLOCK), np.arange(BLOCK))
    band = np.where(ahead >= 0, a ** np.maximum(ahead, 0), 0.0)
    fading = (a ** np.arange(1, BLOCK + 1))[:, None]
    z = np.empty_like(columns)
    carried = np.zeros((1, columns.shape[1]))
    for k in range(0, len(x), BLOCK):
        rows = min(BLOCK, len(x) - k)
        part = np.zeros((BLOCK, columns.shape[1]))
        part[:rows] = columns[k : k + rows]
        z[k : k + rows] = (band @ part + fading * carried)[:rows]
        carried = z[k + rows - 1 : k + rows]
    return z.reshape(x.shape)


def margin(low: float, high: float, period: float) -> int:
    """Samples at each end that a delay between low and high [s] may spoil."""
    return int(np.ceil(max(abs(low), abs(high)) / period)) + REACH
