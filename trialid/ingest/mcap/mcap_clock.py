"""Which of a message's three times is the time of the measurement.

A message has the time the recorder received it, mostly the time it was sent, and often a stamp the
sensor's own driver put into it. The stamp is the best of them when it is one: not zero, not from
another epoch, and running forward.
"""

import numpy as np
from numpy.typing import NDArray

Stamps = NDArray[np.int64]

NEAR_NS = 5_000_000_000
"""A stamp further than this from the log time counts from another epoch or an unset clock."""
YEAR_NS = 365 * 86_400_000_000_000
"""A clock that was never set counts from its start: it says 1970."""
SHARE = 0.99
"""Share of the messages whose stamp must be near and must not step back."""


def message_times(
    stamp: Stamps, publish: Stamps, log: Stamps, stamp_name: str, *, stamped: bool = True
) -> tuple[Stamps, NDArray[np.bool_], str]:
    """Time of each message [ns], which messages have one, and the words for it; (N,) each.

    The message's own stamp where it can be one, else the publish time where all messages have one,
    else the log time. The words say why the stamp was not taken, where the messages are `stamped`.
    """
    good = (stamp > 0) & (np.abs(stamp - log) <= NEAR_NS)
    if good.mean() >= SHARE and _backward(stamp[good], log[good]) <= 1 - SHARE:
        return stamp, good, stamp_name
    everyone = np.ones(len(log), np.bool_)
    why = f": {stamp_name}s {_refused(stamp, log, good)}" if stamped else ""
    if publish.all():
        return publish, everyone, f"publish time{why}"
    return log, everyone, f"log time{why}"


def _backward(stamp: Stamps, log: Stamps) -> float:
    """Share of the steps from one message to the next received on which the stamp goes back."""
    if len(log) < 2:
        return 0.0
    in_order = stamp if (np.diff(log) >= 0).all() else stamp[np.argsort(log, kind="stable")]
    return float((np.diff(in_order) < 0).mean())


def _refused(stamp: Stamps, log: Stamps, good: NDArray[np.bool_]) -> str:
    """Why the stamps cannot be the time of the messages."""
    if good.mean() >= SHARE:
        return "run backwards"
    if (stamp == 0).mean() > 1 - SHARE:
        return f"are not set in {(stamp == 0).mean():.0%} of the messages"
    if (stamp < 0).all():
        return "are negative"
    if stamp.max() < YEAR_NS and log.min() > YEAR_NS:
        return "are 1970"
    return f"are {np.median(np.abs(stamp - log)) / 1e9:.4g} s off the log time"
