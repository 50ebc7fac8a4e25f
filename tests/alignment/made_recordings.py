"""Recordings made in memory."""

from pathlib import Path

import numpy as np

from trialid.recording import Channel, Recording

EPOCH = 1_700_000_000


def channel(name, t, y, unit=None, clock="column t", epoch=EPOCH):
    """A channel from times [s] after the epoch and values or a function of the time."""
    t = np.asarray(t, dtype=float)
    values = y(t) if callable(y) else np.array(y, dtype=float)
    return Channel(name, np.rint(t * 1e9).astype(np.int64) + epoch * 10**9, values, unit, clock)


def recording(*channels, path="trial.log", remarks=()):
    return Recording(Path(path), "csv", "0" * 64, {c.name: c for c in channels}, remarks)
