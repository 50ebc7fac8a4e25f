"""The date a GPS week and time of week stand for, as a remark: never a clock to fit on.

The boot clock is the better clock within a log; the date tells which trial it was.
"""

from datetime import UTC, datetime, timedelta

EPOCH = datetime(1980, 1, 6, tzinfo=UTC)
LEAP_SECONDS = (
    (datetime(2017, 1, 1, tzinfo=UTC), 18),
    (datetime(2015, 7, 1, tzinfo=UTC), 17),
    (datetime(2012, 7, 1, tzinfo=UTC), 16),
    (datetime(2009, 1, 1, tzinfo=UTC), 15),
)
"""GPS time minus UTC [s] from each date on; IERS Bulletin C."""
UNIX = datetime(1970, 1, 1, tzinfo=UTC)


def utc(week: int, milliseconds: int) -> datetime:
    """UTC of a GPS time.

    >>> utc(2086, 0).isoformat()
    '2019-12-28T23:59:42+00:00'
    """
    gps = EPOCH + timedelta(weeks=week, milliseconds=milliseconds)
    leap = next((s for since, s in LEAP_SECONDS if gps - timedelta(seconds=s) >= since), 14)
    return gps - timedelta(seconds=leap)


def words(start: datetime, source: str) -> str:
    """A remark on when the boot clock's zero was.

    >>> words(utc(2086, 0), "the first GPS fix")
    'boot clock 0 s is about 2019-12-28 23:59:42 UTC by the first GPS fix (late by 0.1-0.3 s)'
    """
    date = start.strftime("%Y-%m-%d %H:%M:%S")
    return f"boot clock 0 s is about {date} UTC by {source} (late by 0.1-0.3 s)"
