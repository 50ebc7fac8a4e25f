"""What was noticed about the samples of a signal, in words for the report."""

from collections.abc import Iterator, Sequence

import numpy as np

from trialid.alignment.clocks import Grid, Series
from trialid.alignment.fault_samples import resolution
from trialid.alignment.resample import (
    CUT_OFF,
    HALF_LENGTH,
    any_faster,
    available,
    faster,
    longest_step,
    stretches,
)
from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError
from trialid.names import units, wording
from trialid.names.quantities import MOTIONS

JITTER = 0.2
"""Spread of the time between samples, as a share of it, that is worth a remark."""
COARSE = 0.02
"""Share of its motion that the rounding of a signal may be without a remark."""
HOUR_S, ABOUT_S = 3600.0, 10.0
"""A clock that steps back by an hour, about, was set: a recorder that loses time does by chance."""
STUCK_S = 10.0
STUCK_SHARE = 0.1
"""A motion that does not change for so long, and for this share of the trial, is worth a remark."""

RESTLESS = 0.3
"""Share of the samples beside that time at which a rudder turns back; noise does at two of three.
Of 1680 logged rudders two are told, made to freeze for 80 of 500 s; at half and twice the same."""

IN_TURN = 0.25
"""Of a sample's distance from the mean of its neighbours, what it is at most from those `TURN` away
where senders take turns in a channel; noise alone gives 1, motion more. Of 8 640 channels of 841
logs two are below it that move by what is felt: two compasses of a boat, 0.00, and what a fit left
of 42 positions, 0.20. At half of it the compasses alone; at twice that track, 0.25, and heading
and position of a boat of 1.5 m, 0.36 to 0.50."""
TURN = (2, 3, 4)
"""Samples from one to the next of the same sender."""


def steps_back(count: int, largest: float) -> str:
    """How often a clock steps back and how far at most [s], in a clause."""
    words = f"time steps back {wording.count_of(count, 'time')}, by up to {largest:.4g} s"
    if abs(largest - HOUR_S) > ABOUT_S:
        return words
    return f"{words} ({wording.SET_BACK}, whose samples mix? state its zone, or cut the log there)"


def of_clock(logged: Series, ordered: Series) -> Iterator[str]:
    """Remarks on the stamps: rate, order, duplicates, jitter; `logged` is in the log's order."""
    name = logged.quantity.name
    yield f"{name}: {len(ordered.t)} samples, {1 / ordered.period:.4g} Hz, {logged.clock}"
    back = -np.diff(logged.t)[np.diff(logged.t) < 0]
    if len(back):
        yield f"{name}: {steps_back(len(back), back.max() / 1e9)}; sorted"
    twice = len(logged.t) - len(ordered.t)
    if twice:
        yield f"{name}: {wording.count_of(twice, 'sample')} with the stamp of another one dropped"
    missing = int(np.sum(~np.isfinite(ordered.y)))
    if missing:
        yield f"{name}: {missing} of {len(ordered.y)} values not available"
    yield from _jitter(ordered)


def _jitter(series: Series) -> Iterator[str]:
    steps = np.diff(series.t[np.isfinite(series.y)]) / 1e9
    near = steps[steps < 3 * series.period]
    spread = float(np.std(near)) if len(near) else 0.0
    if spread > JITTER * series.period:
        name = series.quantity.name
        yield f"{name}: stamps jitter, {spread:.3g} s rms in a period of {series.period:.3g} s"


def of_values(series: Series, grid: Grid) -> Iterator[str]:
    """Remarks on the values within the trial: gaps, a slow or stuck sensor."""
    name = series.quantity.name
    yield from _gaps(series, grid)
    if not faster(series, grid.period) and series.period > grid.period / 0.99:
        yield f"{name}: one sample in {series.period:.3g} s, interpolated to {grid.period:.3g} s"
    t, y = available(series, grid)
    during = (t >= 0) & (t <= grid.t[-1])
    t, y = t[during], y[during]
    if len(y) and np.ptp(y) == 0:
        shown = f"{y[0]:.4g} {series.quantity.unit}"
        yield f"{name}: constant at {shown} throughout; is the sensor alive?"
    elif len(y):
        yield from _coarse(series, y)
        yield from _in_turn(series, y)
        moves = name in MOTIONS and series.quantity.mirror < 0
        if np.ptp(y) > 0 and (moves or (series.quantity.steers and _is_restless(t, y))):
            yield from _stuck(name, t, y)


def _coarse(series: Series, y: Vector) -> Iterator[str]:
    """A resolution that is felt: its error is uniform, step / sqrt(12) rms, whatever the motion.

    An order has none: full ahead and astern are two steps, and exact.
    """
    if series.quantity.commands or series.quantity.name.endswith("_order"):
        return
    levels = np.unique(y)
    step = float(np.diff(levels).min())
    error = step / np.sqrt(12.0)
    if len(levels) < len(y) / 3 and error > COARSE * float(np.std(y)):
        quantity = series.quantity
        size, share = step * units.shown_factor(quantity), error / float(np.std(y))
        yield (
            f"{quantity.name}: in steps of {size:.3g} {quantity.shown}, an error of {share:.1%} of "
            "its motion"
        )


def _in_turn(series: Series, y: Vector) -> Iterator[str]:
    """Two senders or more in one channel, one after the other: what is fitted is none of them."""
    if len(y) < 10 * max(TURN):
        return
    bend = {k: y[k:-k] - (y[: -2 * k] + y[2 * k :]) / 2 for k in (1, *TURN)}
    next_one, *others = (float(np.median(np.abs(one))) for one in bend.values())
    felt = max(COARSE * float(np.std(y)), 2 * resolution(y))
    if min(others) < IN_TURN * next_one and felt < next_one:
        quantity = series.quantity
        count = TURN[int(np.argmin(others))]
        size = next_one * units.shown_factor(quantity)
        yield (
            f"{quantity.name}: {count} series in turn, {size:.3g} {quantity.shown} apart: as many "
            "sensors in one channel? what is fitted is their mean; take one of them"
        )


def _is_restless(t: Vector, y: Vector) -> bool:
    """Whether a rudder goes to and fro from sample to sample but for one time, of half at most.

    A feedback's noise does not rest; orders do, rudders logged without noise, and at their stops.
    """
    begin, end = _longest(t, y)
    step = np.delete(np.diff(y), slice(begin, end))
    if not len(step) or y[begin] in (np.min(y), np.max(y)):
        return False
    back = float(np.mean(step[1:] * step[:-1] < 0.0))
    return t[end] - t[begin] < 0.5 * (t[-1] - t[0]) and back > RESTLESS


def _longest(t: Vector, y: Vector) -> tuple[int, int]:
    """The first and last sample of the longest time of one and the same value."""
    edges = np.concatenate([[0], np.flatnonzero(np.diff(y)) + 1, [len(y)]])
    k = int(np.argmax(t[edges[1:] - 1] - t[edges[:-1]]))
    return int(edges[k]), int(edges[k + 1]) - 1


def _stuck(name: str, t: Vector, y: Vector) -> Iterator[str]:
    """The longest time that it keeps one and the same value."""
    begin, end = (float(t[k]) for k in _longest(t, y))
    if end - begin >= max(STUCK_S, STUCK_SHARE * (t[-1] - t[0])):
        yield f"{name}: does not change from {begin:.1f} to {end:.1f} s; stuck?"


def _gaps(series: Series, grid: Grid) -> Iterator[str]:
    t, _ = available(series, grid)
    runs = stretches(t, longest_step(series, grid.period))
    closing = [t[last] for _, last in runs]
    opening = [t[first] for first, _ in runs]
    edges = zip([0.0, *closing], [*opening, grid.t[-1]], strict=True)
    gaps = [(max(a, 0.0), min(b, grid.t[-1])) for a, b in edges]
    gaps = [(a, b) for a, b in gaps if b - a > grid.period]
    if gaps:
        total = sum(b - a for a, b in gaps)
        places = ", ".join(f"{a:.1f}-{b:.1f} s" for a, b in gaps[:3])
        more = f" and {len(gaps) - 3} more" if len(gaps) > 3 else ""
        count = wording.count_of(len(gaps), "gap")
        yield f"{series.quantity.name}: {count}, {total:.1f} s in all, at {places}{more}; masked"


def of_trial(
    series: Sequence[Series], grid: Grid, window: tuple[float, float] | None
) -> Iterator[str]:
    """Remarks on the trial as a whole: its clocks, its filter, its end."""
    clocks: dict[str, list[str]] = {}
    for one in series:
        clocks.setdefault(one.clock, []).append(one.quantity.name)
    if len(clocks) > 1:
        words = "; ".join(f"{', '.join(names)} by {clock}" for clock, names in clocks.items())
        yield f"different clocks, the delay between them is not known: {words}"
    if any_faster(series, grid.period):
        half = CUT_OFF / (2 * grid.period)
        yield (
            f"all signals low-pass filtered alike, half amplitude at {half:.3g} Hz; "
            f"{HALF_LENGTH * grid.period:.3g} s at each end and beside each gap masked"
        )
    if window is not None and window[1] - window[0] > grid.t[-1] + grid.period:
        yield f"the channels end {grid.t[-1]:.1f} s into the window, before the window does"


def check_valid(series: Series, valid: Mask, grid: Grid, where: str) -> None:
    """AlignmentError when gaps and the ends of the filter leave nothing of a signal."""
    if valid.any():
        return
    t, _ = available(series, grid)
    inside = int(np.sum((t >= 0) & (t <= grid.t[-1])))
    raise AlignmentError(
        f"{where}: nothing of {series.quantity.name} is usable in the {grid.t[-1]:.6g} s of the "
        f"trial: {inside} values there, in pieces too short for period = {grid.period:.6g} s; "
        "choose another window or a shorter period"
    )
