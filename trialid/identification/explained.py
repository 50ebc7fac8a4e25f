"""What there was to explain in a fit's trials, and how much of it the model leaves."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit, Score

Vector = NDArray[np.float64]
Mask = NDArray[np.bool_]

SMOOTH = np.sqrt(20.0)
"""Standard deviation of the third differences of white noise of one: 1, 3, 3, 1."""


def of_use(fit: Fit, use: str) -> list[Score]:
    """Scores of the trials that were fitted, or held out (`check`)."""
    return [s for s in fit.scores if s.trial.use == use]


def over_noise(fit: Fit, scores: Sequence[Score]) -> dict[str, float]:
    """Standard deviation of each output over that of its noise, in the trial where it moves most.

    White noise by third differences, which a ship's smooth motion does not survive. Samples so
    sparse that the motion itself is in the differences make the ratio smaller.
    """
    return {
        name: max((_ratio(s.trial.signals[name], s.compared[:, i]) for s in scores), default=0.0)
        for i, name in enumerate(fit.problem.outputs)
    }


def _ratio(y: Vector, compared: Mask) -> float:
    if int(compared.sum()) < 8:
        return 0.0
    steps = np.diff(y, 3)[np.convolve(compared, np.ones(4), "valid") > 3.5]
    noise = float(np.std(steps) / SMOOTH) if len(steps) else 0.0
    moved = float(np.std(y[compared]))
    return moved / noise if noise > 0.0 else (np.inf if moved > 0.0 else 0.0)


def unexplained_share(fit: Fit, scores: Sequence[Score]) -> dict[str, float]:
    """Squared error of each output over what the mean of each trial would leave; inf where lost."""
    return {name: _share(scores, name, i) for i, name in enumerate(fit.problem.outputs)}


def _share(scores: Sequence[Score], name: str, output: int) -> float:
    left, there = 0.0, 0.0
    for score in scores:
        if score.response.departure is not None:
            return float("inf")
        keep = score.compared[:, output]
        y = score.trial.signals[name][keep]
        if len(y):
            left += float(np.sum((y - score.response.y[keep, output]) ** 2))
            there += float(np.sum((y - y.mean()) ** 2))
    return left / there if there > 0.0 else float("inf")
