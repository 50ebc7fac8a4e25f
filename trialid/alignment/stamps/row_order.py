"""Rows that do not stand in the order of their stamps: the stamps are right, the rows are not.

Who stamps on arrival never writes a stamp before the last one. Stamps that go back are a clock that
was set, a counter that began again or a stretch delivered again, or the rows of a sensor's own
stamps that were put down, joined or exported in another order. Only the last are even, and without
a gap, as soon as they are sorted. The stamps alone decide, so that all columns of a table agree.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.stamps.sample_index import SINGLE
from trialid.alignment.stamps.time_steps import ABOUT, MOST, unwrap_counter

SHUFFLED: Final = 0.2
"""Share of stamps before their predecessors, further from their place than jitter moves any, above
which no clock was set so often. Half are of rows in no order at all."""
PAUSE: Final = 10.0
"""Periods without a sample from which on it may be a clock that was set, not a loss."""
SAME_PACE: Final = 0.9
"""Share of the pace in the order of the log that the sorted one has at least. Where a clock was set
back by a half of a period and more than half of the log, most sorted steps are half as long."""


def is_out_of_order(t: NDArray[np.int64]) -> bool:
    """Whether stamps [ns] in the order of the log are right and their order is not; (N,)."""
    steps = np.diff(t)
    back = float(np.mean(steps < 0)) if len(steps) else 0.0
    if not back:
        return False
    order = np.argsort(t, kind="stable")
    off = np.abs(order - np.arange(len(t)))
    if back > SHUFFLED and np.median(off) > ABOUT:
        return True
    if unwrap_counter((t - t[0]) / 1e9)[1]:
        return False
    between = (off[1:] > 0) | (off[:-1] > 0)
    forward = float(np.median(steps[steps > 0])) if back <= MOST else 0.0
    return _is_even(np.diff(t[order]), between, SAME_PACE * forward)


def _is_even(steps: NDArray[np.int64], between: NDArray[np.bool_], least: float) -> bool:
    """Whether sorted stamps step by one period where rows moved, at least so long, and never pause.

    Where a clock was set back two stretches lie in each other.
    """
    period = float(np.median(steps))
    if period <= 0.0 or period < least:
        return False
    counts = steps[between] / period
    off = counts - np.rint(counts)
    even = float(np.sqrt(np.mean(off**2) / 2.0)) <= SINGLE
    return bool(even and counts.min() > 0.5 and steps.max() <= PAUSE * period)
