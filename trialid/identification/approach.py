"""What the log of a trial says of her speed, and which of it is her approach."""

from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.trial import Trial

APPROACH: Final = 0.975
"""Quantile of the logged speeds that is the approach: noise is beyond it, turns are below.

Of trials of 7 minutes that began with 20 s straight ahead an outsider's U0 was 1.1 % low at 0.9 and
is 0.1 % high now, 0.2 % low at 0.95 (twice as much beyond), 0.4 % high at 0.9875 (half)."""


def approach_speed(trial: Trial) -> float | None:
    """Her speed on the approach [m/s], below zero where she goes astern; None where none is logged.

    Before turns cost any, as speed lost in turns is reckoned.
    """
    logged = logged_speed(trial)
    return float(np.quantile(logged, APPROACH)) if len(logged) else None


def logged_speed(trial: Trial) -> Vector:
    """What her log says of her speed [m/s], where it says anything; (n,), none without a log."""
    if "u" not in trial.signals:
        return np.empty(0)
    valid = trial.valid.get("u", np.ones(trial.samples, dtype=bool))
    return np.asarray(trial.signals["u"][valid & np.isfinite(trial.signals["u"])])
