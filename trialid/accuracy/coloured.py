"""Errors of parameters whose residual has a colour: more rows than independent values."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.accuracy.felt import Draw, Felt, felt_by, freedom_of_sum
from trialid.arrays import Mask, Vector
from trialid.least_squares.fold import triangle
from trialid.trial_rows import Stretch

DRAWS: Final = 64
"""Records drawn to see how much of slow noise the parameters take up. Eight times as many change a
standard error by 2 %."""

LOOKED: Final = 10
"""Lags looked at beyond twice the last that was found."""

CHANCE: Final = 2.8
"""Standard errors by which one of that many lags of white noise leaves zero once in twenty times.
With the 2 of a single lag it does four times in ten, and standard errors of four boats' gains and
damping came out 3 % too small and scattered by 9 % instead of 3 %."""

_ROWS: Final = 500_000
"""Rows drawn in all: with many rows a few records tell what is then next to nothing."""


@dataclass(frozen=True, eq=False)
class Coloured:
    """Covariance of the relative parameters, and how well that itself is known.

    Attributes
    ----------
    covariance
        (n_theta, n_theta).
    freedom
        Degrees of freedom of each variance, after Satterthwaite; (n_theta,).
    """

    covariance: Vector
    freedom: Vector


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
    felt: Draw | None = None,
) -> Coloured:
    """Covariance of the relative parameters for the residual's own colour.

    A sandwich: (A^T A)^-1 A^T C A (A^T A)^-1, where C holds the autocovariance of each output in
    each trial up to a lag of three correlation times (Bartlett weights), no correlation between.
    Morelli & Klein (1997), `Accuracy of aerodynamic model parameters estimated from flight test
    data`, in the time domain. Noise as slow as the manoeuvre is partly taken up by the parameters,
    and the residual shows too little of it: by how much, noise of this colour tells that is drawn,
    fitted and assessed in the same way (Imbens & Kolesar 2016, Robust standard errors in small
    samples, REStat 98, for what is white).

    Parameters
    ----------
    held
        What priors weigh: the level over the prior's relative standard deviation, zero for a
        parameter without; (n_theta,).
    level
        By what the fit weighed priors; the root of the row variance where none is given.
    felt
        Draws rows that noise of recorded inputs moves the simulation by. What of it the residual
        has room for is no other noise.
    """
    narrow = np.linalg.pinv(with_priors(A, held))
    inverse = np.asarray(narrow @ (A @ narrow).T, dtype=np.float64)
    draws = draws_for(len(A))
    by_inputs = felt and felt_by(A, inverse, residual, stretches, felt, draws)
    parts = [_Part.of(inverse, residual, s, by_inputs) for s in stretches]
    drawn = _drawn(A, inverse, parts, draws)
    meat = sum((p.variance() for p in parts), np.zeros((A.shape[1], A.shape[1])))
    shown = drawn.mean(axis=0) / np.where(np.diag(meat) > 0.0, np.diag(meat), 1.0)
    grown = 1.0 / np.sqrt(np.where(shown > 0.0, shown, 1.0))
    covariance = meat * np.outer(grown, grown)
    freedom = 2.0 * drawn.mean(axis=0) ** 2 / np.maximum(drawn.var(axis=0, ddof=1), 1e-300)
    if by_inputs is not None:
        own, more = np.diag(covariance), np.diag(by_inputs.covariance)
        freedom = freedom_of_sum((own, freedom), (more, by_inputs.draws))
        covariance = covariance + by_inputs.covariance
    if held is not None:
        pulled = (narrow @ narrow.T) * held
        variance = row_variance(A, residual) if level is None else level**2
        covariance = covariance + variance * pulled @ pulled.T
    return Coloured(covariance, freedom)


@dataclass(frozen=True, eq=False)
class _Part:
    """What one output of one trial has to do with the parameters, on the trial's clock.

    `a` is what each parameter moves by per sample (N, n_theta), `c` the noise's autocovariance with
    its weights (lags,).
    """

    stretch: Stretch
    a: Vector
    c: Vector

    @classmethod
    def of(
        cls, inverse: Vector, residual: Vector, stretch: Stretch, by_inputs: Felt | None
    ) -> "_Part":
        e = stretch.on_clock(residual[stretch.rows])
        a = stretch.on_clock(inverse[:, stretch.rows].T)
        c = autocovariance(e, stretch.compared)
        if by_inputs is not None:
            left = stretch.on_clock(by_inputs.left[:, stretch.rows].T).T
            c = _without(c, _weighted(left, stretch.compared, len(c)).mean(axis=0))
        return cls(stretch, a, c)

    def variance(self) -> Vector:
        """What this noise does to the parameters; (n_theta, n_theta)."""
        return np.asarray(self.a.T @ toeplitz_times(self.a, self.c))

    def noise(self, draws: int, rng: np.random.Generator) -> Vector:
        """Records of noise of this colour, compared rows; (draws, rows)."""
        n = len(self.a)
        size = 1 << (n + 2 * len(self.c)).bit_length()
        power = _circulant(self.c, size)
        white = np.fft.rfft(rng.standard_normal((draws, size)), axis=1)
        drawn = np.fft.irfft(white * np.sqrt(power), size, axis=1)
        return np.asarray(drawn[:, :n][:, self.stretch.compared])

    def assessed(self, left: Vector) -> Vector:
        """The variances that residuals (draws, rows) would give, at the same lags; (draws, n)."""
        lags = len(self.c)
        size = 1 << (2 * len(self.a) - 1).bit_length()
        full = np.zeros((len(left), len(self.a)))
        full[:, self.stretch.compared] = left
        own = np.fft.irfft(np.abs(np.fft.rfft(self.a, size, axis=0)) ** 2, size, axis=0)
        twice = np.where(np.arange(lags) > 0, 2.0, 1.0)
        return _weighted(full, self.stretch.compared, lags) @ (own[:lags] * twice[:, None])


def draws_for(rows: int) -> int:
    """How many records of so many rows are drawn."""
    return int(np.clip(_ROWS // max(rows, 1), 8, DRAWS))


def _drawn(A: Vector, inverse: Vector, parts: Sequence[_Part], draws: int) -> Vector:
    """Variances assessed from fits to drawn noise; (draws, n_theta)."""
    rng = np.random.default_rng(0)
    noise = np.zeros((draws, len(A)))
    for part in parts:
        noise[:, part.stretch.rows] = part.noise(draws, rng)
    left = noise - (noise @ inverse.T) @ A.T
    return np.asarray(sum(part.assessed(left[:, part.stretch.rows]) for part in parts))


def autocovariance(e: Vector, compared: Mask) -> Vector:
    """Bartlett-weighted autocovariance up to three correlation times; (lags,).

    Pairs are counted where both values were compared, so that gaps do not bias it.
    """
    n = len(e)
    size = 1 << (2 * n - 1).bit_length()
    spectrum = np.fft.rfft(e, size)
    products = np.fft.irfft(spectrum * spectrum.conj(), size)[:n]
    c = products / np.maximum(_pairs(compared), 1.0)
    lags = window(c, n)
    weights: Vector = c[:lags] * (1.0 - np.arange(lags) / lags)
    return weights


def _weighted(e: Vector, compared: Mask, lags: int) -> Vector:
    """Bartlett-weighted autocovariances of many records (n, N) up to a lag; (n, lags)."""
    size = 1 << (2 * e.shape[1] - 1).bit_length()
    products = np.fft.irfft(np.abs(np.fft.rfft(e, size, axis=1)) ** 2, size, axis=1)
    weights = (1.0 - np.arange(lags) / lags) / np.maximum(_pairs(compared), 1.0)[:lags]
    return np.asarray(products[:, :lags] * weights)


def _without(c: Vector, known: Vector) -> Vector:
    """An autocovariance less another, no frequency below zero; (lags,)."""
    size = 1 << (2 * len(c)).bit_length()
    power = np.maximum(_circulant(c, size) - _circulant(known, size), 0.0)
    return np.asarray(np.fft.irfft(power, size)[: len(c)])


def _pairs(compared: Mask) -> Vector:
    """How many pairs of compared values lie at each lag; (N,)."""
    n = len(compared)
    size = 1 << (2 * n - 1).bit_length()
    presence = np.fft.rfft(compared.astype(float), size)
    return np.asarray(np.round(np.fft.irfft(presence * presence.conj(), size)[:n]))


def window(c: Vector, n: int) -> int:
    """Lags to keep: three times the longest correlation time, at most a quarter of the record.

    The correlation time is the last lag at which the autocorrelation leaves the band of `CHANCE`
    times its own standard error, counted until it has stayed inside for as long again.
    """
    longest = max(n // 4, 1)
    if c[0] <= 0.0:
        return 1
    rho = np.abs(c[:longest] / c[0])
    band = CHANCE / np.sqrt(n)
    last = 0
    for lag in range(1, longest):
        if rho[lag] > max(band, 0.05):
            last = lag
        elif lag > 2 * last + LOOKED:
            break
    return min(3 * last + 1, longest)


def toeplitz_times(a: Vector, c: Vector) -> Vector:
    """The symmetric Toeplitz matrix of autocovariance c times a; (N, n_theta)."""
    n = len(a)
    size = 1 << (n + 2 * len(c)).bit_length()
    spectrum = _circulant(c, size)[:, None]
    return np.fft.irfft(np.fft.rfft(a, size, axis=0) * spectrum, size, axis=0)[:n]


def _circulant(c: Vector, size: int) -> Vector:
    """Spectrum of an autocovariance on a circle of this many samples, nowhere below zero."""
    kernel = np.zeros(size)
    kernel[: len(c)] = c
    kernel[size - len(c) + 1 :] += c[1:][::-1]
    return np.maximum(np.fft.rfft(kernel).real, 0.0)
