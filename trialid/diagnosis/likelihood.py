"""How likely the records are under one model against another, by whitened residuals."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.accuracy import Stretch
from trialid.diagnosis.residual import Residual, residuals
from trialid.diagnosis.variance import lag_window
from trialid.diagnosis.whitening import Colour, colour_of, whitened
from trialid.identification.fit import Fit
from trialid.trial import Mask

Vector = NDArray[np.float64]

AGAINST: Final = 2.0
"""Standard errors by which held-out trials must become worse to speak against an effect."""


def misfits(fits: Sequence[Fit]) -> tuple[list[float], Colour, int]:
    """Whitened sum of squares of each fit over the trials to fit, the colour, and how many rows.

    All on the samples that every fit compares, by the scale of the first, and by the colour of
    what the closest one leaves over: the others' errors are not all noise.
    """
    columns, parts = _stacked([residuals(f) for f in fits], fits)
    best = int(np.argmin(np.sum(columns**2, axis=0)))
    colour = colour_of(columns[:, best], parts)
    white, _ = whitened(columns, parts, colour)
    return [float(x) for x in np.sum(white**2, axis=0)], colour, len(white)


def objection(before: Fit, after: Fit, more: int, inflation: float) -> str:
    """What speaks against a model with more parameters, empty where nothing does.

    Each parameter pays its price (Schwarz, 1978), and held-out trials must not become worse beyond
    chance.
    """
    (plain, grown), colour, rows = misfits([before, after])
    if after.eps_check == np.inf or speaks_against(check_gain(before, after, colour)):
        return "the held-out error rises"
    if (plain - grown) / inflation <= more * float(np.log(rows)):
        return "the error does not fall by the price of the parameters"
    return ""


def speaks_against(gain: tuple[float, float] | None) -> bool:
    """Whether held-out trials, where there are any, become worse by more than chance."""
    return gain is not None and gain[0] <= -AGAINST * gain[1]


def check_gain(before: Fit, after: Fit, colour: Colour) -> tuple[float, float] | None:
    """Fall of the whitened sum of squares over the held-out trials, and its standard error.

    The colour is that of the trials to fit. None where nothing is held out, or was lost.
    """
    found = [residuals(f, ("check",)) for f in (before, after)]
    if not found[0] or not all(np.isfinite(r.eps).all() for f in found for r in f):
        return None
    columns, parts = _stacked(found, (before, after))
    white, made = whitened(columns, parts, colour)
    gains = white[:, 0] ** 2 - white[:, 1] ** 2
    length, blocks = lag_window(made), list[float]()
    for part in made:
        steps = range(0, part.rows.stop - part.rows.start, length)
        blocks += [float(gains[part.rows][k : k + length].sum()) for k in steps]
    return float(np.sum(blocks)), float(np.sqrt(len(blocks)) * np.std(blocks, ddof=1))


def _stacked(
    found: Sequence[Sequence[Residual]], fits: Sequence[Fit]
) -> tuple[Vector, tuple[Stretch, ...]]:
    """Residuals of several fits side by side, on the samples that all of them compare."""
    scale = [f.problem.y_rms / fits[0].problem.y_rms for f in fits]
    columns, parts, at = list[Vector](), list[Stretch](), 0
    for trial, of_trial in enumerate(zip(*found, strict=True)):
        shared: Mask = np.logical_and.reduce([r.compared for r in of_trial])
        for c in range(shared.shape[1]):
            rows = [r.eps[shared[:, c], c] * s[c] for r, s in zip(of_trial, scale, strict=True)]
            columns.append(np.column_stack(rows))
            count = len(columns[-1])
            parts.append(Stretch(trial, c, slice(at, at + count), shared[:, c]))
            at += count
    return np.concatenate(columns), tuple(parts)
