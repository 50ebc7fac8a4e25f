"""Whether a slice of the residual differs from the rest by more than chance.

The residual is coloured: neighbouring samples say the same thing. A mean is therefore judged by
the residual's autocovariance along the slice, and a mean square by the number of independent
values in it, N_b^2 / sum_k rho(k)^2 A_b(k), A_b the autocorrelation of the slice's indicator.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft
from scipy.special import chdtri, fdtr, fdtrc, stdtr  # scipy.stats takes 0.4 s to import

from trialid.arrays import Mask
from trialid.diagnosis.where.leftover import Leftover
from trialid.identification.output_error import stretches

Vector = NDArray[np.float64]

MEMORY_SHARE: Final = 1.0 / 10.0
"""Longest correlation that is counted, over the mean length of the trials."""

VISIBLE: Final = 1e-3
"""A mean that free parameters can mimic but for this share of it is no evidence."""

SEPARATE: Final = 1e-3
"""Combinations of means that vary by less than this share of their own are not judged together."""

FEWEST: Final = 2.0
"""Independent values a slice must hold to be judged."""


@dataclass(frozen=True)
class Colour:
    """How each output's normed residual hangs together in time; (lags, n_y) each.

    `covariance` is Bartlett weighted, so that no sum has a negative variance; `squared` is the
    squared autocorrelation as it is. `independent` counts independent squares; (n_y,). `least` is
    the smallest chance the record's independent blocks can support: all of one sign.
    """

    covariance: Vector
    squared: Vector
    independent: Vector
    least: float


def colour(left: Leftover) -> Colour:
    """The residual's colour, pooled over the trials."""
    lags = max(round(MEMORY_SHARE * len(left.eps) / len(left.spans)), 2)
    total = np.zeros((lags, len(left.outputs)))
    pairs = np.zeros_like(total)
    for span in left.spans:
        total += _lagged(left.eps[span], lags)
        pairs += _lagged(left.compared[span].astype(float), lags)
    weights = 1.0 - np.arange(lags)[:, None] / lags
    c = total / np.maximum(np.round(pairs), 1.0)
    rho2 = (c / np.where(c[0] > 0.0, c[0], 1.0)) ** 2
    count = left.compared.sum(axis=0)
    independent = np.asarray(count / (1.0 + 2.0 * rho2[1:].sum(axis=0)))
    return Colour(weights * c, rho2, independent, float(0.5 ** (len(left.eps) / lags)))


def _lagged(x: Vector, lags: int) -> Vector:
    size = next_fast_len(len(x) + lags, real=True)
    power = np.abs(np.fft.rfft(x, size, axis=0)) ** 2
    found = np.zeros((lags, x.shape[1]))
    reach = min(lags, len(x))
    found[:reach] = np.fft.irfft(power, size, axis=0)[:reach]
    return found


def gram(columns: Vector, kernel: Vector, spans: Sequence[slice]) -> Vector:
    """Sum over trials of S^T C S, C the symmetric Toeplitz matrix of the kernel; (q, q)."""
    total = np.zeros((columns.shape[1],) * 2)
    for span in spans:
        P, weights = _transformed(columns[span], kernel)
        total += ((P.conj().T * weights) @ P).real
    return total


def gram_diagonal(columns: Vector | Mask, kernel: Vector, spans: Sequence[slice]) -> Vector:
    """The diagonal of `gram`; (q,)."""
    rows = np.ascontiguousarray(columns.T)
    return np.array([sum(_chained(row[span], kernel) for span in spans) for row in rows])


def _chained(row: Vector | Mask, kernel: Vector) -> float:
    """One column's own product, by its autocorrelation where it is not zero."""
    at = np.flatnonzero(row)
    if len(at) == 0:
        return 0.0
    piece = row[at[0] : at[-1] + 1].astype(float)
    reach = min(len(kernel), len(piece))
    size = next_fast_len(len(piece) + reach, real=True)
    P = rfft(piece, size)
    lagged = irfft(P.real**2 + P.imag**2, size)[:reach]
    return float(2.0 * kernel[:reach] @ lagged - kernel[0] * lagged[0])


def _transformed(piece: Vector, kernel: Vector) -> tuple[NDArray[np.complex128], Vector]:
    """Transform of columns, and the kernel's by which products of two of them count."""
    size = next_fast_len(len(piece) + len(kernel), real=True)
    row = np.zeros(size)
    reach = min(len(kernel), len(piece))
    row[:reach] = kernel[:reach]
    row[size - reach + 1 :] = kernel[1:reach][::-1]
    spectrum = np.fft.rfft(row).real / size
    spectrum[1:] *= 2.0
    if size % 2 == 0:
        spectrum[-1] *= 0.5
    return rfft(piece.T, size).T, np.asarray(spectrum)  # along rows: twice as fast


@dataclass(frozen=True)
class Means:
    """Weighted sums of the normed residual, their standard errors and p-values; (q,) each.

    `joint` is the p-value of all of them at once.
    """

    value: Vector
    error: Vector
    p: Vector
    joint: float


def means(left: Leftover, colour: Colour, output: int, weights: Vector) -> Means:
    """Weighted sums of one output's residual against chance; weights (N, q).

    What the free parameters can mimic is taken out of the weights before they are judged: the fit
    has made that part of the sum zero.
    """
    weights = np.where(left.compared[:, output, None], weights, 0.0)
    value = weights.T @ left.eps[:, output]
    rows, visible = left.visible(weights, output)
    clock = np.zeros((len(left.eps), len(left.outputs), weights.shape[1]))
    for part in stretches(left.fit.problem):
        scaled = rows[part.rows] * left.scale[part.output]
        clock[left.spans[part.trial], part.output][part.compared] = scaled
    V = np.zeros((len(value),) * 2)
    score = np.zeros(len(value))
    for c in range(len(left.outputs)):
        V += gram(clock[:, c], colour.covariance[:, c], left.spans)
        score += clock[:, c].T @ left.eps[:, c]
    error = np.sqrt(np.maximum(np.diag(V), 1e-300))
    free = max(float(colour.independent[output]) - 1.0, 1.0)
    seen = visible > VISIBLE
    p = np.where(seen, 2.0 * stdtr(free, -np.abs(score) / error), 1.0)
    return Means(value, error, p, _joint(score[seen], V[np.ix_(seen, seen)], free))


def _joint(score: Vector, V: Vector, free: float) -> float:
    """p-value of Wald's statistic by the F distribution."""
    if len(score) == 0:
        return 1.0
    size = np.sqrt(np.diag(V))
    s, U = np.linalg.eigh(V / np.outer(size, size))
    held = s > SEPARATE
    parts = (U[:, held].T @ (score / size)) ** 2 / s[held]
    q = int(held.sum())
    return float(fdtrc(q, max(free - q, 1.0), parts.sum() / q))


def trend(left: Leftover, colour: Colour, output: int, size: Vector) -> float:
    """p-value of the squared residual going with a size (N,), upward or downward."""
    compared = left.compared[:, output]
    away = np.where(compared, size - size[compared].mean(), 0.0)
    power = float((left.eps[:, output] ** 2).sum() / max(int(compared.sum()), 1))
    variance = 2.0 * gram_diagonal(away[:, None], colour.squared[:, output], left.spans)[0]
    z = float(away @ left.eps[:, output] ** 2) / max(power * np.sqrt(variance), 1e-300)
    return float(2.0 * stdtr(max(float(colour.independent[output]) - 1.0, 1.0), -abs(z)))


@dataclass(frozen=True)
class Squares:
    """Mean squares of slices against the rest; (q,) each.

    `ratio` is over the mean square of all samples, `low` and `high` its 95 % interval.
    """

    samples: Vector
    share: Vector
    ratio: Vector
    low: Vector
    high: Vector
    p: Vector


def squares(left: Leftover, colour: Colour, output: int, slices: Mask) -> Squares:
    """Mean square of one output's residual in slices against that outside them; slices (N, q)."""
    return squares_of_each(left, colour, output, slices.T)


def squares_of_each(left: Leftover, colour: Colour, output: int, slices: Iterable[Mask]) -> Squares:
    """The same of slices one after another, (N,) each: there may be thousands of a long record."""
    compared = left.compared[:, output]
    e2 = left.eps[:, output] ** 2
    total, every = float(e2.sum()), float(compared.sum())
    sums = []
    for one in slices:
        inside = one & compared
        chain = gram_diagonal(inside[:, None], colour.squared[:, output], left.spans)[0]
        sums.append((float(inside.sum()), float(e2[inside].sum()), float(chain)))
    count, held, chain = np.array(sums).reshape(-1, 3).T
    own = count**2 / np.maximum(chain, 1e-300)
    rest = np.maximum(float(colour.independent[output]) - own, 1.0)
    here = held / np.maximum(count, 1.0)
    there = (total - held) / np.maximum(every - count, 1.0)
    quotient = here / np.maximum(there, 1e-300)
    p = 2.0 * np.minimum(fdtrc(own, rest, quotient), fdtr(own, rest, quotient))
    judged = (own >= FEWEST) & (count < every)
    ratio = here / max(total / every, 1e-300)
    own = np.maximum(own, 1.0)
    return Squares(
        count / every, held / max(total, 1e-300), ratio,
        ratio * own / chdtri(own, 0.025), ratio * own / chdtri(own, 0.975),
        np.where(judged, np.minimum(p, 1.0), 1.0),
    )  # fmt: skip


def holm(p: Sequence[float]) -> list[float]:
    """Holm's correction: the chance that any of the questions is answered wrongly.

    >>> [round(x, 6) for x in holm([0.01, 0.04, 0.03])]
    [0.03, 0.06, 0.06]
    """
    order = sorted(range(len(p)), key=lambda i: p[i])
    corrected, largest = [1.0] * len(p), 0.0
    for place, i in enumerate(order):
        largest = max(largest, min(1.0, p[i] * (len(p) - place)))
        corrected[i] = largest
    return corrected
