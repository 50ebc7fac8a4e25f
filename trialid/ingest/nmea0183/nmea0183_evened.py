"""Times by place in a log without stamps, as even as the sensor that sends the sentences."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]

ABOUT: Final = 5
"""Ticks to either side that a time is the mean of. Where a compass sends five times between two
sentences of a receiver and others come in between, its places are 0.1 and 0.2 s apart in turns: it
was called one of 10 Hz with a gap every second, and at its own 5 Hz nothing of it was usable. Now
they are 0.198 to 0.203 s apart, with half of it 0.198 to 0.206, with twice 0.199 to 0.201, but a
stretch of 20 s between two pauses is too short for that and stays as it is."""
PAUSE: Final = 3.0
"""Times as long as usual from one sentence to the next from which on a sensor paused: by place one
of five a second comes 0.5 to 1.7 times as late as usual, a second without it is 6. Half of it cuts
that where there is no pause and evens nothing, twice still finds the second."""
OFTEN: Final = 1.2
"""Sentences a tick; those that come as seldom as the receiver's lie where it says."""


def evenly(t: Ints, tick: int) -> Ints:
    """The times of one sensor's sentences, each the mean of those about it.

    As they are across a pause or a clock put back, where it sends no more often than the receiver,
    or would be moved by more than a tick: its sentences come in bursts then.

    Parameters
    ----------
    t
        Times by place [ns]; (N,).
    tick
        Usual time between two sentences that state one [ns].
    """
    step = np.diff(t)
    going = step[(step > 0) & (step <= 2 * tick)]
    usual = float(np.mean(going)) if len(going) else 0.0
    pauses = np.flatnonzero((step <= 0) | (step > PAUSE * usual)) + 1
    made = [_evened(part, tick) for part in np.split(t, pauses)]
    return np.concatenate(made) if made else t


def _evened(t: Ints, tick: int) -> Ints:
    often = (len(t) - 1) * tick / max(int(t[-1] - t[0]), 1) if len(t) > 1 else 0.0
    half = round(ABOUT * often)
    if often < OFTEN or len(t) <= 2 * half:
        return t
    away = (t - t[0]).astype(float)
    width = 2 * half + 1
    whole = np.cumsum(np.concatenate([[0.0], away]))
    means = (whole[width:] - whole[:-width]) / width
    before, after = (_on(away[part], half) for part in (slice(width), slice(-width, None)))
    made = np.concatenate([before[:half], means, after[-half:]])
    if np.any(np.abs(made - away) > tick) or np.any(np.diff(made) <= 0.0):
        return t
    return np.asarray(t[0] + np.rint(made).astype(np.int64))


def _on(away: NDArray[np.float64], half: int) -> NDArray[np.float64]:
    """The straight line through times about a middle: at an end no mean is about each."""
    k = np.arange(-half, half + 1)
    slope = float(k @ away) / float(k @ k)
    return np.asarray(away.mean() + slope * k)
