"""The speed that a ship has before she manoeuvres, from the log of a trial."""

from typing import Final

import numpy as np

from trialid.trial import Trial

APPROACH: Final = 0.95
"""Quantile of the logged speeds that is the approach: noise is beyond it, turns are below."""


def approach_speed(trial: Trial) -> float | None:
    """Her speed on the approach [m/s], below zero where she goes astern; None where none is logged.

    Before turns cost any, as speed lost in turns is reckoned.
    """
    if "u" not in trial.signals:
        return None
    valid = trial.valid.get("u", np.ones(trial.samples, dtype=bool))
    logged = trial.signals["u"][valid & np.isfinite(trial.signals["u"])]
    return float(np.quantile(logged, APPROACH)) if len(logged) else None
