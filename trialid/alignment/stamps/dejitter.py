"""Stamps of an evenly paced sensor, put on a line through its own count of samples.

A sensor that measures every 100 ms is stamped when a computer gets round to it: late by a latency
that varies, several at once, in whole seconds. Its count of samples is the better clock: stamps
become a regression on it, in pieces where the pace drifts. What the regression cannot know is the
mean latency; that is a delay, declared or fitted.

A sensor that is not even, one that sends on change or whose pace truly varies, is left as it is;
so is one that is stamped evenly, bit for bit. The evidence is in the stamps and, where they say
nothing, in the values: true instants make a smoother record than wrong ones.
"""

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.clocks import Series, in_time_order, moment
from trialid.alignment.stamps.row_order import is_out_of_order
from trialid.alignment.stamps.sample_index import Vector
from trialid.alignment.stamps.stamp_regression import FEWEST_COUNTED, Line, is_even, regress_stamps
from trialid.alignment.stamps.time_steps import breaks, unwrap_counter, wrap_words

TABLE = 0.5
"""Share of values below which a channel is the slow one of a table, and its own pace is not that of
the rows."""
DISTINCT = 10
"""Different values that a stretch delivered again has at least."""


def repair_stamps(series: Series) -> tuple[Series, tuple[str, ...]]:
    """The series, in the order of the log, on repaired stamps, and remarks on what was done."""
    finite = np.isfinite(series.y)
    slow = finite.sum() < TABLE * len(finite)
    use = finite if slow else np.ones(len(finite), np.bool_)
    logged, y = series.t[use], series.y[use]
    if len(logged) < FEWEST_COUNTED or is_even(logged):
        return series, ()
    if is_out_of_order(logged):
        return _by_their_stamps(series)
    origin = int(logged[0])
    t, turns, first = _run_on((logged - origin) / 1e9, y)
    kept = first == np.arange(len(t))
    new, words = (t, []) if is_even(logged[kept]) else _repaired(t[kept], y[kept], origin)
    remarks = tuple(f"{series.quantity.name}: {word}" for word in (*wrap_words(turns), *words))
    if not turns and np.array_equal(new, t if len(new) == len(t) else t[kept]):
        return series, remarks
    everyone = new if len(new) == len(t) else new[np.cumsum(kept)[first] - 1]
    made = origin + np.rint(everyone * 1e9).astype(np.int64)
    return replace(series, t=_for_all(series.t, use, made)), remarks


def _by_their_stamps(series: Series) -> tuple[Series, tuple[str, ...]]:
    """The same of rows that stand in another order."""
    ordered = in_time_order(series)
    repaired, remarks = repair_stamps(ordered)
    if repaired is ordered:
        return series, remarks
    return replace(series, t=repaired.t[np.searchsorted(ordered.t, series.t)]), remarks


def _repaired(t: Vector, y: Vector, origin: int) -> tuple[Vector, list[str]]:
    """Repaired stamps [s], and what was done."""
    steps = breaks(t)
    edges = [0, *(at for at, _ in steps), len(t)]
    parts = [slice(a, b) for a, b in itertools.pairwise(edges)]
    lines = [regress_stamps(t[part], y[part]) for part in parts]
    new, set_back = _joined(lines, [back for _, back in steps])
    words = [
        f"the clock went back {size:.4g} s after "
        f"{moment(origin + round(t[parts[i].stop - 1] * 1e9))}; made to run on as if no sample was "
        "lost there, the longest stretch stays where it is"
        for i, size in set_back
    ]
    return new, [*_line_words(lines), *words]


def _run_on(t: Vector, y: Vector) -> tuple[Vector, list[float], NDArray[np.int64]]:
    """Stamps [s] that run on where a counter began again, its turns, and first deliveries.

    A stretch that comes again with all its values is no turn of a counter, whatever its length. Of
    one that does not, after a clock was set back, a few values are by chance those of then.
    """
    first, own = _first_delivery(t, y), np.arange(len(t))
    again = first != own
    mostly = again.sum() > np.sum(t < np.maximum.accumulate(t)) / 2
    if mostly and len(np.unique(y[again])) >= DISTINCT:
        return t, [], first
    whole, turns = unwrap_counter(t)
    if turns:
        return whole, turns, _first_delivery(whole, y)
    return whole, turns, first if mostly else own


def _first_delivery(t: Vector, y: Vector) -> NDArray[np.int64]:
    """For each message itself, or the earlier one it repeats, stamp and value, out of turn; (N,).

    So a log that is delivered again from some point on is no clock that went back.
    """
    own = np.arange(len(t))
    behind = t < np.maximum.accumulate(t)
    if not behind.any():
        return own
    _, first, inverse = np.unique(
        np.column_stack([t, y]), axis=0, return_index=True, return_inverse=True
    )
    earlier = first[inverse.reshape(-1)]
    # the last message of the stretch is level with the latest, not behind it
    since = np.maximum.accumulate(np.where(behind, own, -1))
    return np.where(since > earlier, earlier, own)


def _joined(lines: Sequence[Line], back: Sequence[bool]) -> tuple[Vector, list[tuple[int, float]]]:
    """The stretches one after the other, and where the clock was set back by how much [s].

    After a step back the next sample comes one period after the last, as far as one can know. Of
    what was set, the stretch with most samples keeps its clock.
    """
    shifts, found = [0.0], []
    for i, is_back in enumerate(back):
        early, late = lines[i], lines[i + 1]
        period = early.period or late.period
        size = early.t[-1] + period - late.t[0] if is_back and period else 0.0
        if size:
            found.append((i, float(size)))
        shifts.append(shifts[-1] + size)
    anchor = shifts[int(np.argmax([len(line.t) for line in lines]))] if lines else 0.0
    moved = [s - anchor for s in shifts]
    parts = [line.t + s if s else line.t for line, s in zip(lines, moved, strict=True)]
    return np.concatenate(parts), found


def _for_all(
    t: NDArray[np.int64], use: NDArray[np.bool_], new: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Stamps [ns] of all samples: those that were not used are moved as their neighbours are."""
    if use.all():
        return new
    moved = np.interp(np.arange(len(t)), np.flatnonzero(use), (new - t[use]).astype(np.float64))
    whole = t + np.rint(moved).astype(np.int64)
    whole[use] = new
    return whole


def _line_words(lines: Sequence[Line]) -> list[str]:
    reasons = dict.fromkeys(line.why_not for line in lines if line.why_not)
    words = [f"stamps left as logged: {why}" for why in reasons]
    done = [line for line in lines if line.before > 0]
    if not done:
        return words
    longest = max(done, key=lambda line: len(line.t))
    share = sum(len(line.t) for line in done) / sum(len(line.t) for line in lines)
    part = "" if share > 0.999 else f" in {share:.0%} of the samples"
    before, after = (1e3 * _root_mean(done, field) for field in ("before", "after"))
    repair = (
        f"stamps repaired{part} by regression on the sample index, {1 / longest.period:.5g} Hz: "
        f"{before:.3g} ms rms of jitter before, {after:.2g} ms after, "
        f"{sum(line.lost for line in done)} samples lost; {longest.late}"
    )
    return [repair, *words]


def _root_mean(lines: Sequence[Line], field: str) -> float:
    squares = [(len(line.t), getattr(line, field) ** 2) for line in lines]
    return float(np.sqrt(sum(n * s for n, s in squares) / sum(n for n, _ in squares)))
