"""Variance of sums of correlated products: how far chance alone moves a score."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]

WINDOW_SHARE: Final = 1.0 / 20.0
"""Lag window of the score's variance over the length of the trials: 60 s of 20 minutes, a few times
the memory of waves and gusts, at full scale and, by Froude's law, at any other."""


def lag_window(parts: Sequence[Stretch]) -> int:
    """Samples over which products of residual and sensitivity may be correlated."""
    lengths = {s.trial: len(s.compared) for s in parts}
    return max(round(WINDOW_SHARE * float(np.mean(list(lengths.values())))), 1)


def hac(products: Vector, parts: Sequence[Stretch]) -> Vector:
    """Variance of a sum of correlated products; (q, q), Bartlett weights.

    The outputs of one trial share their disturbances, so their products are added on the clock.
    """
    lags = lag_window(parts)
    total = np.zeros((products.shape[1],) * 2)
    for trial in sorted({s.trial for s in parts}):
        mine = [s for s in parts if s.trial == trial]
        m = np.zeros((max(len(s.compared) for s in mine), products.shape[1]))
        for stretch in mine:
            m[stretch.compared] += products[stretch.rows]
        total += _long_run(m, lags)
    return total


def _long_run(m: Vector, lags: int) -> Vector:
    n = len(m)
    size = 1 << (n + lags).bit_length()
    spectrum = np.fft.rfft(m, size, axis=0)
    weights = np.zeros(size)
    weights[: lags + 1] = 1.0 - np.arange(lags + 1) / (lags + 1)
    weights[size - lags :] = weights[lags:0:-1]
    # the weighted sum of all covariances is one product of spectra with that of the weights
    window = np.fft.rfft(weights).real
    parts = np.full(len(window), 2.0)
    parts[0] = parts[-1] = 1.0
    return np.asarray((spectrum.conj() * (window * parts)[:, None]).T @ spectrum).real / size
