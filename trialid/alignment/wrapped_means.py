"""Headings that an interpolation made of both sides of north: 180 between 359 and 1.

A log that is brought onto another clock number by number goes through the whole circle where the
heading passes north, or 180 deg. What lies there is no heading, and no motion: it goes the long way
round against how she turns, in equal steps, within less time than she needs for a small part of it.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.clocks import Series
from trialid.alignment.fault_samples import Fault
from trialid.arrays import Mask, Vector

Places = NDArray[np.int64]

WIDEST: Final = 50
"""Samples on one way round: what is interpolated further apart shows no turn."""
LEAST: Final = np.deg2rad(3.0)
"""[rad] What lies so near her way is left: a compass is no surer."""
KEPT: Final = 0.9
"""Share of the steps that keep to her pace; what lies on the way round is among the others. Of 2802
values that means and interpolations of 600 drawn headings left there, of 0.3 to 8 deg/s and a
minute or more, 275 are missed, 958 with 0.95; with 0.8 some of a boat that spins would be taken.
"""
FASTER: Final = 3.0
"""Times that pace to which a ship may turn there: 268 are missed with half, 375 with twice."""
SLOW: Final = np.pi / 4.0
"""[rad] What she turns meanwhile at that pace, at most: else a whole turn may be hers. 396 are
missed with half of it, 268 with twice; of 1.1 million values of headings as logged, of boats that
turn a little or spin, none is taken."""
EVEN: Final = 0.1
"""Share of a step by which those between the first and the last differ."""


def wrapped_means(series: Series, zero: float) -> Iterator[Fault]:
    """Values between both ends of the circle; `zero` plays no part."""
    at = np.flatnonzero(np.isfinite(series.y))
    if not series.quantity.angle:
        return
    found = on_the_long_way(series.y[at])
    if found.any():
        samples = np.zeros(len(series.y), np.bool_)
        samples[at[found]] = True
        yield Fault("spikes", "interpolated the long way round", samples, True)


def on_the_long_way(y: Vector) -> Mask:
    """Which samples lie on the long way round, of an angle [rad] in the order of time; (n,)."""
    if np.ptp(y) < 2.0 * np.pi - SLOW:
        return np.zeros(len(y), np.bool_)
    steps = np.diff(y)
    pace = float(np.quantile(np.abs(_turned(steps)), KEPT))
    out, near = np.zeros(len(y), np.bool_), _before_long_steps(steps)
    at_once = np.flatnonzero(np.abs(steps) > 2.0 * np.pi - LEAST - FASTER * pace)  # nothing between
    for between in range(1, WIDEST + 1):
        allowed = LEAST + FASTER * pace * (between + 1)
        if allowed > SLOW:
            break
        first = near[near < len(y) - between - 1]
        first = first[~_holds_any(first, first + between, at_once)]
        total = np.abs(y[first + between + 1] - y[first])
        for i in map(int, first[np.abs(total - 2.0 * np.pi) < allowed]):
            run = steps[i : i + between + 1]
            inside = slice(i + 1, i + 1 + between)
            if _is_straight(run) and np.any(_off(y, i, between) > allowed):
                out[inside] = True
    return out


def _before_long_steps(steps: Vector) -> Places:
    """Samples from which a way round may begin: of its steps the longest has its share at least."""
    long = np.flatnonzero(np.abs(steps) > (2.0 * np.pi - SLOW) / (WIDEST + 1))
    near = np.zeros(len(steps), np.bool_)
    for back in range(WIDEST + 1):
        near[np.maximum(long - back, 0)] = True
    return np.flatnonzero(near)


def _holds_any(first: Places, last: Places, of: Places) -> Mask:
    """Whether any of these places lies from the first to the last; (n,)."""
    return np.asarray(np.searchsorted(of, first) < np.searchsorted(of, last, side="right"))


def _turned(angles: Vector) -> Vector:
    """Differences of angles the short way, from -pi to pi."""
    return np.asarray((angles + np.pi) % (2.0 * np.pi) - np.pi)


def _is_straight(run: Vector) -> bool:
    """Whether all steps go one way, and those that are whole ones are alike."""
    whole = run[1:-1]
    one_way = bool(np.all(run > 0.0) or np.all(run < 0.0))
    return one_way and (len(whole) < 2 or float(np.ptp(whole)) <= EVEN * abs(float(np.mean(whole))))


def _off(y: Vector, first: int, between: int) -> Vector:
    """How far samples lie off the short way from the one before them to the one behind."""
    last = first + between + 1
    share = np.arange(1, between + 1) / (between + 1)
    short = y[first] + share * _turned(y[last : last + 1] - y[first])
    return np.abs(_turned(y[first + 1 : last] - short))
