"""How far each parameter can be trusted: Blanke & Knudsen (1999), Eq. 8 to 14, in their order.

Everything starts from the sensitivity matrix A = [Psi L / y_RMS] / sqrt(N n_y), one row per
compared value and one column per parameter, so that A^T A is the relative normed Hessian H_rn.
H_rn itself is never formed or inverted: sensitivities come from the singular values and the R
factor of A.
"""

from typing import Final

import numpy as np
from scipy.linalg import solve_triangular

from trialid.arrays import Mask, Vector
from trialid.least_squares.fold import triangle

RANK: Final = 1e-10
"""Singular values below this share of the largest are zero: a direction nobody can see."""


def normed_rms(eps: Vector, y_rms: float) -> float:
    """Eq. 8: root mean square of the output error over that of the output.

    >>> normed_rms(np.array([0.5, -0.5]), 2.0)
    0.25
    """
    return float(np.sqrt(np.mean(np.square(eps))) / y_rms)


def relative_sensitivities(psi: Vector, reference: Vector) -> Vector:
    """Eq. 9: A with A^T A = H_rn = y_RMS^-2 L H L; (M, n_theta).

    Parameters
    ----------
    psi
        Normed sensitivities d(yhat / y_RMS) / d(theta) / sqrt(N n_y), all outputs and trials
        stacked; (M, n_theta).
    reference
        Diagonal of L: the estimate, or the typical size where the estimate is near zero.
    """
    return psi * reference


def minimum_sensitivity(A: Vector) -> Vector:
    """Eq. 10: S_imin = ([H_rn^-1]_ii)^-1/2, what is left of S_i when the others answer; (n_theta,).

    Zero for a parameter in a direction that leaves no trace.

    >>> minimum_sensitivity(np.array([[2.0, 0.0], [0.0, 3.0]])).tolist()
    [2.0, 3.0]
    """
    norms = np.linalg.norm(A, axis=0)
    if not np.all(norms > 0.0):
        return _with_dead_columns(A, norms > 0.0)
    R = triangle(A) / norms
    _, s, Vt = np.linalg.svd(R)
    unseen = s <= RANK * s[0]
    if unseen.any():
        hidden = (np.abs(Vt[unseen]) > 1e-6).any(axis=0)
        return np.where(hidden, 0.0, _from_svd(s, Vt, ~unseen)) * norms
    inverse = solve_triangular(R, np.eye(len(R)))
    result: Vector = norms / np.linalg.norm(inverse, axis=1)
    return result


def _with_dead_columns(A: Vector, alive: Mask) -> Vector:
    result = np.zeros(A.shape[1])
    if alive.any():
        result[alive] = minimum_sensitivity(A[:, alive])
    return result


def _from_svd(s: Vector, Vt: Vector, seen: Mask) -> Vector:
    result: Vector = 1.0 / np.sqrt(np.sum((Vt[seen] / s[seen, None]) ** 2, axis=0))
    return result


def sensitivity_range(A: Vector) -> tuple[float, float, float]:
    """Eq. 11: S_min, S_max over all directions of parameter space, and R = S_max / S_min.

    R depends on how the parameters are scaled; R_i (Eq. 13) does not.

    >>> sensitivity_range(np.diag([2.0, 4.0]))
    (2.0, 4.0, 2.0)
    """
    s = np.linalg.svd(triangle(A), compute_uv=False)
    ratio = float(s[0] / s[-1]) if s[-1] > RANK * s[0] else float("inf")
    return float(s[-1]), float(s[0]), ratio


def sensitivity(A: Vector) -> Vector:
    """Eq. 12: S_i = ([H_rn]_ii)^1/2, sensitivity to each parameter alone; (n_theta,)."""
    result: Vector = np.linalg.norm(A, axis=0)
    return result


def correlation_ratio(A: Vector) -> Vector:
    """Eq. 13: R_i = S_i / S_imin >= 1; its square is the variance inflation factor; (n_theta,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(sensitivity(A) / minimum_sensitivity(A))


def relative_error(
    noise: float, undermodelling: float, S_imin: Vector, samples: float | Vector
) -> tuple[Vector, Vector]:
    """Eq. 14: relative error of each parameter, its noise part and its model part; (n_theta,) each.

    The first is one standard deviation; it falls with the number of samples, which for coloured
    residuals is the effective one. The second is a bound over all model errors of this size; it
    does not fall, and assumes that the invisible part of the model error is about as large as the
    visible one.

    >>> [float(x[0]) for x in relative_error(0.1, 0.02, np.array([0.5]), 400)]
    [0.01, 0.04]
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return noise / (S_imin * np.sqrt(samples)), undermodelling / S_imin
