"""What recorders and people call the time and the date of a row, in the languages of ships."""

import re
from collections.abc import Sequence

TIMES = frozenset(
    (
        "t", "time", "timestamp", "time_stamp", "stamp", "datetime", "date_time", "utc", "epoch",
        "unix_time", "elapsed", "elapsed_time", "time_elapsed", "seconds", "zeit", "uhrzeit",
        "zeitstempel", "datum_zeit", "datum_uhrzeit", "tid", "tidspunkt", "tijd", "tiempo", "hora",
        "heure", "temps", "tempo", "horodatage", "rosbagtimestamp", "ts", "gps_time", "gnss_time",
        "log_time", "dateserial", "date_serial", "serial_date", "datenum", "excel_date",
    )
)  # fmt: skip
DATES = frozenset(("date", "datum", "dato", "fecha"))
UNITS = {
    "s": "s", "sec": "s", "secs": "s", "seconds": "s", "ms": "ms", "msec": "ms", "us": "us",
    "usec": "us", "ns": "ns", "nsec": "ns", "min": "min",
}  # fmt: skip
"""Last word of a name, to the unit of time it states."""
WHOLE = frozenset(("sec", "secs", "seconds"))
PARTS = frozenset(("nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"))
"""Last words of the two columns that a stamp of ROS becomes."""
UNIVERSAL = frozenset(("utc", "gmt"))


GLUED = re.compile(r"(?<=time|tamp)(ms|us|ns)$")
"""A unit that stands at a time without a mark: `TimeUS`, `TIMESTAMPms`."""


def bare_words(name: str) -> list[str]:
    """The words of a name in small letters: `_value`, `Msg-ID`, `TIMESTAMPms`.

    >>> bare_words("TIMESTAMPms"), bare_words("Msg-ID")
    (['timestamp', 'ms'], ['msg', 'id'])
    """
    return [word for word in re.split(r"[\W_]+", GLUED.sub(r"_\1", name.lower())) if word]


def is_time(name: str) -> bool:
    """Whether a column of this name is a time: `time_utc`, `t_s`, `Uhrzeit`.

    >>> [is_time(name) for name in ("time_utc", "DateTime", "t_ms", "utc", "z", "time_constant")]
    [True, True, True, True, False, False]
    >>> is_time("DateSerial"), is_time("datenum"), is_time("Excel date"), is_time("serial")
    (True, True, True, False)
    """
    words = bare_words(name)
    if not words:
        return False
    bare = [word for word in words if word not in UNIVERSAL]
    plain = "_".join(bare) or "utc"
    cut = "_".join(bare[:-1]) if len(bare) > 1 and bare[-1] in UNITS else plain
    return plain in TIMES or cut in TIMES


def is_date(name: str) -> bool:
    """Whether a column of this name is the date alone.

    >>> is_date("Datum"), is_date("date_utc"), is_date("data")
    (True, True, False)
    """
    return "_".join(word for word in bare_words(name) if word not in UNIVERSAL) in DATES


def two_parts(names: Sequence[str]) -> tuple[int, int] | None:
    """The columns of whole seconds and of the nanoseconds beside them, if there is one such pair.

    >>> two_parts(["header.stamp.secs", "header.stamp.nsecs", "delta"]), two_parts(["sec", "delta"])
    ((0, 1), None)
    """
    told = [bare_words(name) or [""] for name in names]
    wholes, parts = (
        [(i, words[:-1]) for i, words in enumerate(told) if words[-1] in last]
        for last in (WHOLE, PARTS)
    )
    found = [(i, j) for i, beside in wholes for j, alike in parts if beside == alike]
    return found[0] if len(found) == 1 else None


def unit_of_time(name: str) -> str | None:
    """The unit that a time column's name ends with.

    >>> unit_of_time("time_ms"), unit_of_time("elapsed_s"), unit_of_time("t")
    ('ms', 's', None)
    """
    words = bare_words(name)
    return UNITS.get(words[-1]) if len(words) > 1 else None


def is_universal(name: str, unit: str | None) -> bool:
    """Whether a header says that its dates are of UTC: `time_utc`, `DateTime (UTC)`.

    >>> is_universal("time_utc", None), is_universal("DateTime", "UTC"), is_universal("t", "s")
    (True, True, False)
    """
    return bool(UNIVERSAL.intersection(bare_words(name))) or (unit or "").lower() in UNIVERSAL
