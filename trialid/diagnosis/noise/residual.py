"""What a fit leaves over, on each trial's clock, and how many independent values that is."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from trialid.accuracy.coloured import window
from trialid.arrays import Mask
from trialid.identification.fit import Fit
from trialid.identification.output_error import output_error, output_matrix
from trialid.trial import Trial

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Residual:
    """Normed output error of one trial; (N, n_y), zero where nothing was compared."""

    trial: Trial
    eps: Vector
    compared: Mask
    predicted: Vector

    def between(self, start: int, stop: int | None) -> "Residual":
        """The samples from one to another."""
        here = slice(start, stop)
        return replace(
            self,
            eps=self.eps[here],
            compared=self.compared[here],
            predicted=self.predicted[here],
        )


def residuals(fit: Fit, uses: Sequence[str] = ("fit",)) -> list[Residual]:
    """Normed output errors of a fit, trial by trial, on the trial's clock."""
    found = []
    y_rms = fit.problem.y_rms
    for score in fit.scores:
        if score.trial.use in uses:
            eps = (
                output_error(output_matrix(score.trial, fit.problem.outputs), score.response.y)
                / y_rms
            )
            eps = np.where(score.compared, eps, 0.0)
            found.append(Residual(score.trial, eps, score.compared, score.response.y / y_rms))
    return found


@dataclass(frozen=True)
class OutputNoise:
    """Noise of one output by one route: normed variance and its standard error.

    `unlike` is what of the variance may be the model's: it may err differently in what is compared.
    """

    variance: float
    deviation: float
    unlike: float = 0.0


def pool_variance(
    pieces: Sequence[Vector], masks: Sequence[Mask], slow: float = 1.0, tail: float = 0.0
) -> OutputNoise | None:
    """Variance over pieces, and its standard error.

    `slow` is the least number of samples that count as one; short pieces alone would make slow
    noise look independent. `tail` is the noise's fourth cumulant: rare large values that a short
    piece mostly lacks.
    """
    count = sum(int(m.sum()) for m in masks)
    if count < 10:
        return None
    variance = sum(float(p @ p) for p in pieces) / count
    own = sum(effective_in(p, m) for p, m in zip(pieces, masks, strict=True))
    degrees = max(own - len(pieces), 1.0)
    sure = max(min(own, count / slow) - len(pieces), 1.0)
    deviation = np.hypot(variance * np.sqrt(2.0 / sure), np.sqrt(tail / count))
    return OutputNoise(variance * own / degrees, float(deviation))


def heavy_tail(pieces: Sequence[Vector], masks: Sequence[Mask]) -> float:
    """Fourth cumulant of what changes from sample to sample, over whole trials; >= 0.

    Smooth errors of the model, however peaked, are nearly gone from first differences; values far
    off stand in them twice.
    """
    steps = [np.diff(p)[m[1:] & m[:-1]] for p, m in zip(pieces, masks, strict=True)]
    d = np.concatenate(steps) if steps else np.zeros(0)
    if len(d) == 0:
        return 0.0
    return max(float(np.mean(d**4) - 3.0 * np.mean(d**2) ** 2), 0.0) / 2.0


def slowness(pieces: Sequence[Vector], masks: Sequence[Mask]) -> float:
    """Samples that count as one for a variance about the mean, over whole trials."""
    count = sum(int(m.sum()) for m in masks)
    pairs = zip(pieces, masks, strict=True)
    effective = sum(effective_in(about_mean(p, m), m) for p, m in pairs)
    return count / max(effective, 1.0)


def about_mean(eps: Vector, mask: Mask) -> Vector:
    """Residual less its mean over what was compared, zero elsewhere; (N,) or (N, n_y)."""
    mean = np.sum(eps, axis=0) / np.maximum(mask.sum(axis=0), 1)
    return np.where(mask, eps - mean, 0.0)


def effective_of(e: Vector) -> float:
    """Effective samples of a piece without gaps, for its variance."""
    return max(effective_in(e, np.ones(len(e), dtype=bool)), 1.0)


def effective_in(e: Vector, mask: Mask) -> float:
    """Effective samples for a variance: N over the summed squared autocorrelation."""
    n = int(mask.sum())
    if n < 2:
        return float(n)
    size = 1 << (2 * len(e) - 1).bit_length()
    power = np.abs(np.fft.rfft(e, size)) ** 2
    c = np.fft.irfft(power, size)[: len(e)]
    if c[0] <= 0.0:
        return float(n)
    lags = window(c / n, len(e))
    rho = c[1:lags] / c[0]
    return n / (1.0 + 2.0 * float(rho @ rho))
