"""How fast a ship's rudder goes over, from how it went over in her trials."""

import itertools
from collections.abc import Iterable, Iterator, Sequence
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
it zig-zags 10/10 count in up to 0.05 deg of noise on the rudder's angle, with this in up to 0.1 and
16 of 40 in 0.2, with twice all of these, and one of 20 sines."""
MOVE: Final = 0.5
"""Share of its range that a rudder goes from where it turns to where it turns again, to be clocked
from angle to angle; at half of it, and at 0.9, those of a zig-zag are the same ones."""
ENDS: Final = 0.15
"""Share of such a move at either end that is not clocked, and one sample at least: there it starts
and stops between two samples. 2.3 to 8 deg/s of zig-zags of 10 to 20 deg, in up to 0.2 deg of noise
and logged each 0.1 to 2 s, are 0.982 to 1.014 of themselves so, with half of it too, and 0.974 to
1.017 with twice."""
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
    """How fast a recorded rudder goes over [rad/s]: in the middle of its moves, if they are even.

    Where these are over within a sample or two, or it was worked little by little, its quickest
    move by a part of its range counts.

    >>> noisy = np.tile([0.0, 0.003], 50) + np.repeat([0.0, 0.2], 50).cumsum() / 50
    >>> round(rudder_rate(noisy, 0.1), 2)
    0.04
    """
    return _clocked(delta, period).rate


class _Clocked(NamedTuple):
    """How fast a rudder goes [rad/s], whether at one rate, and by the middle of its moves."""

    rate: float
    even: bool
    long: bool


def _clocked(delta: Vector, period: float) -> _Clocked:
    quick, whole = _quickest(delta, MOVED), _quickest(delta, OVER)
    evenly = OVER * float(np.ptp(delta)) / whole.spent
    even = quick.samples > 1 and whole.samples > 0 and evenly >= (1.0 - EVENLY) * quick.moved
    slopes = [_slope(y) for y in _middles(delta) if len(y) > 1] if even else []
    return _Clocked(
        float(np.median(slopes) if slopes else quick.moved) / period, even, bool(slopes)
    )


def _middles(delta: Vector) -> Iterator[Vector]:
    """The middle of each move by `MOVE` of the rudder's range, as far as it has gone then."""
    turns = _turns(delta, MOVE * float(np.ptp(delta)))
    for first, last in itertools.pairwise(turns):
        gone = np.abs(delta[first : last + 1] - delta[first]) / abs(delta[last] - delta[first])
        ends = max(ENDS, 0.8 / max(len(_between(gone, 0.1)), 1))
        yield _between(gone, ends) * abs(delta[last] - delta[first])


def _between(gone: Vector, ends: float) -> Vector:
    """What of a move lies between its ends, each of which is a share of it."""
    last = int(np.argmax(gone >= 1.0 - ends))
    return gone[int(np.flatnonzero(gone[: last + 1] <= ends)[-1]) + 1 : last]


def _turns(delta: Vector, least: float) -> list[int]:
    """The samples at which a rudder turns that then goes at least so far the other way."""
    turns, furthest, way = list[int](), [0, 0], 0
    for i, angle in enumerate(delta.tolist()):
        furthest = [
            i if sign * angle > sign * delta[at] else at
            for sign, at in zip((1, -1), furthest, strict=True)
        ]
        for sign, at in zip((1, -1), furthest, strict=True):
            if way in (0, sign) and sign * (delta[at] - angle) >= least:
                turns.append(at)
                way, furthest = -sign, [i, i]
                break
    return [*turns, furthest[way < 0]] if turns else []


def _slope(y: Vector) -> float:
    """By how much equally spaced values rise from one to the next, by least squares."""
    k = np.arange(len(y)) - 0.5 * (len(y) - 1)
    return float(k @ y / (k @ k))


class Move(NamedTuple):
    """The samples that a rudder's quickest move took, and by how much it moved in one [rad].

    `spent` are the samples between which it got just so far, a part of one among them.
    """

    samples: int
    moved: float
    spent: float


def _quickest(delta: Vector, share: float) -> Move:
    """The quickest move of a rudder by a share of its range."""
    far, before = share * float(np.ptp(delta)), 0.0
    for apart in range(1, len(delta) - SPIKE + 1) if far > 0.0 else ():
        moved = float(np.partition(np.abs(delta[apart:] - delta[:-apart]), -SPIKE)[-SPIKE])
        if moved >= far:
            return Move(apart, moved / apart, apart - (moved - far) / (moved - before))
        before = moved
    return Move(0, 0.0, 1.0)
