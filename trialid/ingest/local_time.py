"""Stamps in the local time of a place to UTC."""

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np
from numpy.typing import NDArray

QUARTER_NS = 900_000_000_000
"""Every zone's clock changes at a quarter of an hour."""
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def utc(t: NDArray[np.int64], zone: str) -> NDArray[np.int64]:
    """Stamps [ns since 1970 of the local clock] in UTC; (N,).

    In the hour that an autumn repeats the first of the two is taken.
    """
    quarters, inverse = np.unique(t // QUARTER_NS, return_inverse=True)
    place = ZoneInfo(zone)
    ahead = [_offset(quarter, place) for quarter in quarters.tolist()]
    return t - np.array(ahead, np.int64)[inverse]


def _offset(quarter: int, place: ZoneInfo) -> int:
    """How far the local clock is ahead of UTC [ns]."""
    local = (EPOCH + timedelta(seconds=quarter * 900)).replace(tzinfo=place)
    offset = local.utcoffset() or timedelta()
    return int(offset.total_seconds()) * 1_000_000_000
