"""Rows that do not stand in the order of their stamps: the stamps are right, the rows are not.

Who stamps on arrival never writes a stamp before the last one. Stamps that go back are a clock that
was set, a counter that began again or a stretch delivered again, or the rows of a sensor's own
stamps that were put down, joined or exported in another order. Of the first kinds some stamps come
twice, with other values, or a gap remains when they are sorted.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.stamps.sample_index import SINGLE, Vector
from trialid.alignment.stamps.time_steps import ABOUT, SOON

DISTINCT: Final = 10
"""Different values that rows delivered again have at least: of fewer it may be chance."""
SHUFFLED: Final = 0.2
"""Share of stamps before their predecessors, further from their place than jitter moves any, above
which no clock was set so often. Half are of rows in no order at all."""


def is_out_of_order(t: NDArray[np.int64], y: Vector) -> bool:
    """Whether stamps [ns] in the order of the log are right and their order is not; (N,), (N,)."""
    back = np.diff(t) < 0
    if not back.any():
        return False
    order = np.argsort(t, kind="stable")
    off = np.abs(order - np.arange(len(t)))
    if np.mean(back) > SHUFFLED and np.median(off) > ABOUT:
        return True
    t, y = t[order], y[order]
    again = np.diff(t) == 0
    if again.any() and not _is_delivered_again(np.diff(y)[again], y[1:][again]):
        return False
    between = (off[1:] > 0) | (off[:-1] > 0)
    return _is_whole(np.diff(t)[~again], between[~again])


def _is_delivered_again(change: Vector, y: Vector) -> bool:
    """Whether rows of one stamp have one value, and not because it hardly changes."""
    return not change.any() and len(np.unique(y)) >= DISTINCT


def _is_whole(steps: NDArray[np.int64], between: NDArray[np.bool_]) -> bool:
    """Whether sorted stamps follow one another by whole periods, without a gap, where rows moved.

    Where a clock was set back two stretches lie in each other.
    """
    period = float(np.median(steps))
    counts = steps[between] / period
    off = counts - np.rint(counts)
    even = float(np.sqrt(np.mean(off**2) / 2.0)) <= SINGLE
    return bool(even and counts.min() > 0.5 and steps.max() <= SOON * period)
