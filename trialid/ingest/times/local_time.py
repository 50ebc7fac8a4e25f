"""Stamps in the local time of a place to UTC."""

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError, available_timezones

import numpy as np
from numpy.typing import NDArray

from trialid.errors import nearest

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


def known_zone(name: str) -> str:
    """The name itself, where it is a time zone's; ValueError else, with the nearest that are."""
    try:
        ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError) as error:
        raise ValueError(
            f"{name!r} is no time zone; write it like Europe/Oslo{_like(name)}"
        ) from error
    return name


def _like(name: str) -> str:
    """A hint: zones of that city, else of a similar name; 600 of them are no list to read."""
    zones = sorted(available_timezones())
    city = name.rpartition("/")[2].replace(" ", "_").lower()
    same = [zone for zone in zones if zone.rpartition("/")[2].lower() == city]
    hint = f"did you mean {same[0]!r}?" if same else nearest(name, zones)
    return f" ({hint})" if hint.startswith("did you mean") else ""


def _offset(quarter: int, place: ZoneInfo) -> int:
    """How far the local clock is ahead of UTC [ns]."""
    local = (EPOCH + timedelta(seconds=quarter * 900)).replace(tzinfo=place)
    offset = local.utcoffset() or timedelta()
    return int(offset.total_seconds()) * 1_000_000_000
