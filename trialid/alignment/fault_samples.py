"""The available samples of a series as faults are looked for in them, and what is found."""

from dataclasses import dataclass

import numpy as np

from trialid.alignment.clocks import Series
from trialid.arrays import Mask, Vector


@dataclass(frozen=True)
class Fault:
    """Samples of a series that are wrong; `sure` if they cannot be a measurement."""

    kind: str
    words: str
    samples: Mask
    sure: bool


def joined_runs(joined: Mask) -> list[tuple[int, int]]:
    """First and last sample of the runs whose neighbours are joined; `joined` has one less."""
    breaks = np.flatnonzero(~joined)
    if len(joined) == 0:
        return []
    starts, ends = [0, *(breaks + 1)], [*breaks, len(joined)]
    return [(int(i), int(j)) for i, j in zip(starts, ends, strict=True)]


@dataclass(frozen=True)
class Samples:
    """The available samples: place in the series, time [s], value, near to the one before."""

    at: np.ndarray
    t: Vector
    y: Vector
    near: Mask


def available_samples(series: Series) -> Samples:
    """The samples of a series that are numbers, an angle unwrapped."""
    at = np.flatnonzero(np.isfinite(series.y))
    y = np.unwrap(series.y[at]) if series.quantity.angle else series.y[at]
    t = (series.t[at] - series.t[0]) / 1e9
    near = np.concatenate([[False], np.diff(t) < 3 * series.period]) if len(at) else at > 0
    return Samples(at, t, y, near)


def resolution(y: Vector) -> float:
    """Smallest distance between two values."""
    levels = np.diff(np.unique(y))
    return float(levels.min(initial=np.inf)) if len(levels) else 0.0
