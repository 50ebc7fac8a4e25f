"""Errors of parameters whose residual has a colour: more rows than independent values."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask, Vector
from trialid.linear_algebra import triangle
from trialid.trial_rows import Stretch


def row_variance(A: Vector, residual: Vector) -> float:
    """Variance of one row of the residual, for as many parameters fitted as A has columns."""
    rows, columns = A.shape
    return float(residual @ residual) / max(rows - columns, 1)


def white_covariance(A: Vector, residual: Vector, held: Vector | None = None) -> Vector:
    """Covariance of the relative parameters if the residual were white; (n_theta, n_theta).

    `held` as in `coloured_covariance`.
    """
    inverse = np.linalg.pinv(with_priors(A, held))
    return np.asarray(row_variance(A, residual) * inverse @ inverse.T)


def with_priors(A: Vector, held: Vector | None) -> Vector:
    """R with R^T R = A^T A + diag(held)^2: each prior is one more row; (n_theta, n_theta)."""
    R = triangle(A)
    return R if held is None else triangle(np.concatenate([R, np.diag(held)]))


def coloured_covariance(
    A: Vector,
    residual: Vector,
    stretches: Sequence[Stretch],
    held: Vector | None = None,
    level: float | None = None,
) -> Vector:
    """Covariance of the relative parameters for the residual's own colour; (n_theta, n_theta).

    A sandwich: (A^T A)^-1 A^T C A (A^T A)^-1, where C holds the autocovariance of each output in
    each trial up to a lag of three correlation times (Bartlett weights), no correlation between.
    Morelli & Klein (1997), `Accuracy of aerodynamic model parameters estimated from flight test
    data`, in the time domain.

    Parameters
    ----------
    held
        What priors weigh: the level over the prior's relative standard deviation, zero for a
        parameter without; (n_theta,).
    level
        By what the fit weighed priors; the root of the row variance where none is given.
    """
    rows, columns = A.shape
    narrow = np.linalg.pinv(with_priors(A, held))
    inverse = narrow @ (A @ narrow).T
    meat = np.zeros((columns, columns))
    for stretch in stretches:
        e = _on_clock(residual[stretch.rows], stretch.compared)
        a = _on_clock(inverse[:, stretch.rows].T, stretch.compared)
        meat += a.T @ toeplitz_times(a, autocovariance(e, stretch.compared))
    meat *= rows / max(rows - columns, 1)
    if held is None:
        return meat
    pulled = (narrow @ narrow.T) * held
    variance = row_variance(A, residual) if level is None else level**2
    return np.asarray(meat + variance * pulled @ pulled.T)


def _on_clock(values: NDArray[np.floating[Any]], compared: Mask) -> Vector:
    """Rows back on the trial's clock, zero where nothing was compared."""
    full = np.zeros((len(compared), *values.shape[1:]))
    full[compared] = values
    return full


def autocovariance(e: Vector, compared: Mask) -> Vector:
    """Bartlett-weighted autocovariance up to three correlation times; (lags,).

    Pairs are counted where both values were compared, so that gaps do not bias it.
    """
    n = len(e)
    size = 1 << (2 * n - 1).bit_length()
    spectrum = np.fft.rfft(e, size)
    presence = np.fft.rfft(compared.astype(float), size)
    products = np.fft.irfft(spectrum * spectrum.conj(), size)[:n]
    pairs = np.round(np.fft.irfft(presence * presence.conj(), size)[:n])
    c = products / np.maximum(pairs, 1.0)
    lags = window(c, n)
    weights: Vector = c[:lags] * (1.0 - np.arange(lags) / lags)
    return weights


def window(c: Vector, n: int) -> int:
    """Lags to keep: three times the longest correlation time, at most a quarter of the record.

    The correlation time is the last lag at which the autocorrelation leaves the band of twice
    its own standard error, counted until it has stayed inside for as long again.
    """
    longest = max(n // 4, 1)
    if c[0] <= 0.0:
        return 1
    rho = np.abs(c[:longest] / c[0])
    band = 2.0 / np.sqrt(n)
    last = 0
    for lag in range(1, longest):
        if rho[lag] > max(band, 0.05):
            last = lag
        elif lag > 2 * last + 10:
            break
    return min(3 * last + 1, longest)


def toeplitz_times(a: Vector, c: Vector) -> Vector:
    """The symmetric Toeplitz matrix of autocovariance c times a; (N, n_theta)."""
    n = len(a)
    size = 1 << (n + 2 * len(c)).bit_length()
    kernel = np.zeros(size)
    kernel[: len(c)] = c
    kernel[size - len(c) + 1 :] += c[1:][::-1]
    spectrum = np.fft.rfft(kernel).real[:, None]
    return np.fft.irfft(np.fft.rfft(a, size, axis=0) * spectrum, size, axis=0)[:n]
