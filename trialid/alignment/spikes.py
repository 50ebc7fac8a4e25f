"""Spikes and dropouts: short runs that leave the motion and come back to it.

A spike leaves the motion and comes back within three samples, further than anything else in the
record bends: it is judged against the motion's own smoothness, so that a rudder step (which does
not come back), a coarse resolution (which jumps as far all the time) or noise (likewise) is none.
Short runs of exact zeros are judged in the same way.
"""

from collections.abc import Iterator

import numpy as np

from trialid.alignment.clocks import Series
from trialid.alignment.fault_samples import Fault, Samples, available_samples, resolution
from trialid.arrays import Mask, Vector
from trialid.names.quantities import RUDDERS, is_input

WIDEST_SPIKE = 3
WIDEST_DROPOUT = 10
"""Samples; what lasts longer is a motion, or a sensor that is off."""
SHARPER = 2.5
"""A spike leaves the line between its neighbours by so many times the largest bend elsewhere: a
step bends by half its height, so a one-sample pulse as high as the record's own steps is none."""
SHARP = 8.0
"""And by so many times the usual bend."""
MOST_SPIKES = 0.05
"""Share of spikes above which they are the signal's own way."""
RARE = 0.1
"""Share of bends that spikes may be of, three of each spike: one sample in 50 is a spike in logs
where `no fit: she never moves` was said. Of 3 984 channels of logs half of it misses those; twice
finds others in four real ones, of which it loses two."""
MOST_ZEROS = 0.1
"""And of zeros, which are no motion however many."""
PULSE_S = 1.0
"""[s] No shaft stops and turns again in less, and no rudder goes there and back through zero."""
STEERED = np.deg2rad(60.0)
"""[rad/s] No steering gear of a ship or yacht moves as fast."""


def _bends(s: Samples, width: int) -> Vector:
    """How far each run of `width` samples lies off the line between the samples beside it.

    To either side, as two spikes beside each other may; zero at a gap; (n - width - 1,), the run
    that begins at the second sample first.
    """
    n = len(s.y) - width - 1
    left, right = s.y[:n], s.y[width + 1 :]
    least = np.full(n, np.inf)
    whole = s.near[width + 1 :].copy()
    for k in range(1, width + 1):
        off = s.y[k : n + k] - left - (right - left) * (k / (width + 1))
        least = np.minimum(least, np.abs(off))
        whole &= s.near[k : n + k]
    return np.where(whole, least, 0.0)


def _found(s: Samples, widest: int, only: Mask | None = None) -> tuple[Mask, Mask]:
    """Samples of runs up to `widest` that stand out of the motion and come back to it.

    Second result: those that lie beyond all the rest by more than the rest spans. `only` restricts
    the runs to samples of this kind.
    """
    out = np.zeros(len(s.y), np.bool_)
    if len(s.y) < 2 * widest + 4:
        return out, out
    bends = [_bends(s, width) for width in range(1, widest + 1)]
    size = np.zeros(len(s.y))
    for width, bend in enumerate(bends, 1):
        for i in np.flatnonzero(_returns(s, width, bend) & (bend > SHARP * usual_size(bend))):
            run = slice(i + 1, i + 1 + width)
            if only is None or bool(np.all(only[run])):
                size[run] = np.maximum(size[run], bend[i])
    candidates = size > 0
    if not candidates.any() or candidates.mean() > (MOST_SPIKES if only is None else MOST_ZEROS):
        return out, out
    beside = candidates | np.roll(candidates, 1) | np.roll(candidates, -1)
    rest = max(_outside(bend, beside, width) for width, bend in enumerate(bends, 1))
    found = size > max(SHARPER * rest, 4 * resolution(s.y[~candidates]))
    high = float(np.ptp(s.y[~beside])) if not beside.all() else np.inf
    return found, found & (size > high) & (high > 0)


def _returns(s: Samples, width: int, bend: Vector) -> Mask:
    """True where the samples on both sides of the run agree better than the run with them."""
    n = len(bend)
    return np.abs(s.y[width + 1 :] - s.y[:n]) < bend / 2


def usual_size(bend: Vector) -> float:
    """What is usual of what is mostly small: of noise, or half of what the rare ones exceed."""
    return max(1.4826 * float(np.median(bend)), float(np.quantile(bend, 1.0 - RARE)) / 2)


def _outside(bend: Vector, beside: Mask, width: int) -> float:
    """The largest bend of runs that touch no candidate."""
    n = len(bend)
    touches = np.any(np.stack([beside[k : n + k] for k in range(width + 2)]), axis=0)
    return float(bend[~touches].max(initial=0.0))


def spikes(series: Series, zero: float) -> Iterator[Fault]:
    """Values out of line with the motion on both sides; `zero` plays no part."""
    s = available_samples(series)
    found, outside = _found(s, WIDEST_SPIKE)
    yield from _judged(series, s, found, outside, "spikes", "out of line")


def dropouts(series: Series, zero: float) -> Iterator[Fault]:
    """Short runs of exact zeros in a signal that is far from zero on both sides."""
    s = available_samples(series)
    null = np.isclose(series.y[s.at], zero, rtol=0.0, atol=1e-12)
    found, outside = _found(s, WIDEST_DROPOUT, null) if null.any() else (null, null)
    yield from _judged(series, s, found, outside, "dropouts", "dropped to zero")


def _judged(
    series: Series, s: Samples, found: Mask, outside: Mask, kind: str, words: str
) -> Iterator[Fault]:
    """A motion's are sure; an input's where it is too quick or too far for one."""
    if not found.any():
        return
    sure = found
    if is_input(series.quantity):
        brief = (WIDEST_SPIKE + 1) * series.period < PULSE_S and kind == "dropouts"
        sure = found & (outside | brief | _too_quick(series, s))
    for part, certain in ((sure, True), (found & ~sure, False)):
        if part.any():
            samples = np.zeros(len(series.y), np.bool_)
            samples[s.at[part]] = True
            yield Fault(kind, words, samples, certain)


def _too_quick(series: Series, s: Samples) -> Mask:
    """Rudder angles that no gear could have reached in time."""
    if series.quantity.name not in RUDDERS:
        return np.zeros(len(s.y), np.bool_)
    pace = np.zeros(len(s.y))
    pace[1:] = np.abs(np.diff(s.y)) / np.diff(s.t)
    back = np.append(pace[1:], 0.0)
    return np.asarray(np.maximum(pace, back) > STEERED)
