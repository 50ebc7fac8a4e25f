"""The colour of the noise: an autoregression for each output, and rows filtered by its inverse."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask

Vector = NDArray[np.float64]

ORDER: Final = 20
"""Coefficients of an autoregression; the clock gives them a memory of 2.5 sqrt(L/g)."""

BLOCK: Final = 64
"""Rows filtered by one product of matrices: quicker than tap by tap."""


@dataclass(frozen=True)
class Colour:
    """Noise of every output: filter 1, -a_1, ... and the deviation of what drives it; (p+1,)."""

    filters: tuple[Vector, ...]
    deviations: tuple[float, ...]

    @property
    def reach(self) -> int:
        """Rows that every run of compared values loses at its beginning."""
        return len(self.filters[0]) - 1


def colour(residual: Sequence[Vector], compared: Sequence[Mask], order: int) -> Colour:
    """Least-squares autoregressions, over all trials; (n, n_y) each, zero where not compared.

    Outputs are taken to be disturbed each on its own.
    """
    filters, deviations = [], []
    for c in range(residual[0].shape[1]):
        past, now = [], []
        for e, m in zip(residual, compared, strict=True):
            whole = windows(m[:, c], order).all(axis=1)
            seen = windows(e[:, c], order)[whole]
            past.append(seen[:, -2::-1])
            now.append(seen[:, -1])
        X, y = np.concatenate(past), np.concatenate(now)
        a = np.linalg.lstsq(X, y, rcond=None)[0] if order else np.zeros(0)
        filters.append(np.concatenate([[1.0], -a]))
        deviations.append(float(np.sqrt(np.mean((y - X @ a) ** 2))) or 1.0)
    return Colour(tuple(filters), tuple(deviations))


def order_for(compared: Sequence[Mask]) -> int:
    """The order that leaves twenty rows for each coefficient, `ORDER` at most."""
    least = min(sum(int(m[:, c].sum()) for m in compared) for c in range(compared[0].shape[1]))
    return min(ORDER, least // 20)


def windows(x: NDArray[np.generic], order: int) -> NDArray[np.generic]:
    """Runs of order + 1 values, oldest first; (n - order, order + 1)."""
    return np.lib.stride_tricks.sliding_window_view(x, order + 1)


def whiten_rows(columns: Vector, compared: Mask, noise: Colour) -> Vector:
    """Rows in units of the noise's drive, independent of each other; (n, n_y, q) to (rows, q)."""
    reach, n = noise.reach, len(columns)
    rows = []
    for c, (a, s) in enumerate(zip(noise.filters, noise.deviations, strict=True)):
        keep = windows(compared[:, c], reach).all(axis=1)
        band = np.zeros((BLOCK, BLOCK + reach))
        for i in range(BLOCK):
            band[i, i : i + reach + 1] = a[::-1] / s
        made = np.empty((n - reach, columns.shape[2]))
        for k in range(0, n - reach, BLOCK):
            part = columns[k : k + BLOCK + reach, c]
            made[k : k + BLOCK] = band[: len(part) - reach, : len(part)] @ part
        rows.append(made if keep.all() else made[keep])
    return np.concatenate(rows)
