"""Own clocks of the channels, and the one clock of the trial.

Stamps are whole nanoseconds; seconds appear only relative to the start of the trial, where a
float holds them to better than a nanosecond.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.errors import AlignmentError
from trialid.names.quantities import Quantity

FEWEST = 4
"""Samples below which nothing can be said about a signal."""
MOST = 10_000_000
"""Samples above which a wild stamp is the likelier explanation: it is a day at 100 Hz."""
LONGEST = 1e6
"""Duration [s] above which a wild stamp is likelier than a long trial: it is twelve days."""
EMPTIEST = 100
"""Times the samples of the fastest signal that a clock may have; with more a stamp is wild, ..."""
FEW = 100_000
"""... unless they are no more than this."""
CALENDAR_NS = 10**17
"""Stamps above this count from 1970 (it is 1973) and are shown as dates."""


@dataclass(frozen=True)
class Series:
    """One quantity in SI on its sensor's own clock.

    Parameters
    ----------
    quantity
        What it is.
    t
        Stamps [ns]; (N,).
    y
        Values, NaN or infinite where not available; (N,).
    clock
        Which clock the stamps are of, in words.
    received
        When the recorder got the samples [ns], where that is another time; (N,).
    """

    quantity: Quantity
    t: NDArray[np.int64]
    y: NDArray[np.float64]
    clock: str
    received: NDArray[np.int64] | None = None

    @property
    def period(self) -> float:
        """Median time between available values [s]; a table leaves slow channels empty between."""
        return float(np.median(np.diff(self.t[np.isfinite(self.y)]))) / 1e9


@dataclass(frozen=True)
class Grid:
    """The clock of the trial: `samples` stamps from `start` [ns], `period` [s] apart."""

    start: int
    period: float
    samples: int

    @property
    def t(self) -> NDArray[np.float64]:
        """Time from the start [s]; (samples,)."""
        return np.arange(self.samples, dtype=np.float64) * np.float64(self.period)

    def seconds(self, t: NDArray[np.int64]) -> NDArray[np.float64]:
        """Stamps [ns] as time from the start [s]."""
        return np.divide(t - self.start, 1e9, dtype=np.float64)


def in_time_order(series: Series) -> Series:
    """The same samples with stamps that only increase; of equal stamps the first logged stays."""
    order = np.argsort(series.t, kind="stable")
    t = series.t[order]
    new = np.diff(t, prepend=t[:1] - 1) > 0
    return Series(series.quantity, t[new], series.y[order][new], series.clock)


def check(series: Series, where: str) -> None:
    """AlignmentError when an ordered series is too short or has no value at all."""
    available = int(np.isfinite(series.y).sum())
    if len(series.t) and not available:
        raise AlignmentError(
            f"{where}: not one of {len(series.t)} values is available, all are NaN; "
            "the sensor was off, take another channel"
        )
    if available < FEWEST:
        raise AlignmentError(
            f"{where}: {available} values with distinct stamps, at least {FEWEST} are needed; "
            "take another channel"
        )


def common(
    series: Sequence[Series], period: float, window: tuple[float, float] | None, where: str
) -> Grid:
    """The grid from the latest first stamp to the earliest last one, or a window [s] of it."""
    if not (math.isfinite(period) and period > 0):
        raise AlignmentError(f"{where}: period = {period} s; it must be above zero, as in 0.5")
    first = max(series, key=lambda one: int(one.t[0]))
    last = min(series, key=lambda one: int(one.t[-1]))
    start, end = int(first.t[0]), int(last.t[-1])
    if start >= end:
        raise AlignmentError(
            f"{where}: {first.quantity.name} ({_interval(first)}) and {last.quantity.name} "
            f"({_interval(last)}) do not overlap in time; use logs of one trial, or say how far a "
            "log's clock is ahead [s]: clock = { offset = ... } beside its path"
        )
    opening, duration = _cut((end - start) / 1e9, window, where)
    samples = math.floor(duration / period + 1e-6) + 1
    logged = max(len(one.t) for one in series)
    _check_count(samples, logged, duration, period, (start, end), where)
    return Grid(start + round(opening * 1e9), period, samples)


def _check_count(
    samples: int, logged: int, duration: float, period: float, ends: tuple[int, int], where: str
) -> None:
    if samples < FEWEST:
        raise AlignmentError(
            f"{where}: {duration:.6g} s hold {samples} samples {period:.6g} s apart, at least "
            f"{FEWEST} are needed; choose a shorter period or a longer window"
        )
    if samples > MOST and duration < LONGEST:
        raise AlignmentError(
            f"{where}: {duration:.6g} s hold {samples} samples at period = {period:.6g} s, at most "
            f"{MOST} are taken; choose a longer period"
        )
    if samples > min(MOST, max(EMPTIEST * logged, FEW)):
        raise AlignmentError(
            f"{where}: the channels seem to last {duration:.4g} s, {moment(ends[0])} to "
            f"{moment(ends[1])}; a stamp is wild: cut the log, or choose a window"
        )


def _cut(duration: float, window: tuple[float, float] | None, where: str) -> tuple[float, float]:
    """Start within the common time and duration [s]; a window may reach past the end."""
    if window is None:
        return 0.0, duration
    opening, closing = window
    if not 0.0 <= opening < min(closing, duration):
        raise AlignmentError(
            f"{where}: window = [{opening:.6g}, {closing:.6g}] s; it must begin before it ends, "
            f"and lie in the {duration:.6g} s that all channels cover"
        )
    return opening, min(closing, duration) - opening


def _interval(series: Series) -> str:
    return f"{moment(int(series.t[0]))} to {moment(int(series.t[-1]))}"


def moment(stamp: int) -> str:
    """A stamp [ns] in words: a date when it counts from 1970, else seconds.

    >>> moment(1_700_000_000_250_000_000), moment(12_500_000_000)
    ('2023-11-14T22:13:20.250', '12.500 s')
    """
    if stamp < CALENDAR_NS:
        return f"{stamp / 1e9:.3f} s"
    return str(np.datetime64(stamp, "ns").astype("datetime64[ms]"))
