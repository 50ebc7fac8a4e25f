"""Which sample of an evenly paced sensor a message is: the count behind stamps that are not even.

Stamps less the period times the number of the message are level where the sensor is even. A lost
message lifts the level by one period for good, one delivered twice lowers it; jitter moves single
samples and comes back, and so do messages that are stamped together. So the level is what a running
median leaves, and its steps, rounded to whole periods, are the losses. The phase against which they
are rounded is a circular mean of blocks, which no whole period changes and which follows a drift.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Index = NDArray[np.int64]
Bundled = Literal["last", "first", ""]

LAGS = (1, 3, 10, 30, 100, 300)
"""Distances in messages over which the period is looked for."""
WIDTHS = (1, 5, 11, 21, 51, 101)
"""Lengths of the running median to choose from."""
SINGLE = 0.15
"""Jitter [periods] at which whole periods are told from single stamps, ..."""
LEVEL = 0.12
"""... and of a running median."""
BLOCK = 32
"""Messages of a circular mean at least."""
FAINT = 0.1
"""Length of a mean direction that may be chance."""
CHUNK = 4000
"""Messages on which a period is tried."""
QUANTA = (60.0, 1.0, 0.5, 0.1, 0.05, 0.01)
"""Steps [s] that stamps are cut to."""
WHOLE = 1e-4
"""Rounding of a stamp in such steps."""
TOGETHER = 0.1
"""Messages nearer than this share of the mean pace are stamped together ..."""
BUNDLED = 0.3
"""... and the log is counted by bundles where this share of the messages is."""


@dataclass(frozen=True)
class Count:
    """Messages numbered by the sensor's own samples.

    Parameters
    ----------
    period
        Time between samples [s].
    n
        Number of each message's sample; lost ones are counted, one delivered twice has one number;
        (N,).
    marks
        Messages that were counted: of those stamped together one; (M,).
    bundled
        Which of the messages that are stamped together is counted, `last` or `first`; else empty.
    misfit
        Root mean square distance of the level from whole periods [periods]; 0.29 by chance.
    jumps
        Share of the marks after which the count jumps.
    width
        Marks in the running median.
    """

    period: float
    n: Index
    marks: Index
    bundled: Bundled
    misfit: float
    jumps: float
    width: int


@dataclass(frozen=True)
class _Levels:
    period: float
    k: Index
    misfit: float
    width: int

    @property
    def jumps(self) -> float:
        return float(np.mean(np.diff(self.k) != 0)) if len(self.k) > 1 else 0.0

    @property
    def score(self) -> float:
        return 4.0 * self.misfit + self.jumps


def number_messages(t: Vector) -> Count:
    """Number the messages of stamps [s] in the order of the log; (N,), at least a dozen."""
    marks, bundled = _marks(t)
    some = marks[_middle(marks)]
    period = min(_periods(t, some), key=lambda period: _levels(t, some, period).score)
    levels = _levels(t, marks, period)
    side: Literal["left", "right"] = "left" if bundled == "last" else "right"
    own = np.searchsorted(marks, np.arange(len(t)), side=side) - (side == "right")
    n = np.arange(len(t)) + levels.k[np.clip(own, 0, len(marks) - 1)]
    return Count(
        period=levels.period,
        n=n - n[0],
        marks=marks,
        bundled=bundled,
        misfit=levels.misfit,
        jumps=levels.jumps,
        width=levels.width,
    )


def pace(t: Vector) -> float:
    """Time between messages [s] over long distances, where gaps and bundles do not show."""
    lag = max(1, min(100, len(t) // 4))
    return float(np.median(t[lag:] - t[:-lag])) / lag


def quantum(t: Vector) -> float:
    """The longest usual step [s] that all stamps are whole numbers of, from the first; 0 if none.

    >>> quantum(np.array([5.0, 5.0, 6.0, 8.0])), quantum(np.array([0.0, 0.1003]))
    (1.0, 0.0)
    """
    parts = ((t - t[0]) / step for step in QUANTA)
    whole = (bool(np.all(np.abs(part - np.rint(part)) < WHOLE)) for part in parts)
    return next((step for step, is_whole in zip(QUANTA, whole, strict=True) if is_whole), 0.0)


def _marks(t: Vector) -> tuple[Index, Bundled]:
    """The messages to count by, and which one of those that are stamped together.

    A bundle is delivered when its last sample is there, and a tick of a coarse clock is nearest to
    the first sample after it.
    """
    apart = np.abs(np.diff(t)) > TOGETHER * pace(t)
    if 1.0 - apart.mean() < BUNDLED or apart.sum() < BLOCK:
        return np.arange(len(t)), ""
    breaks = np.flatnonzero(apart)
    if quantum(t) > 0:
        return np.concatenate([[0], breaks + 1]), "first"
    return np.concatenate([breaks, [len(t) - 1]]), "last"


def _middle(marks: Index) -> slice:
    spare = max(0, (len(marks) - CHUNK) // 2)
    return slice(spare, spare + CHUNK)


def _periods(t: Vector, some: Index) -> list[float]:
    """Periods [s] that may be the sensor's: one from each distance, then all made sharper.

    A loss lengthens a plain median over long distances and jitter blurs it over short ones.
    """
    lags = [lag for lag in LAGS if lag < max(2, len(some) // 2)]
    found = []
    for place, lag in enumerate(lags):
        period = float(np.median((t[some[lag:]] - t[some[:-lag]]) / (some[lag:] - some[:-lag])))
        if period > 0:
            found += [period, _sharper(t, some, period, lags[place:])]
    return found or [max(pace(t), 1e-9)]


def _sharper(t: Vector, marks: Index, period: float, lags: list[int]) -> float:
    """The period after whole ones are taken off longer and longer distances by circular means."""
    level, _ = _smooth(t[marks] / period - marks)
    slope = 0.0
    for lag in lags:
        over = level[lag:] - level[:-lag]
        ahead = marks[lag:] - marks[:-lag]
        mean = np.mean(np.exp(2j * np.pi * (over - slope * ahead)))
        if abs(mean) > FAINT:
            slope += float(np.angle(mean)) / (2 * np.pi) / float(np.mean(ahead))
    return period * (1.0 + slope)


def _smooth(x: Vector) -> tuple[Vector, int]:
    """The running median of least length that tells whole numbers apart, and its length."""
    from scipy.ndimage import median_filter

    spread = 1.4826 * float(np.median(np.abs(np.diff(x)))) / np.sqrt(2.0)
    widths = [w for w in WIDTHS if 4 * w <= len(x)] or [1]
    width = next(
        (w for w in widths if spread * (1.0 if w == 1 else 1.25 / np.sqrt(w)) <= LEVEL), widths[-1]
    )
    return (x if width == 1 else median_filter(x, width, mode="nearest")), width


def _levels(t: Vector, marks: Index, period: float) -> _Levels:
    """Whole periods by which each mark is behind an unbroken count; (M,)."""
    x = t[marks] / period - marks
    level, width = _smooth(x)
    phase, slope = _phase(level, max(BLOCK, 4 * width))
    k = np.rint(level - phase).astype(np.int64)
    misfit = float(np.sqrt(np.mean((level - phase - k) ** 2)))
    k = _sharpened(k, x - phase, width) if width > 1 else _without_odd(k)
    per_message = slope * (len(x) - 1) / max(1, int(marks[-1] - marks[0]))
    return _Levels(period * (1.0 + per_message), k, misfit, width)


def _phase(level: Vector, block: int) -> tuple[Vector, float]:
    """What a level is beside whole numbers, followed slowly; (M,), and its slope for each mark."""
    count = max(1, len(level) // block)
    edges = np.linspace(0, len(level), count + 1).astype(np.int64)
    turns = np.add.reduceat(np.exp(2j * np.pi * level), edges[:-1])
    phases = np.unwrap(np.angle(turns) / (2 * np.pi), period=1.0)
    if count == 1:
        return np.full(len(level), phases[0]), 0.0
    centres = (edges[1:] + edges[:-1] - 1) / 2
    at = np.arange(len(level), dtype=np.float64)
    followed = np.interp(at, centres, phases)
    for here, a, b in ((at < centres[0], 0, 1), (at > centres[-1], -2, -1)):
        slope = (phases[b] - phases[a]) / (centres[b] - centres[a])
        followed[here] = phases[a] + slope * (at[here] - centres[a])
    return followed, float((phases[-1] - phases[0]) / (centres[-1] - centres[0]))


def _without_odd(k: Index) -> Index:
    """Single stamps that are odd take the count of their neighbours; a loss lasts."""
    if len(k) < 3:
        return k
    middle = np.median([k[:-2], k[1:-1], k[2:]], axis=0).astype(np.int64)
    return np.concatenate([k[:1], middle, k[-1:]])


def _sharpened(k: Index, x: Vector, width: int) -> Index:
    """Each step of the level put where it fits the samples best, which a median blurs."""
    k = k.copy()
    at = np.flatnonzero(np.diff(k)) + 1
    if not len(at):
        return k
    events = np.split(at, np.flatnonzero(np.diff(at) > width // 2) + 1)
    opening = [0, *(int(event[-1]) for event in events[:-1])]
    closing = [*(int(event[0]) for event in events[1:]), len(k)]
    for event, low, high in zip(events, opening, closing, strict=True):
        begin, end = max(low, int(event[0]) - width), min(high, int(event[-1]) + width)
        before, after = k[event[0] - 1], k[event[-1]]
        gain = np.abs(x[begin:end] - before) - np.abs(x[begin:end] - after)
        cut = begin + int(np.argmin(np.concatenate([[0.0], np.cumsum(gain)])))
        k[begin:cut], k[cut:end] = before, after
    return k
