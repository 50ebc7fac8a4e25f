"""The ways down from one linearisation, damped as Levenberg and Marquardt do."""

from functools import cached_property
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.least_squares.fold import Fold

RANK: Final = 1e-12
"""Share of the largest singular value below which a direction is rounding."""


class Directions:
    """Damped steps of one linearisation, from one small SVD."""

    def __init__(self, fold: Fold, moving: Mask, weights: Vector) -> None:
        self.fold, self.R = fold, fold.R[:, moving] / weights[moving]
        U, self.s, self.Vt = np.linalg.svd(self.R, full_matrices=False)
        self.along = U.T @ fold.q

    @cached_property
    def orthogonality(self) -> float:
        """Share of the residual that lies along the sensitivities."""
        # columns of unit length, so that what is left of rank is rounding and not scale
        lengths = np.linalg.norm(self.R, axis=0)
        U, s, _ = np.linalg.svd(self.R / np.where(lengths > 0.0, lengths, 1.0), full_matrices=False)
        within = (U.T @ self.fold.q)[s > RANK * s[0]]
        whole = np.hypot(np.linalg.norm(self.fold.q), self.fold.rest)
        return float(np.linalg.norm(within) / whole)

    def step(self, damping: float) -> Vector:
        """The step that minimises |r - A d|^2 + damping |d|^2."""
        ratio = self.s / (self.s**2 + damping)
        return np.asarray(self.Vt.T @ (ratio * self.along))
