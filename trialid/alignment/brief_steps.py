"""Runs of any number of samples that a signal jumps to and back from, too briefly for a ship.

A lost target is logged as zeros for a while, a disturbance as a value off by the same for a while.
At 100 Hz that is a hundred samples; what tells it is the jump within one sample at either end, and
the time, not how many samples lie between. Every sample is looked at once, however long the runs.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.alignment.clocks import Series
from trialid.alignment.fault_samples import Fault, Samples, available_samples, resolution
from trialid.alignment.spikes import (
    MOST_SPIKES,
    MOST_ZEROS,
    PULSE_S,
    SHARP,
    SHARPER,
    WIDEST_DROPOUT,
    WIDEST_SPIKE,
    usual_size,
)
from trialid.arrays import Mask, Vector
from trialid.names.quantities import SIGNALS, is_input

STOPPED_S: Final = 2.5
"""[s] No ship loses all her speed in less: boats of a few metres take three lengths to stop from
full astern, models of a basin ten seconds. Half and twice mask the same of an outsider's logs."""
SHOWN: Final = 0.1
"""Share of a motion's span below which a display may show none. What is masked of those logs was
0.22 to 0.89 of it; half and twice mask the same."""
ORDER: Final = "delta_order"
"""What somebody may well set to zero, or anywhere, and back; so may a signal of one's own be."""


@dataclass(frozen=True)
class _Runs:
    """First and last place of runs in the samples; each has a sample on either side. (k,)."""

    first: np.ndarray
    last: np.ndarray

    def those(self, kept: Mask) -> "_Runs":
        return _Runs(self.first[kept], self.last[kept])

    def mask(self, n: int) -> Mask:
        """Where they lie among `n` samples."""
        edges = np.zeros(n + 1, np.int64)
        np.add.at(edges, self.first, 1)
        np.add.at(edges, self.last + 1, -1)
        return np.asarray(np.cumsum(edges[:n]) > 0)


def long_dropouts(series: Series, zero: float) -> Iterator[Fault]:
    """Exact zeros that a motion jumps to and from, or an input for less than a shaft can stop.

    However long: no ship stops within `STOPPED_S`, nor does one stop to turn or to heel so quickly.
    A display that shows small motions as none has zeros, too, from close by.
    """
    s = available_samples(series)
    null = np.isclose(series.y[s.at], zero, rtol=0.0, atol=1e-12)
    if not null.any() or null.mean() > MOST_ZEROS or _ordered(series):
        return
    runs = _runs(null)
    before, after = s.y[runs.first - 1], s.y[runs.last + 1]
    low, high = s.y[runs.first], s.y[runs.last]  # an angle's zero is a whole turn, or none
    jump = np.minimum(np.abs(before - low), np.abs(after - high))
    steps = np.abs(np.diff(s.y))[~(null[1:] | null[:-1])]
    far = max(SHARP * usual_size(steps[steps > 0.0]), 4.0 * resolution(s.y)) if steps.any() else 0.0
    found = (jump > far) & (far > 0.0)
    begins, ends = (np.diff(s.t)[at] for at in (runs.first - 1, runs.last))
    if is_input(series.quantity):
        found &= np.abs(after - before) < jump / 2
        found &= s.t[runs.last + 1] - s.t[runs.first - 1] <= PULSE_S
    else:
        found &= (np.maximum(begins, ends) < STOPPED_S) & ((before - low) * (after - high) > 0.0)
        found &= series.quantity.angle | (jump > SHOWN * np.ptp(s.y))
    found &= _whole(s, runs) & (runs.last - runs.first + 1 > WIDEST_DROPOUT)
    yield from _fault(series, s, runs.those(found), "dropouts", "dropped to zero", sure=True)


def long_spikes(series: Series, zero: float) -> Iterator[Fault]:
    """What jumps off the motion and back within a second, further than any other step."""
    s = available_samples(series)
    steps = np.diff(s.y)
    size = np.abs(steps)
    if _ordered(series) or not size.any():
        return
    sharp = np.flatnonzero(size > SHARP * usual_size(size[size > 0.0]))
    if not len(sharp) or len(sharp) > MOST_SPIKES * len(s.y):
        return
    runs = _there_and_back(steps, sharp)
    brief = s.t[runs.last + 1] - s.t[runs.first - 1] <= PULSE_S
    runs = runs.those(_whole(s, runs) & brief & (runs.last - runs.first + 1 > WIDEST_SPIKE))
    edges = np.minimum(size[runs.first - 1], size[runs.last])
    others = np.ones(len(size), np.bool_)
    others[runs.first - 1] = others[runs.last] = False
    rest = float(size[others].max(initial=0.0))
    runs = runs.those(edges > max(SHARPER * rest, 4.0 * resolution(s.y)))
    inside = runs.mask(len(s.y))
    if not inside.any() or inside.mean() > MOST_SPIKES:
        return
    further = np.abs(s.y[runs.first] - s.y[runs.first - 1]) > np.ptp(s.y[~inside])
    if not is_input(series.quantity):
        further[:] = True
    for some, sure in ((further, True), (~further, False)):
        yield from _fault(series, s, runs.those(some), "spikes", "out of line", sure=sure)


def _ordered(series: Series) -> bool:
    return series.quantity.name == ORDER or series.quantity.name not in SIGNALS


def _runs(null: Mask) -> _Runs:
    """Runs of what is marked, but for those at either end of the record."""
    edges = np.diff(null.astype(np.int8))
    first, last = np.flatnonzero(edges > 0) + 1, np.flatnonzero(edges < 0)
    last = last[last >= first[0]] if len(first) else last[:0]
    return _Runs(first[: len(last)], last)


def _whole(s: Samples, runs: _Runs) -> Mask:
    """Runs without a hole in them, or beside them."""
    holes = np.cumsum(~s.near)
    return np.asarray(holes[runs.last + 1] == holes[runs.first - 1])


def _there_and_back(steps: Vector, sharp: np.ndarray) -> _Runs:
    """Runs between two sharp steps, one after the other, of which the second takes back the first.

    From the left, each step of one run only.
    """
    there, back = steps[sharp[:-1]], steps[sharp[1:]]
    pairs = np.abs(there + back) < np.minimum(np.abs(there), np.abs(back)) / 2
    taken, end = np.zeros(len(pairs), np.bool_), -1
    for k in map(int, np.flatnonzero(pairs)):
        if k > end:
            taken[k], end = True, k + 1
    return _Runs(sharp[:-1][taken] + 1, sharp[1:][taken])


def _fault(
    series: Series, s: Samples, runs: _Runs, kind: str, words: str, *, sure: bool
) -> Iterator[Fault]:
    if len(runs.first):
        samples = np.zeros(len(series.y), np.bool_)
        samples[s.at[runs.mask(len(s.y))]] = True
        yield Fault(kind, words, samples, sure)
