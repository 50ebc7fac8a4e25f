"""A long record examined by means of a few samples each: what is slow stays, the time is saved.

Every candidate has a column with a row for each compared sample; five trials of 100 000 samples
would take 13 GB and four minutes. A ship moves slowly beside the sensors of such records, and what
a linear model makes of means of its inputs are the means of its outputs.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.identification.fit import Fit, identify, revive
from trialid.names.quantities import SIGNALS
from trialid.trial import Trial

LONGEST: Final = 12_000
"""Samples a trial that are examined one by one: 1.7 hours at two samples a second."""

KEPT: Final = 0.995
"""Share of the variance of every predicted output that means must keep."""


def with_means(fit: Fit) -> Fit:
    """The fit with the same fitted to means, where its longest trial has more than 12 000 samples.

    Fewer samples together than asked for where the ship moves faster than that.
    """
    every = samples_together(fit)
    if fit.by_means is not None or every == 1:
        return fit
    trials = [mean_trial(t, every) for t in fit.trials]
    found = identify(trials, fit.model, fit.settings, near=fit.estimates, smaller=fit)
    return replace(fit, by_means=replace(found, rivals=fit.rivals))


def on_every_sample(fit: Fit, found: Fit) -> Fit:
    """What was fitted to the trials that a fit was examined by, on that fit's own trials."""
    found = replace(found)  # its gradient is let go: it is larger than all else
    if fit.by_means is None:
        return found
    settings = replace(found.settings, substeps=fit.settings.substeps)
    whole = revive(fit.trials, found.model, settings, found.estimates)
    return replace(
        found,
        settings=settings,
        problem=whole.problem,
        residual=whole.residual,
        scores=whole.scores,
        level=whole.level,
        by_means=found,
    )


def samples_together(fit: Fit) -> int:
    """How many samples may be taken together: the response keeps its size by `KEPT`."""
    every = -(-max(t.samples for t in fit.problem.trials) // LONGEST)
    while every > 1 and _kept(fit, every) < KEPT:
        every -= 1
    return every


def mean_trial(trial: Trial, every: int) -> Trial:
    """The trial on a clock of so many samples; a mean with a gap in it was not measured.

    What is left over at the end is left out; an angle that jumps by a turn is put together first.
    """
    whole = trial.samples // every * every

    def means(name: str, y: Vector) -> Vector:
        angle = name in SIGNALS and SIGNALS[name].angle
        y = np.unwrap(y) if angle else y
        return np.asarray(y[:whole].reshape(-1, every).mean(axis=1))

    valid: Mapping[str, Mask] = {
        n: np.all(m[:whole].reshape(-1, every), axis=1) for n, m in trial.valid.items()
    }
    signals = {n: means(n, y) for n, y in trial.signals.items()}
    return replace(trial, period=every * trial.period, signals=signals, valid=valid)


def _kept(fit: Fit, every: int) -> float:
    """The smallest share of variance that means keep, over outputs; all fitted trials together."""
    kept, whole = np.zeros((2, len(fit.problem.outputs)))
    for score in (s for s in fit.scores if s.trial.use == "fit"):
        y = score.response.y - score.response.y.mean(axis=0)
        means = y[: len(y) // every * every].reshape(-1, every, y.shape[1]).mean(axis=1)
        kept += every * np.sum(means**2, axis=0)
        whole += np.sum(y**2, axis=0)
    return float(np.min(kept / np.maximum(whole, 1e-300)))
