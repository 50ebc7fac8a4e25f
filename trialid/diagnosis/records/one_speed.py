"""A speed that is one in all trials, the noise of its log apart, is read without that noise.

All forces have the noise of a speed that is read from a log in them, which no ship has, and effects
of how her speed changes take it out again: of two linear ships of an outsider's, at one speed that
was logged with 1 % of noise, the rudder's race was missing, by 0.02 % of what moved.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.identification.approach import logged_speed
from trialid.trial import Trial

ONE_SPEED: Final = 0.005
"""Share of her speed that its means over a length scatter by where it is the same: a hundredth of
all forces goes by that. Those two ships and six others of 50 of outsiders, on a course, have 0.0007
to 0.0034, those in manoeuvres 0.0107 at least: at twice of it the same are told, at half two fewer.
"""


def without_noise_of_speed(trials: Sequence[Trial], length: float) -> tuple[Trial, ...]:
    """The trials at their mean speed where it is one in all; `length`: time for her own [s]."""
    logged = [(logged_speed(t), t.period) for t in trials]
    means = [_means(y, length / period) for y, period in logged if len(y) and np.ptp(y) > 0.0]
    if not means:
        return tuple(trials)
    speeds = np.concatenate(means)
    scatter = float(np.std(speeds) / np.mean(np.abs(speeds)))
    return tuple(_steady(t, scatter) if scatter <= ONE_SPEED else t for t in trials)


def _steady(trial: Trial, scatter: float) -> Trial:
    logged = logged_speed(trial)
    if not len(logged) or np.ptp(logged) == 0.0:
        return trial
    u = float(np.mean(logged))
    said = f"u: she goes at one speed, to {scatter:.1%}; read as {u:.4g} m/s, its log's noise apart"
    signals = {**trial.signals, "u": np.full(trial.samples, u)}
    return replace(trial, signals=signals, remarks=(*trial.remarks, said))


def _means(y: Vector, samples: float) -> Vector:
    """Means over so many samples each, of all where there are fewer."""
    parts = max(int(len(y) / max(samples, 1.0)), 1)
    return np.array([part.mean() for part in np.array_split(y, parts)])
