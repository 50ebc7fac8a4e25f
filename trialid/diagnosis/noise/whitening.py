"""Columns through the inverse of the noise's colour, so that their rows are independent."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.noise.variance import lag_window
from trialid.trial_rows import Stretch

Vector = NDArray[np.float64]
Colour = Mapping[int, Vector]
"""Output to the coefficients (1, -a_1, ...) / s of an autoregression that s drives."""

MEMORY_SHARE: Final = 1.0 / 6.0
"""Memory of the autoregression over the lag window: 10 s of 20 minutes, a wave or two."""

MOST_TAPS: Final = 160
"""Reached by trials of 19 200 samples; the cost grows with the square of it."""

ROWS_FOR_EACH: Final = 4
"""Rows that a coefficient needs; shorter records are left as they are."""


BLOCK: Final = 64
"""Rows filtered by one product of matrices: four times quicker than tap by tap."""


def memory(parts: Sequence[Stretch]) -> int:
    """Samples that an autoregression of these records looks back."""
    return min(max(round(MEMORY_SHARE * lag_window(parts)), 1), MOST_TAPS)


def colour_of(residual: Vector, parts: Sequence[Stretch]) -> Colour:
    """Autoregressions of each output's residual, by least squares over all trials; (M,)."""
    order = memory(parts)
    found = {}
    for output in sorted({s.output for s in parts}):
        mine = [s for s in parts if s.output == output]
        pieces = [_windows(residual, s, order) for s in mine]
        W = np.concatenate(pieces)
        if len(W) < ROWS_FOR_EACH * order:
            size = float(np.sqrt(np.mean(np.concatenate([residual[s.rows] for s in mine]) ** 2)))
            found[output] = np.array([1.0 / (size or 1.0)])
            continue
        X, y = W[:, -2::-1], W[:, -1]
        a = np.linalg.solve(X.T @ X + 1e-12 * np.trace(X.T @ X) * np.eye(order), X.T @ y)
        scale = float(np.std(y - X @ a)) or 1.0
        found[output] = np.concatenate([[1.0], -a]) / scale
    return found


def _windows(residual: Vector, part: Stretch, order: int) -> Vector:
    """Runs of order + 1 compared values, oldest first; (n, order + 1)."""
    e = np.zeros(len(part.compared))
    e[part.compared] = residual[part.rows]
    if len(e) <= order:
        return np.zeros((0, order + 1))
    whole = np.lib.stride_tricks.sliding_window_view(part.compared, order + 1).all(axis=1)
    return np.asarray(np.lib.stride_tricks.sliding_window_view(e, order + 1)[whole])


def whiten_columns(
    columns: Vector, parts: Sequence[Stretch], colour: Colour
) -> tuple[Vector, tuple[Stretch, ...]]:
    """Columns filtered by the inverse of the colour, and which rows they now are; (M, n)."""
    made, at = [], 0
    for part in parts:
        valid = _whole(part.compared, len(colour[part.output]))
        stop = at + int(valid.sum())
        made.append(Stretch(part.trial, part.output, slice(at, stop), valid))
        at = stop
    white = np.empty((at, columns.shape[1]))
    for part, to in zip(parts, made, strict=True):
        full = part.on_clock(columns[part.rows])
        white[to.rows] = _filtered(full, colour[part.output])[to.compared]
    return white, tuple(made)


def _whole(compared: Mask, taps: int) -> Mask:
    """Where every tap falls on a compared sample."""
    valid = np.zeros(len(compared), dtype=bool)
    if len(compared) >= taps:
        windows = np.lib.stride_tricks.sliding_window_view(compared, taps)
        valid[taps - 1 :] = windows.all(axis=1)
    return valid


def _filtered(full: Vector, a: Vector) -> Vector:
    """FIR-filtered columns."""
    n, reach = len(full), len(a) - 1
    out = np.zeros_like(full)
    band = np.zeros((BLOCK, BLOCK + reach))
    for i in range(BLOCK):
        band[i, i : i + reach + 1] = a[::-1]
    for k in range(reach, n, BLOCK):
        part = full[k - reach : k + BLOCK]
        rows = len(part) - reach
        out[k : k + rows] = band[:rows, : len(part)] @ part
    return out
