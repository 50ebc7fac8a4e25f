"""What there was to explain in a fit's trials, and how much of it the model leaves."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit
from trialid.identification.one_search import search
from trialid.identification.record_starts import PIECES, in_pieces
from trialid.identification.trial_score import Score
from trialid.white_noise import SMOOTH

Vector = NDArray[np.float64]
Mask = NDArray[np.bool_]

CLOSER: Final = 2.0
"""Times as close as the fit that other values follow the record in pieces where the fit stands in a
false valley. Twenty fits of four real ships had 1.0 to 1.3, eight false valleys of one simulated
ship 3.7 to 8.3: half of it would refuse all, twice of it misses some."""


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


def closer_in_pieces(fit: Fit) -> tuple[int, float] | None:
    """Into how many pieces a record is cut, and how much closer other values follow them.

    Each piece has a start of its own, with the fitted values and with those searched for. None
    where others are not `CLOSER`.
    """
    cut = in_pieces(fit.problem, fit.settings, PIECES[0], fit.estimates)
    stretches_to_fit = [
        replace(x, low=x.start, high=x.start) if x.trial is None else x for x in cut.unknowns
    ]
    held = replace(cut, unknowns=tuple(stretches_to_fit))
    own, best = (search(problem, fit.settings, problem.start) for problem in (held, cut))
    closer = float(np.sqrt(own.V / best.V)) if own.began and best.began else 1.0
    return (len(cut.trials), closer) if closer >= CLOSER else None
