"""A smooth curve through samples that never passes beyond them, its slopes by [FB84].

PCHIP, monotone piecewise cubic interpolation: bit for bit what SciPy's PchipInterpolator gives,
which takes 0.3 s to import, as long as looking through 30 MB of a log.
Source: [FB84] F. N. Fritsch, J. Butland, A method for constructing local monotone piecewise cubic
interpolants, SIAM J. Sci. Stat. Comput. 5 (1984); ends as in C. Moler, Numerical Computing with
MATLAB, 3.6.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


def curve(t: Vector, y: Vector) -> Callable[[Vector], Vector]:
    """The curve through two or more finite samples at strictly increasing times; (N,) each.

    >>> float(curve(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 4.0]))(np.array([0.5]))[0])
    0.3125

    Raises ValueError where times do not increase or numbers are too large for a slope.
    """
    step = np.diff(t)
    if not (np.isfinite(t).all() and np.isfinite(y).all() and (step > 0).all()):
        raise ValueError("a curve needs finite samples at strictly increasing times")
    secant = np.diff(y) / step
    slope = _slopes(step, secant)
    if not np.isfinite(slope).all():
        raise ValueError("samples are too far apart for a curve through them")
    bend = (slope[:-1] + slope[1:] - 2 * secant) / step
    square, cube = (secant - slope[:-1]) / step - bend, bend / step

    @np.errstate(over="ignore", invalid="ignore")  # between numbers past all there are none
    def at(times: Vector) -> Vector:
        piece = np.clip(np.searchsorted(t, times, "right") - 1, 0, len(step) - 1)
        s = times - t[piece]
        s_2 = s * s
        value = y[piece] + slope[piece] * s + square[piece] * s_2 + cube[piece] * (s_2 * s)
        return np.asarray(value, np.float64)

    return at


def _slopes(step: Vector, secant: Vector) -> Vector:
    """Slopes at the samples: the harmonic mean of both sides', 0 at a peak; (N,)."""
    if len(step) == 1:
        return np.repeat(secant, 2)
    before, after = secant[:-1], secant[1:]
    peak = (np.sign(after) != np.sign(before)) | (after == 0) | (before == 0)
    first, second = 2 * step[1:] + step[:-1], step[1:] + 2 * step[:-1]
    with np.errstate(divide="ignore", invalid="ignore"):  # at peaks, which are left out
        mean = (first / before + second / after) / (first + second)
    slope = np.zeros(len(step) + 1)
    slope[1:-1][~peak] = 1.0 / mean[~peak]
    slope[0] = _at_end(step[0], step[1], secant[0], secant[1])
    slope[-1] = _at_end(step[-1], step[-2], secant[-1], secant[-2])
    return slope


def _at_end(step: float, next_step: float, secant: float, next_secant: float) -> float:
    """Slope at an end, of three points on one side, that keeps the shape."""
    slope = ((2 * step + next_step) * secant - step * next_secant) / (step + next_step)
    if np.sign(slope) != np.sign(secant):
        return 0.0
    if np.sign(secant) != np.sign(next_secant) and abs(slope) > 3.0 * abs(secant):
        return 3.0 * secant
    return slope
