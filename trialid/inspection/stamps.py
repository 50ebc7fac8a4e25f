"""The health of a channel's stamps: rate, gaps, jitter, steps back, the recorder's clock."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.resample import GAP_PERIODS
from trialid.inspection.inspected import Clock, Gaps, Received

Stamps = NDArray[np.int64]


@dataclass(frozen=True)
class Health:
    """What the stamps of one channel say; `order` sorts them, None where they are sorted.

    `start` and `end` are the first and the last in time [ns].
    """

    start: int
    end: int
    period: float
    gaps: Gaps
    clock: Clock
    order: NDArray[np.intp] | None


def health(t: Stamps, words: str, received: Stamps | None) -> Health:
    """The health of stamps in the order of the log [ns]; (N,), N > 0."""
    steps = np.diff(t)
    back = steps[steps < 0]
    order = np.argsort(t, kind="stable") if len(back) else None
    first, last = (0, -1) if order is None else order[[0, -1]].tolist()
    forward = steps if order is None else np.diff(t[order])
    new = forward[forward > 0]
    period = float(np.median(new)) / 1e9 if len(new) else 0.0
    seconds = new / 1e9
    clock = Clock(
        words=words,
        jitter=_jitter(seconds, period),
        steps_back=len(back),
        furthest_back=float(-back.min()) / 1e9 if len(back) else 0.0,
        same=len(forward) - len(new),
        received=None if received is None else compare_clocks(t, received),
    )
    return Health(int(t[first]), int(t[last]), period, gaps(seconds, period), clock, order)


def gaps(steps: NDArray[np.float64], period: float) -> Gaps:
    """Steps [s] so long that the motion between is not known; alignment masks the same ones.

    >>> gaps(np.array([0.1, 0.1, 5.0, 0.1]), 0.1)
    Gaps(count=1, total=5.0, longest=5.0)
    """
    holes = steps[steps > GAP_PERIODS * period * (1 + 1e-6)]
    if not len(holes):
        return Gaps()
    return Gaps(len(holes), float(holes.sum()), float(holes.max()))


def _jitter(steps: NDArray[np.float64], period: float) -> float:
    near = steps[steps < GAP_PERIODS * period]
    return float(np.std(near)) if len(near) else 0.0


def compare_clocks(t: Stamps, received: Stamps) -> Received | None:
    """The recorder's clock against the channel's own, by a straight line; None below ten samples.

    >>> t = np.arange(0, 10**12, 10**9)
    >>> compare_clocks(t, t + 2 * 10**9)
    Received(offset=2.0, drift=0.0, jitter=0.0)
    """
    if len(t) < 10:
        return None
    if t.min() == t.max():
        return None
    late = (received - t) / 1e9
    centred = (t - t[0]) / 1e9
    centred -= centred.mean()
    left = late - late.mean()
    drift = float(centred @ left / (centred @ centred))
    centred *= drift
    left -= centred
    left *= left
    return Received(float(np.median(late)), drift, float(np.sqrt(np.mean(left))))
