"""How far a measurement may lie from the prediction of a trial that was not fitted.

Each fitted trial is left out in turn and predicted from the others, to first order and with no
further simulation: the parameters come from the other trials, what belongs to a sensor takes the
mean of theirs, and only where the motion starts and its current are the trial's own, as for a trial
held out. What is left holds noise, what the model lacks, and what parameters and sensors differ by
from trial to trial. What only the trial left out tells stays within what is typical of it. Where
the trials are unlike, few tell how large it may be: as many degrees of freedom as the scatter of
their mean squares leaves (Satterthwaite 1946, Biometrics Bulletin 2).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit  # scipy.stats would take another 0.4 s to import

from trialid.accuracy.likely import WIDE
from trialid.arrays import Vector
from trialid.diagnosis.search.carry_over import prior_rows, take_out
from trialid.identification.check.own_start import columns_of_its_own
from trialid.identification.fit import Fit
from trialid.identification.output_error import stretches
from trialid.trial_rows import Stretch

CENTRAL: Final = 0.975
"""Student's level of either end of the band."""

FEWEST: Final = 2.0
"""Degrees of freedom that are never thought to be fewer: with one, a band would be endless."""


def prediction_band(fit: Fit) -> dict[str, float]:
    """Half-width of the 95 % band by output [SI]; empty with fewer than two fitted trials."""
    parts = stretches(fit.problem)
    trials = list(dict.fromkeys(p.trial for p in parts))
    if len(trials) < 2:
        return {}
    left = _left_out(fit, parts, trials)
    scale = np.asarray(fit.problem.weights) / np.sqrt(len(fit.problem.outputs))
    band = {}
    for c, name in enumerate(fit.problem.outputs):
        mine = [p for p in parts if p.output == c]
        squares = np.array([float(left[p.rows] @ left[p.rows]) for p in mine])
        counts = np.array([p.rows.stop - p.rows.start for p in mine])
        rows = float(counts.sum())
        size = np.sqrt(squares.sum()) / scale[c] * float(fit.problem.y_rms[c])
        band[name] = float(_student(squares / np.maximum(counts, 1)) * size) if rows else 0.0
    return band


def _student(means: Vector) -> float:
    """Quantile for mean squares that differ from trial to trial."""
    middle, scatter = float(np.mean(means)), float(np.var(means, ddof=1))
    freedom = 2.0 * middle**2 / scatter if scatter > 0.0 else np.inf
    return float(stdtrit(min(max(freedom, FEWEST), 1e6), CENTRAL))


@dataclass(frozen=True)
class _Rows:
    """One trial's rows and own unknowns, and the products of its rows less what those reach."""

    rows: NDArray[np.intp]
    own: list[int]
    gram: Vector


def _left_out(fit: Fit, parts: Sequence[Stretch], trials: Sequence[int]) -> Vector:
    """The residual of every trial by a fit of the others; (M,). What is at a bound stays there."""
    free = [i for i, x in enumerate(fit.problem.unknowns) if x.name not in fit.at_bounds]
    shared = [i for i in free if fit.problem.unknowns[i].trial is None]
    priors = prior_rows(fit)
    known = []
    for trial in trials:
        own = [i for i in free if fit.problem.unknowns[i].trial == trial]
        known.append(_rows(fit, [p for p in parts if p.trial == trial], own, shared, priors))
    whole = np.sum([k.gram for k in known], axis=0)
    slopes, gaps = priors[shared].T
    loose = fit.level / (WIDE * np.array([fit.problem.unknowns[i].size for i in shared]))
    beside = np.diag(np.append(np.where(slopes > 0.0, slopes, loose) ** 2, 0.0))
    beside[:-1, -1] = beside[-1, :-1] = slopes * gaps
    left = np.zeros(len(fit.residual))
    for one in known:
        step = _solution(whole - one.gram + beside)
        e = fit.residual[one.rows] - fit.psi[one.rows][:, shared] @ step
        left[one.rows] = _started(fit, one, e, priors)
    return left


def _rows(
    fit: Fit, mine: Sequence[Stretch], own: list[int], shared: list[int], priors: Vector
) -> _Rows:
    rows = np.concatenate([np.arange(p.rows.start, p.rows.stop) for p in mine])
    X = np.column_stack([fit.psi[rows][:, shared], fit.residual[rows]])
    X = take_out(fit.psi[rows][:, own], X, priors[own], len(shared))
    return _Rows(rows, own, X.T @ X)


def _solution(gram: Vector) -> Vector:
    """Least squares from the products of columns and, last, the residual."""
    sizes = np.sqrt(np.maximum(np.diag(gram)[:-1], 1e-300))
    scaled = gram[:-1, :-1] / np.outer(sizes, sizes)
    inverse = np.linalg.pinv(scaled, rcond=1e-9, hermitian=True)
    return np.asarray(inverse @ (gram[:-1, -1] / sizes) / sizes)


def _started(fit: Fit, trial: _Rows, e: Vector, priors: Vector) -> Vector:
    """The residual with sensors at the mean of the other trials', its own kept."""
    names, its_own = [x.column for x in fit.problem.unknowns], columns_of_its_own(fit.problem)
    starts = [i for i in trial.own if names[i] in its_own]
    for i in (i for i in trial.own if i not in starts):
        others = [fit.theta[j] for j, name in enumerate(names) if name == names[i] and j != i]
        if others:
            e = e - fit.psi[trial.rows, i] * (float(np.mean(others)) - fit.theta[i])
    N = fit.psi[trial.rows][:, starts]
    return take_out(N, e[:, None], priors[starts], 0)[:, 0]
