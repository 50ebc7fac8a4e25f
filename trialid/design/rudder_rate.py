"""How fast a ship's rudder goes over, from how it went over in her trials."""

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

from trialid.arrays import Vector
from trialid.trial import Trial

GEAR: Final = float(np.deg2rad(2.5))
"""rad/s of rudder, where no record shows it: what a ship's gear does at least."""
MOVED: Final = 0.25
"""Share of the rudder's range that it is clocked over: 5 of the 20 deg of a zig-zag 10/10."""
OVER: Final = 0.9
"""Share of the range that a rudder goes over in one move, ordered from one angle to another."""
EVENLY: Final = 0.1
"""Share by which it may be slower over that: a ramp is by noise alone, a sine by 0.2. With half of
it a zig-zag 10/10 counts up to 0.1 deg of noise on the rudder's angle, with this up to 0.2."""
LONG: Final = 8
"""Samples from angle to angle from which the whole way is clocked: of 2.7 deg/s in 0.1 to 0.2 deg
of noise, logged once a second, 2.70 to 2.71 then, 2.77 to 2.84 by the quickest part. At half of it
5 deg/s, logged every 2 s, are 4.8; with twice of it those 2.7 have to be logged twice a second."""
SPIKE: Final = 3
"""Moves as quick that there have to be: a wild sample makes two."""


def gear_rate(trials: Iterable[Trial], angles: Sequence[str] = ("delta",)) -> float:
    """How fast a rudder goes over [rad/s]: as fast as in the trials, `GEAR` where none shows it.

    One that goes from angle to angle at one rate goes as fast as it can, however slow that is. One
    that is worked little by little, or is over from one sample to the next, may go faster. What a
    long way shows is better known than what a short one does, as far as these are not unlike.
    """
    clocked = [_clocked(t.signals[n], t.period) for t in trials for n in angles if n in t.signals]
    long = max((c.rate for c in clocked if c.long), default=0.0)
    short = max((c.rate for c in clocked), default=0.0)
    if long > 0.0 and short <= (1.0 + EVENLY) * long:
        return long
    return max(0.0 if any(c.even for c in clocked) else GEAR, short)


def rudder_rate(delta: Vector, period: float) -> float:
    """How fast a recorded rudder goes over [rad/s]: its quickest move by a part of its range.

    From one sample to the next noise moves it too, and the faster the log the more: one that goes
    evenly is clocked from angle to angle.

    >>> noisy = np.tile([0.0, 0.003], 50) + np.repeat([0.0, 0.2], 50).cumsum() / 50
    >>> round(rudder_rate(noisy, 0.1), 2)
    0.04
    """
    return _clocked(delta, period).rate


class _Clocked(NamedTuple):
    """How fast a rudder goes [rad/s], whether at one rate, and whether a long way shows it."""

    rate: float
    even: bool
    long: bool


def _clocked(delta: Vector, period: float) -> _Clocked:
    quick, whole = _quickest(delta, MOVED), _quickest(delta, OVER)
    even = quick.samples > 1 and whole.moved >= (1.0 - EVENLY) * quick.moved
    long = even and whole.samples >= LONG
    return _Clocked((whole if long else quick).moved / period, even, long)


class Move(NamedTuple):
    """The samples that a rudder's quickest move took, and by how much it moved in one [rad]."""

    samples: int
    moved: float


def _quickest(delta: Vector, share: float) -> Move:
    """The quickest move of a rudder by a share of its range."""
    far = share * float(np.ptp(delta))
    if far == 0.0:
        return Move(0, 0.0)
    for apart in range(1, len(delta)):
        quickest = np.sort(np.abs(delta[apart:] - delta[:-apart]))[-SPIKE:]
        if len(quickest) == SPIKE and quickest[0] >= far:
            return Move(apart, float(quickest[0]) / apart)
    return Move(0, 0.0)
