"""How far off a rate is by the angle beside it: what its integral runs away from that angle."""

from typing import Final

import numpy as np

from trialid.ship.model import KINEMATICS
from trialid.trial import Trial
from trialid.white_noise import FEWEST

ANGLES: Final = {rate: angle for angle, rate in KINEMATICS.items()}
"""The angle whose rate each is."""

SCALE: Final = 0.02
"""What a rate reads too much or too little, as a share: 1 to 2 % of fibre-optic and vibrating
gyros. A turn adds it up: after 600 deg in ten minutes one that reads 2 % too much lies 0.8
deviations off, with half of it 1.3, with twice 0.4."""

OF_ONE: Final = float(np.sqrt(12.0))
"""Error of a slope over one deviation of what is left, as if all of that were one slow swing."""


def gyro_offset(trial: Trial, rate: str, angle_off: float) -> tuple[float, float] | None:
    """Offset of a recorded rate and its standard deviation [rad/s]; None without its angle.

    What neither holds is left out, and what runs off in the rest goes on.

    Parameters
    ----------
    angle_off
        By how much the angle itself may be another at the end than at the start [rad].
    """
    angle = ANGLES[rate]
    if not {rate, angle} <= {*trial.signals}:
        return None
    there = trial.valid[rate] & trial.valid[angle]
    pairs = there[1:] & there[:-1]
    if pairs.sum() < FEWEST:
        return None
    r, turned = trial.signals[rate], np.diff(trial.signals[angle])[pairs]
    off = np.cumsum(0.5 * trial.period * (r[1:] + r[:-1])[pairs] - turned)
    t = trial.period * np.arange(len(off))
    slope, start = np.polyfit(t, off, 1)
    left = float(np.std(off - slope * t - start))
    whole = np.hypot(angle_off + SCALE * abs(float(turned.sum())), OF_ONE * left)
    return float(slope), float(whole / t[-1])
