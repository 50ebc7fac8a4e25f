"""What differs between two runs of one manoeuvre: noise, and what the model errs differently by."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.noise.residual import Residual

Vector = NDArray[np.float64]

STEEP: Final = 3.0
"""How much faster than the motion a model's error may change from run to run: a cubic's. Of 44
tests taken for periodic the noise is inside in 36, 7 are refused; with half 24 are inside and none
is refused, with twice 12 are and 32 refused."""


def differences(one: Residual, other: Residual) -> tuple[Vector, Mask]:
    """Half-difference scaled to one run's noise: the model's own error cancels; (N, n_y)."""
    n = min(len(one.eps), len(other.eps))
    both = one.compared[:n] & other.compared[:n]
    return np.where(both, (one.eps[:n] - other.eps[:n]) / np.sqrt(2.0), 0.0), both


def may_be_unlike(one: Residual, other: Residual) -> Vector:
    """Mean square that half the difference may owe to errors of the model; (n_y,).

    They are as unlike as the motions that it foretells are, or a few times as much.
    """
    n = min(len(one.eps), len(other.eps))
    apart = np.mean((one.predicted[:n] - other.predicted[:n]) ** 2, axis=0)
    moved = np.maximum(np.var(one.predicted[:n], axis=0), 1e-30)
    error = 0.5 * np.mean(one.eps[:n] ** 2 + other.eps[:n] ** 2, axis=0)
    return np.asarray(0.5 * STEEP**2 * np.minimum(apart / moved, 1.0) * error)
