"""How much of a record is white noise: its third differences, which a smooth motion hardly reaches.

Third differences of white noise of one have a standard deviation of the root of 20: 1, 3, 3, 1.
"""

from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector

SMOOTH: Final = float(np.sqrt(20.0))
FEWEST: Final = 9
"""Samples below which nothing is said."""

MEDIAN: Final = 1.4826
"""Standard deviation of normal noise over the median of its absolute values."""


def white_noise(y: Vector) -> float:
    """Standard deviation of what is white in a smooth motion.

    >>> rng = np.random.default_rng(1)
    >>> y = np.sin(0.01 * np.arange(10_000)) + 0.1 * rng.normal(size=10_000)
    >>> round(white_noise(y), 2)
    0.1
    """
    return float(np.std(np.diff(y, 3))) / SMOOTH if len(y) >= FEWEST else 0.0


def white_noise_of_most(y: Vector, seen: Mask | None = None) -> float:
    """The same of the most of a record, whatever jumps the rest of it has.

    Parameters
    ----------
    seen
        Where the values were measured; (N,). None for all of them.

    >>> steps = np.repeat([0.0, 20.0, -20.0, 20.0], 50)
    >>> white_noise_of_most(steps)
    0.0
    """
    steps = np.diff(y, 3)
    if seen is not None:
        steps = steps[np.convolve(seen, np.ones(4), "valid") > 3.5] if len(y) > 3 else steps
    return MEDIAN * float(np.median(np.abs(steps))) / SMOOTH if len(steps) else 0.0
