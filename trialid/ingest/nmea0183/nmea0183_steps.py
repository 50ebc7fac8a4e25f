"""Which stamps of a recorder are damaged: those that the stamps around them do not enclose."""

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.nmea0183.nmea0183_stamps import SECOND

Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

OUT_OF_STEP = 50_000_000
"""A stamp this much [ns] outside of its two neighbours, which agree, is a damaged one."""
PART = 1 << 20
"""Stamps looked at together: what is made of them on the way is ten times as long."""


def out_of_step(t: Ints) -> Mask:
    """Stamps that those around them, which agree, do not enclose; (N,).

    Nothing protects the text before a sentence. Asked are the two neighbours, and the medians of
    three on either side. Given up as well is a stamp far from both sides, and at the ends, where
    neighbours are missing, one far from the next.
    """
    if len(t) < 3:
        return np.zeros(len(t), np.bool_)
    parts = (_not_enclosed(t, start, start + PART) for start in range(0, len(t), PART))
    odd = np.concatenate(list(parts))
    steps = np.diff(t[~odd])
    if len(steps):
        first, last = int(steps[0]), int(steps[-1])
        np.abs(steps, out=steps)
        far = 10 * SECOND + 10 * int(np.median(steps, overwrite_input=True))
        begin, end = int(np.argmin(odd)), len(odd) - 1 - int(np.argmin(odd[::-1]))
        odd[begin] |= not -OUT_OF_STEP <= first <= far
        odd[end] |= not -OUT_OF_STEP <= last <= far
    return odd


def _not_enclosed(t: Ints, start: int, stop: int) -> Mask:
    """The same of some stamps in a row, from the three on either side of each."""
    here = t[start:stop]
    rows = np.clip(np.arange(start - 3, start + len(here) + 3), 0, len(t) - 1)
    edged = t[rows]
    before, after = _median_of_3(edged[:-4]), _median_of_3(edged[4:])
    odd = _outside(edged[2:-4], here, edged[4:-2]) | _outside(before, here, after)
    alone = np.minimum(np.abs(here - before), np.abs(here - after))
    return odd | (alone > 10 * SECOND + 2 * np.abs(after - before))


def _outside(before: Ints, here: Ints, after: Ints) -> Mask:
    out = (here < before - OUT_OF_STEP) | (here > after + OUT_OF_STEP)
    return out & (before <= after + OUT_OF_STEP)


def _median_of_3(t: Ints) -> Ints:
    """Medians of each three in a row; (N - 2,)."""
    a, b, c = t[:-2], t[1:-1], t[2:]
    return np.maximum(np.minimum(a, b), np.minimum(np.maximum(a, b), c))
