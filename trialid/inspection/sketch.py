"""A channel's course in few points: enough to relate it to others, however long the log is."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.wrapped_means import on_the_long_way

Vector = NDArray[np.float64]

POINTS: Final = 4000
"""Most points of a sketch: half a second each of a trial of half an hour."""


@dataclass(frozen=True)
class Sketch:
    """Means over stretches of equal sample count: stamps [ns] and values; (n,), n <= POINTS."""

    t: NDArray[np.int64]
    y: Vector


EMPTIEST: Final = 100
"""Times the points of a sketch that a common clock may have; with more a stamp is wild."""
EMPTY: Final = Sketch(np.empty(0, np.int64), np.empty(0))


def sketch(t: NDArray[np.int64], y: Vector, turn: float | None = None) -> Sketch:
    """The sketch of finite values whose stamps [ns] increase; `turn` is a whole turn of an angle.

    What an interpolation made of both ends of the circle is left out.

    >>> sketch(np.array([0, 10, 20]), np.array([1.0, 2.0, 4.0])).y.tolist()
    [1.0, 2.0, 4.0]
    """
    if turn is not None and len(y):
        kept = ~on_the_long_way(y * (2.0 * np.pi / turn))
        t, y = t[kept], y[kept]
    if turn is not None and np.abs(np.diff(y)).max(initial=0.0) >= turn / 2:
        y = np.unwrap(y, period=turn)
    t = _spread(t)
    size = -(-len(t) // POINTS)
    if size <= 1:
        return Sketch(t.copy(), y.copy())
    whole = len(t) // size * size
    mean = y[:whole].reshape(-1, size).mean(axis=1)
    middle = t[:whole].reshape(-1, size)
    return Sketch(middle[:, 0] + (middle[:, -1] - middle[:, 0]) // 2, mean)


def _spread(t: NDArray[np.int64]) -> NDArray[np.int64]:
    """Stamps cut to the second, say, which many samples share, evenly up to the next one.

    >>> _spread(np.array([0, 0, 10, 10])).tolist(), _spread(np.array([0, 10, 20])).tolist()
    ([0, 5, 10, 15], [0, 10, 20])
    """
    first = np.flatnonzero(np.diff(t, prepend=t[:1] - 1))
    if len(first) == len(t) or len(first) < 2:
        return t
    steps = np.diff(t[first])
    count = np.diff(first, append=len(t))
    places = np.arange(len(t)) - np.repeat(first, count)
    step = np.append(steps, steps[-1])
    return np.asarray(t + np.repeat(step, count) * places // np.repeat(count, count))


def join_sketches(parts: list[Sketch]) -> Sketch:
    """Sketches that follow one another as one."""
    t = np.concatenate([part.t for part in parts])
    order = np.argsort(t, kind="stable")
    y = np.concatenate([part.y for part in parts])[order]
    return sketch(t[order], y)


def on_one_clock(*sketches: Sketch) -> tuple[float, list[Vector], NDArray[np.bool_]] | None:
    """The sketches on one even clock: its period [s], the values, where none has a hole.

    None when they have too little in common, or nearly all of it lies between two samples.
    """
    if min(len(one.t) for one in sketches) < 2:
        return None
    start = max(int(one.t[0]) for one in sketches)
    end = min(int(one.t[-1]) for one in sketches)
    step = max(float(np.median(np.diff(one.t))) for one in sketches)
    most = EMPTIEST * max(len(one.t) for one in sketches)
    if step <= 0 or not 40 * step <= end - start <= most * step:
        return None
    at = np.arange(start, end, step)
    values = [np.interp(at, one.t.astype(float), one.y) for one in sketches]
    whole = np.ones(len(at), np.bool_)
    for one in sketches:
        following = np.clip(np.searchsorted(one.t, at), 1, len(one.t) - 1)
        whole &= one.t[following] - one.t[following - 1] <= 3 * step
    return step / 1e9, values, whole
