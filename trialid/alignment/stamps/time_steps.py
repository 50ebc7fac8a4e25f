"""Where a clock was set back, ran over its last digit, or a channel has a gap."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.stamps.sample_index import pace

Vector = NDArray[np.float64]

WRAPS: Final = {
    2.0**32 * 1e-9: "a 32 bit counter of nanoseconds",
    2.0**16 * 1e-3: "a 16 bit counter of milliseconds",
    60.0: "seconds of the minute",
    3600.0: "seconds of the hour",
    2.0**32 * 1e-6: "a 32 bit counter of microseconds",
    86400.0: "seconds of the day",
    604800.0: "seconds of the week",
    2.0**32 * 1e-3: "a 32 bit counter of milliseconds",
}
"""Time [s] after which a counter begins again."""
SOON = 10.0
"""Periods after the last stamp within which the first of a new turn comes."""
TURN = 20.0
"""Periods a turn of a counter has at least; a shorter step back is jitter."""
ABOUT = 15
"""Samples on each side that tell a step of the clock from a single odd stamp."""
GAP = 50.0
"""Periods without a sample after which a count begins anew."""
CLEAR = 6.0
"""Standard deviations of the stamps by which a step back stands out of their jitter."""
DISORDER = 0.5
"""Share of stamps before their predecessors at which a log has no order."""
MOST = 0.02
"""Share of stamps that may step back; more is no clock that was set."""


def unwrap_counter(t: Vector) -> tuple[Vector, list[float]]:
    """Stamps [s] of a counter that began again, made to run on, and the turns [s] it made."""
    turns = []
    period = pace(t)
    back = np.flatnonzero(np.diff(t) < -1.0)
    if period <= 0 or len(back) > MOST * len(t):
        return t, []
    steps = np.diff(t, prepend=t[0])
    for at in back + 1:
        ahead = {turn: steps[at] + turn for turn in WRAPS}
        within = min(SOON * period, -steps[at])
        turn = next((w for w, x in ahead.items() if 0 <= x <= within and w > TURN * period), None)
        if turn is not None:
            steps[at] = ahead[turn]
            turns.append(turn)
    return (t[0] + np.cumsum(steps), turns) if turns else (t, [])


def breaks(t: Vector) -> list[tuple[int, bool]]:
    """Where the count of samples cannot go on: first index after, and whether time went back.

    A single stamp that is odd, or two messages that changed places, is no step.
    """
    period = pace(t)
    steps = np.diff(t)
    x = t - period * np.arange(len(t))
    noise = 1.4826 * float(np.median(np.abs(np.diff(x)))) / np.sqrt(2.0)
    back = steps < -max(0.5 * period, CLEAR * noise)
    if period <= 0 or np.mean(steps < 0) > DISORDER or back.sum() > MOST * len(t):
        return []
    at = np.flatnonzero(back | (steps > GAP * period))
    return [(int(i) + 1, bool(back[i])) for i in at if is_lasting(x, int(i) + 1, float(steps[i]))]


def is_lasting(x: Vector, at: int, step: float) -> bool:
    """True when the level on both sides of a step differs by as much as the step itself."""
    before, after = x[max(0, at - ABOUT) : at], x[at : at + ABOUT]
    return bool((np.median(after) - np.median(before)) / step > 0.5)


def wrap_words(turns: Sequence[float]) -> list[str]:
    """Remarks on counters that began again."""
    return [
        f"the counter began again {turns.count(turn)} times after {turn:.10g} s ({WRAPS[turn]}); "
        "made to run on"
        for turn in dict.fromkeys(turns)
    ]
