"""A sensor's clock against the recorder's, where a log holds both."""

import itertools
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.clocks import Series
from trialid.alignment.stamps.time_steps import is_lasting

Vector = NDArray[np.float64]

FEWEST = 30
"""Samples below which two clocks are not compared."""
BLOCKS = 20
"""Parts of the record whose medians show a drift."""
SAME_EPOCH = 86400.0
"""Difference of two clocks [s] above which they do not count from the same day."""
SET = 0.2
"""Least step [s] that is taken for a clock being set ..."""
CLEAR = 8.0
"""... and in standard deviations of the time from stamp to recorder."""
MOST = 100
"""Times a clock is set; more is no clock."""
ABOUT = 500
"""Samples on each side that measure a step."""
SURE = 3.0
"""Standard errors from which on a drift is said."""


def set_right(series: Series) -> tuple[Series, tuple[str, ...]]:
    """The series without the steps its clock made while the recorder's ran on, and remarks.

    A step of both clocks is a gap. The longest stretch keeps its stamps.
    """
    if series.received is None or len(series.t) < FEWEST:
        return series, ()
    name = series.quantity.name
    ahead = (series.t - series.received) / 1e9
    level, sizes = _steps(ahead)
    words = [
        f"its clock was set {size:+.3g} s while the recorder's ran on; undone" for size in sizes
    ]
    words += _health(-(ahead - level), series.received / 1e9)
    t = series.t - np.rint(level * 1e9).astype(np.int64) if sizes else series.t
    return replace(series, t=t), tuple(f"{name}: {word}" for word in words)


def _steps(ahead: Vector) -> tuple[Vector, list[float]]:
    """What lasting steps add to each sample [s], nothing in the longest stretch; their sizes."""
    steps = np.diff(ahead)
    noise = 1.4826 * float(np.median(np.abs(steps))) / np.sqrt(2.0)
    at = np.flatnonzero(np.abs(steps) > max(SET, CLEAR * noise))
    if len(at) > MOST:
        return np.zeros(len(ahead)), []
    at = np.array([i for i in at if is_lasting(ahead, int(i) + 1, float(steps[i]))], np.int64)
    edges = np.concatenate([[0], at + 1, [len(ahead)]])
    counts = np.diff(edges)
    levels = [ahead[a:b] for a, b in itertools.pairwise(edges)]
    sizes = [
        float(np.median(after[:ABOUT]) - np.median(before[-ABOUT:]))
        for before, after in itertools.pairwise(levels)
    ]
    heights = np.concatenate([[0.0], np.cumsum(sizes)])
    return np.repeat(heights - heights[np.argmax(counts)], counts), sizes


def _health(late: Vector, at: Vector) -> list[str]:
    """Words on offset, drift and jitter of the time from stamp to recorder."""
    parts = np.array_split(np.arange(len(late)), BLOCKS)
    middles = np.array([np.median(late[part]) for part in parts])
    times = np.array([np.median(at[part]) for part in parts])
    design = np.column_stack([np.ones(BLOCKS), times - times.mean()])
    (offset, drift), *_ = np.linalg.lstsq(design, middles, rcond=None)
    left = middles - design @ np.array([offset, drift])
    error = np.sqrt(np.sum(left**2) / (BLOCKS - 2)) / max(np.linalg.norm(design[:, 1]), 1e-9)
    jitter = float(np.std(late - offset - drift * (at - times.mean())))
    epoch = f"{offset * 1e3:.4g} ms" if abs(offset) < SAME_EPOCH else "on another epoch"
    words = f"received {epoch} after its stamp, jitter {jitter * 1e3:.3g} ms rms"
    if abs(drift) > SURE * error and abs(drift) > 1e-7:
        side = "slow" if drift > 0 else "fast"
        words += (
            f"; its clock runs {abs(drift) * 1e6:.3g} ppm {side} (standard error {error * 1e6:.2g})"
        )
    return [words]
