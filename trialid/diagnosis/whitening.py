"""Residual and sensitivities through the inverse of the residual's colour."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.accuracy import Stretch
from trialid.diagnosis.augment import Augmented
from trialid.diagnosis.variance import lag_window
from trialid.trial import Mask

Vector = NDArray[np.float64]

WHITENING_SHARE: Final = 1.0 / 6.0
"""Memory of the autoregression that whitens the residual, over the lag window."""


def whitened(augmented: Augmented) -> tuple[Vector, Vector, Vector, tuple[Stretch, ...]]:
    """Residual, base and candidate columns filtered by the inverse of the residual's colour."""
    order = max(round(WHITENING_SHARE * lag_window(augmented.stretches)), 1)
    filters = _autoregressions(augmented, order)
    rows, made, at = [], [], 0
    every = np.column_stack([augmented.residual, augmented.psi, augmented.S])
    for stretch in augmented.stretches:
        full = np.zeros((len(stretch.compared), every.shape[1]))
        full[stretch.compared] = every[stretch.rows]
        out, valid = _filtered(full, stretch.compared, filters[stretch.output])
        count = int(valid.sum())
        rows.append(out[valid])
        made.append(Stretch(stretch.trial, stretch.output, slice(at, at + count), valid))
        at += count
    done = np.concatenate(rows)
    n = augmented.psi.shape[1]
    return done[:, 0], done[:, 1 : n + 1], done[:, n + 1 :], tuple(made)


def _autoregressions(augmented: Augmented, order: int) -> dict[int, Vector]:
    """Coefficients 1, -a_1, ... of each output's residual, by least squares over all trials."""
    filters = {}
    for output in sorted({s.output for s in augmented.stretches}):
        targets, lags = [], []
        for stretch in augmented.stretches:
            if stretch.output == output:
                e = np.zeros(len(stretch.compared))
                e[stretch.compared] = augmented.residual[stretch.rows]
                past = np.lib.stride_tricks.sliding_window_view(e, order)[:-1, ::-1]
                whole = np.lib.stride_tricks.sliding_window_view(stretch.compared, order + 1)
                keep = whole.all(axis=1)
                targets.append(e[order:][keep])
                lags.append(past[keep])
        X, y = np.concatenate(lags), np.concatenate(targets)
        if len(y) < 4 * order:
            filters[output] = np.array([1.0])
            continue
        a, *_ = np.linalg.lstsq(X, y, rcond=None)
        scale = float(np.std(y - X @ a)) or 1.0
        filters[output] = np.concatenate([[1.0], -a]) / scale
    return filters


def _filtered(full: Vector, compared: Mask, a: Vector) -> tuple[Vector, Mask]:
    """FIR-filtered columns, and where every tap fell on a compared sample."""
    n, reach = len(full), len(a) - 1
    out, valid = np.zeros_like(full), np.zeros(n, dtype=bool)
    valid[reach:] = True
    for k, tap in enumerate(a):
        out[reach:] += tap * full[reach - k : n - k]
        valid[reach:] &= compared[reach - k : n - k]
    return out, valid
