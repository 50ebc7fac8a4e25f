"""Dates as people and programs write them, to ISO-8601; only where one reading is possible.

`2025/04/11 12:08:20.316091061` begins with the year, `03.06.2026 09:12:00` is written with dots
where the day comes first, `05-Nov-2023 14:00:00` names its month, and of `15:44:39:482290` the last
are thousandths of thousandths: a count of frames has two digits. With slashes and a year at the
end the day may come first or the month: the column tells, if a number in it is above 12.
"""

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Stamps = tuple[NDArray[np.int64], bool]
"""Dates as written [ns] (N,), and whether they state their zone."""
ISO = re.compile(r"\d{4}-\d\d-\d\d([T ]|$)")
DATED = re.compile(
    r"(?P<first>\d{1,4})(?P<mark>[./-])(?P<second>\d{1,2}|[A-Za-z]{3})(?P=mark)(?P<third>\d{1,4})"
    r"(?:[T,_\s]\s*(?P<hour>\d{1,2}):(?P<minute>\d\d)(?::(?P<second_of>\d\d)"
    r"(?:(?:[.,]|:(?=\d{3}(?:\d{3}){0,2}(?!\d)))(?P<part>\d{1,9}))?)?\s*(?P<half>[AaPp][Mm])?)?"
    r"\s*(?P<zone>Z|UTC|GMT|[+-]\d\d:?\d\d)?"
)
MONTHS = {
    name: number
    for number, name in enumerate(
        ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"), 1
    )
}
LOOKS_DATED = re.compile(r"\d{4}[./-]\d{1,2}[./-]\d|\d{1,2}[./-](\d{1,2}|[A-Za-z]{3})[./-]\d{4}")
EITHER = re.compile(r"(?P<first>\d{1,2})[/-](?P<second>\d{1,2})[/-]\d{4}")
WRITTEN = (
    (re.compile(r"(\d{4})(\d\d)(\d\d)T(\d\d)(\d\d)(\d\d)"), r"\1-\2-\3T\4:\5:\6"),
    (re.compile(r"(\d{1,2}) ([A-Za-z]{3})[a-z]*+,? (\d{4})"), r"\1-\2-\3"),
    (re.compile(r"([A-Za-z]{3})[a-z]*+\.? {1,2}(\d{1,2}),? (\d{4})"), r"\2-\1-\3"),
    (re.compile(r"[A-Za-z]{3} ([A-Za-z]{3}) {1,2}(\d{1,2}) ([\d:.]+) (\d{4})"), r"\2-\1-\4 \3"),
)
"""Dates without marks: `20260603T091200`, `3 June 2026`, `Jun 3, 2026`, `Wed Jun  3 09:12:00 2026`.
"""
CLOCK = re.compile(r"\d{1,2}:\d\d:\d\d([.,]\d+)?")
"""A time of day that can be none of minutes and seconds."""


def has_a_date(text: str) -> bool:
    """Whether a text begins like a date with a year of four digits."""
    return LOOKS_DATED.match(write_marks(text)) is not None


def write_marks(text: str) -> str:
    """A date that is written without marks with them; any other text as it is.

    >>> write_marks("20260603T091200Z"), write_marks("Wed Jun  3 09:12:00 2026")
    ('2026-06-03T09:12:00Z', '3-Jun-2026 09:12:00')
    >>> write_marks("3 June 2026 09:12"), write_marks("2026-06-03")
    ('3-Jun-2026 09:12', '2026-06-03')
    """
    if text[:1].isdigit() and not (text[4:5].isdigit() or " " in text[1:3]):
        return text
    for form, rewritten in WRITTEN:
        if form.match(text):
            return form.sub(rewritten, text, count=1)
    return text


def as_iso(texts: Sequence[str]) -> list[str] | None:
    """The texts as ISO-8601 dates; None where one is none, or where two readings are possible.

    >>> as_iso(["2025/04/11 12:08:20.316091061"])
    ['2025-04-11T12:08:20.316091061']
    >>> as_iso(["2024-03-07_15:44:39:482290"]), as_iso(["2024-03-07_15:44:39:48"])
    (['2024-03-07T15:44:39.482290'], None)
    >>> as_iso(["03.06.2026 09:12:00"]), as_iso(["03/06/2026 09:12:00"])
    (['2026-06-03T09:12:00'], None)
    >>> as_iso(["03/06/2026 09:12:00", "03/13/2026 09:12:00"])
    ['2026-03-06T09:12:00', '2026-03-13T09:12:00']
    """
    found = [DATED.fullmatch(write_marks(text)) for text in texts]
    dates = [one for one in found if one is not None]
    if len(dates) < len(texts) or not dates:
        return None
    order = _order(dates)
    if order is None or any(_order_of(one, order) is None for one in dates):
        return None
    return [_iso(one, order) for one in dates]


def day_or_month(text: str) -> str:
    """Why a date is none in a table that does not tell its day from its month; empty else.

    >>> day_or_month("03/04/2025 10:00:00")
    "'03/04/2025' may be day 3 of month 4 or day 4 of month 3"
    """
    one = EITHER.match(text)
    first, second = (int(one["first"]), int(one["second"])) if one else (0, 0)
    if one is None or first == second or max(first, second) > 12:
        return ""
    both = f"day {first} of month {second} or day {second} of month {first}"
    return f"{one.group()!r} may be {both}"


def _order(dates: Sequence[re.Match[str]]) -> str | None:
    """Which of year, month and day comes first, in all of them."""
    first = dates[0]
    if any(one["mark"] != first["mark"] for one in dates):
        return None
    if (written := _order_as_written(first)) is not None:
        return written
    day_first = any(int(one["first"]) > 12 for one in dates)
    month_first = any(one["second"].isdigit() and int(one["second"]) > 12 for one in dates)
    if all(one["first"] == one["second"] for one in dates):
        return "dmy"  # and "mdy": the third of the third is one day
    if day_first == month_first:
        return None
    return "dmy" if day_first else "mdy"


def _order_as_written(one: re.Match[str]) -> str | None:
    """The order that a date shows by itself; None where other dates must say it."""
    if len(one["first"]) == 4:
        return "ymd"
    return "dmy" if one["mark"] == "." or one["second"].isalpha() else None


def _order_of(one: re.Match[str], order: str) -> str | None:
    """The order, if this date can be of it: a year has four digits, a month a name or a number."""
    year, others = (one["first"], one["third"]) if order == "ymd" else (one["third"], one["first"])
    named = one["second"].isalpha() and one["second"].lower() not in MONTHS
    return order if len(year) == 4 and len(others) <= 2 and not named else None


def _iso(one: re.Match[str], order: str) -> str:
    place = dict(zip(order, (one["first"], one["second"], one["third"]), strict=True))
    month = MONTHS.get(place["m"].lower(), place["m"])
    date = f"{place['y']}-{int(month):02d}-{int(place['d']):02d}"
    if one["hour"] is None:
        return date
    zone = one["zone"] or ""
    return f"{date}T{_of_day(one)}{'Z' if zone in ('UTC', 'GMT') else zone}"


def _of_day(one: re.Match[str]) -> str:
    hour = int(one["hour"])
    if one["half"]:
        hour = hour % 12 + 12 * (one["half"].lower() == "pm")
    part = f".{one['part']}" if one["part"] else ""
    return f"{hour:02d}:{one['minute']}:{one['second_of'] or '00'}{part}"


def of_one_day(texts: Sequence[str]) -> list[str] | None:
    """The times of day of dates of one day that may be read in two ways; None of others.

    >>> of_one_day(["03/04/2025 10:00:00 AM", "03/04/2025 10:00:01 AM"])
    ['10:00:00', '10:00:01']
    >>> of_one_day(["03/04/2025 10:00:00", "04/04/2025 10:00:01"]), of_one_day(["03/03/2025 10:00"])
    (None, None)
    """
    found = [DATED.fullmatch(text) for text in texts]
    dated = [one for one in found if one is not None and one["hour"] is not None]
    days = {one.group("first", "second", "third") for one in dated}
    if len(dated) < len(texts) or len(days) != 1 or not day_or_month(texts[0]):
        return None
    return [_of_day(one) for one in dated]


def stamps(texts: list[str], form: str | None) -> Stamps | None:
    """Dates as written [ns] and whether they stated their zone; None where not all are alike."""
    import pandas as pd

    try:
        if form is None and min(map(len, texts), default=0) < 10:
            raise ValueError("a year and a month are no date")
        found = pd.DatetimeIndex(pd.to_datetime(texts, format=form or "ISO8601"))
        aware = found.tz is not None
        plain = found.tz_convert("UTC").tz_localize(None) if aware else found
        return plain.as_unit("ns").to_numpy().astype(np.int64, copy=True), aware
    except (ValueError, OverflowError, TypeError):
        return None


def stamps_of_block(texts: Sequence[str], form: str | None) -> Stamps | None:
    """As `stamps`, of some rows of a column; None too where other rows may say how they are read.

    >>> stamps_of_block(["1970-01-01T00:00:02Z"], None)
    (array([2000000000]), True)
    >>> stamps_of_block(["13/06/2026 09:12:00"], None), stamps_of_block(["2026-06-03"], None)
    (None, None)
    >>> stamps_of_block(["13-06-2026 09:12:00"], None)
    """
    plain: list[str] | None = [write_point(text.strip(), form) for text in texts]
    if form is None and plain and not ISO.match(plain[0]):
        first = DATED.fullmatch(write_marks(plain[0]))
        plain = as_iso(plain) if first and _order_as_written(first) else None
    if not plain or (form is None and len(plain[0]) <= len("2026-06-03")):
        return None
    return stamps(plain, form)


def write_point(text: str, form: str | None) -> str:
    """The text as its form has the decimals of its seconds."""
    return text.replace(",", ".") if form and "," not in form else text
