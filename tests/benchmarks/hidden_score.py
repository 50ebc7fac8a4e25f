"""How plainly a hidden effect stands in a record, known from the truth and not from the diagnosis.

The log-likelihood ratio between the fitted model and the same with the effect in it at its true
size, in noise whose colour is that of the second fit's residual. A score test tends to it when the
noise is known; unlike the package's score it is not bounded by the length of the record, and it
keeps its meaning when the diagnosis changes.
"""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit, identify
from trialid.identification.output_error import output_matrix
from trialid.ship.model import ShipModel
from trialid.trial import Trial

Vector = NDArray[np.float64]
MEMORY: Final = 40.0
"""[s] of the autoregression that whitens: the memory of the slowest gusts."""


def plainness(
    fit: Fit, trials: Sequence[Trial], truth: ShipModel, values: Mapping[str, float]
) -> tuple[float, float]:
    """Twice the log-likelihood ratio of the true model to the fitted one, and what it takes off.

    The second is the share of the squared error that goes with the truth.

    Parameters
    ----------
    trials
        The same records for the true model: where a gear is hidden, with the true rudder.
    truth
        The model with what is hidden; it is fitted, what is hidden held as it is.
    values
        True values of the fitted parameters, from which that fit starts: no other minimum is meant.
    """
    known = identify(trials, truth, fit.settings, near={**fit.estimates, **values})
    total = 0.0
    for c in range(len(fit.problem.outputs)):
        mine, other = (_residuals(f, c) for f in (fit, known))
        both = [np.isfinite(a) & np.isfinite(b) for a, b in zip(mine, other, strict=True)]
        mine, other = ([e[m] for e, m in zip(es, both, strict=True)] for es in (mine, other))
        order = round(MEMORY / fit.problem.trials[0].period)
        before, after = (np.concatenate([_past(e, order) for e in es]) for es in (mine, other))
        a, *_ = np.linalg.lstsq(after[:, 1:], after[:, 0], rcond=None)
        whitener = np.concatenate([[1.0], -a])
        noise = after @ whitener
        total += (np.sum((before @ whitener) ** 2) - np.sum(noise**2)) / np.var(noise)
    return float(total), float(1.0 - (known.eps_rmsn / fit.eps_rmsn) ** 2)


def _residuals(fit: Fit, output: int) -> list[Vector]:
    """Measured less simulated of every trial to fit [SI], NaN where nothing is compared."""
    return [
        np.where(
            s.compared[:, output],
            (output_matrix(s.trial, fit.problem.outputs) - s.response.y)[:, output],
            np.nan,
        )
        for s in fit.scores
        if s.trial.use == "fit"
    ]


def _past(e: Vector, order: int) -> Vector:
    """Each value with those before it, the latest first; (N - order, order + 1)."""
    return np.lib.stride_tricks.sliding_window_view(e, order + 1)[:, ::-1]
