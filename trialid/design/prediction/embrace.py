"""A prediction with ranges that hold what another model of the ship does."""

from dataclasses import replace

import numpy as np

from trialid.accuracy.ranges import wider
from trialid.arrays import Vector
from trialid.design.prediction.ranged_motion import PredictedMotion

Ends = tuple[Vector, Vector]


def embrace(own: PredictedMotion, other: PredictedMotion) -> PredictedMotion:
    """The same with ranges that hold those of another, of whatever both have, as far as it goes."""
    ranges = {
        name: _wider(ends, _at(own.t, other.t, other.ranges[name]))
        if name in other.ranges
        else ends
        for name, ends in own.ranges.items()
    }
    theirs = {name: ends for name, (_, ends) in other.numbers.items()}
    numbers = {n: (x, wider(ends, theirs.get(n))) for n, (x, ends) in own.numbers.items()}
    return replace(own, ranges=ranges, numbers=numbers)


def _at(t: Vector, theirs: Vector, ends: Ends) -> Ends:
    """The ends at other times; NaN beyond the last."""
    low, high = (np.interp(t, theirs, end, right=np.nan) for end in ends)
    return low, high


def _wider(own: Ends, there: Ends) -> Ends:
    """Ends that hold others too; where these are not known they stay, and NaN stays NaN."""
    low, high = (np.where(np.isnan(a), b, a) for a, b in zip(there, own, strict=True))
    return np.minimum(own[0], low), np.maximum(own[1], high)
