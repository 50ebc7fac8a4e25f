"""A long record examined by means of a few samples each: what is slow stays, the time is saved.

Every candidate has a column with a row for each compared sample; five trials of 100 000 samples
would take 13 GB and four minutes. A ship moves slowly beside the sensors of such records.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trialid.identification.fit import Fit

LONGEST: Final = 16_000
"""Rows a trial that are examined one by one: 2.2 hours at two samples a second."""

KEPT: Final = 0.995
"""Share of the variance of every predicted output that means must keep."""


def coarse(fit: Fit) -> Fit:
    """The fit with rows of several samples where its longest trial has more than 16 000.

    Fewer samples a row than asked for where the ship moves faster than that.
    """
    every = -(-max(t.samples for t in fit.problem.trials) // LONGEST)
    while every > 1 and _kept(fit, every) < KEPT:
        every -= 1
    return fit if every == 1 else replace(fit, problem=replace(fit.problem, every=every))


def _kept(fit: Fit, every: int) -> float:
    """The smallest share of variance that means keep, over outputs; all fitted trials together."""
    kept, whole = np.zeros((2, len(fit.problem.outputs)))
    for score in (s for s in fit.scores if s.trial.use == "fit"):
        y = score.response.y - score.response.y.mean(axis=0)
        means = y[: len(y) // every * every].reshape(-1, every, y.shape[1]).mean(axis=1)
        kept += every * np.sum(means**2, axis=0)
        whole += np.sum(y**2, axis=0)
    return float(np.min(kept / np.maximum(whole, 1e-300)))
