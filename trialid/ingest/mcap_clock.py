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
SHARE = 0.99
"""Share of the messages whose stamp must be near and must not step back."""


def measured(
    stamp: Stamps, publish: Stamps, log: Stamps, stamp_name: str
) -> tuple[Stamps, NDArray[np.bool_], str]:
    """Time of each message [ns], which messages have one, and the words for it; (N,) each.

    The message's own stamp where it can be one, else the publish time where all messages have one,
    else the log time.
    """
    good = (stamp > 0) & (np.abs(stamp - log) <= NEAR_NS)
    if good.mean() >= SHARE and (np.diff(stamp[good]) < 0).mean() <= 1 - SHARE:
        return stamp, good, stamp_name
    everyone = np.ones(len(log), np.bool_)
    if publish.all():
        return publish, everyone, "publish time"
    return log, everyone, "log time"
