"""ASC files of Vector's tools to frames.

`0.015991 1  18EBFF00x       Rx   d 8 01 A0 0F A6 60 3B D1 40`: the stamp counts from the date of
the first trigger block, or else of the header, in the local time of the computer; with `timestamps
relative` it counts from the line before.
"""

import dataclasses
import re
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest.bytes import text_fields
from trialid.ingest.bytes.text_fields import Bools, Fields, Ints
from trialid.ingest.can import can_columns
from trialid.ingest.can.can_frames import Frames, Tally, date_stamps, join_frames

HEADER = 1 << 16
"""Bytes in which the header is looked for."""
DATE = re.compile(
    r"(?P<month>[^\W\d]{3,4})\.?\s+(?P<day>\d{1,2})\s+(?P<hour>\d{1,2}):(?P<minute>\d\d):"
    r"(?P<second>\d\d)(?:\.(?P<part>\d{1,6}))?(?:\s+(?P<half>[ap]m))?\s+(?P<year>\d{4})",
    re.IGNORECASE,
)
BEGINS = re.compile(
    r"^[ \t]*begin[ \t]+triggerblock[ \t]+\w+\.?[ \t]+(?P<date>.*)$", re.IGNORECASE | re.M
)
HEAD_DATE = re.compile(r"^[ \t]*date[ \t]+\w+\.?[ \t]+(?P<date>.*)$", re.IGNORECASE | re.M)
BASE = re.compile(
    r"^[ \t]*base[ \t]+(?P<base>hex|dec)([ \t]+timestamps[ \t]+(?P<stamps>\w+))?", re.I | re.M
)
MONTHS = {
    name: number
    for number, names in enumerate(
        (
            *("jan", "feb", "mar mär mrz maer", "apr", "may mai", "jun"),
            *("jul", "aug", "sep sept", "oct okt", "nov", "dec dez"),
        ),
        1,
    )
    for name in names.split()
}
"""Months as English and German systems write them."""
KEYWORDS = (b"date", b"base", b"no", b"internal", b"begin", b"end", b"//", b"previous")
EVENTS = (b"statistic:", b"start", b"stop", b"chip", b"overrun", b"cat")
"""What stands on lines that are neither frames nor strange."""


@dataclass(frozen=True)
class Header:
    """Base of the numbers, whether stamps count from the line before, and the start [ns local]."""

    base: int
    relative: bool
    start: int | None


def frames(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of the file, and words for their clock; LogError when there is none."""
    with path.open("rb") as file:
        header = _header(file.read(HEADER))
    parts = [
        _block(text_fields.fields(text, b" \t"), header, tally) for text in text_fields.blocks(path)
    ]
    whole = join_frames(parts)
    if not len(whole):
        raise LogError(f"{path}: none of its {tally.lines} lines is a CAN frame; copy it again")
    t = np.cumsum(whole.t) if header.relative else whole.t
    how = "each since the line before, added up" if header.relative else "since the start"
    if header.start is None:
        return dataclasses.replace(whole, t=t), f"line stamps ({how}; no date)"
    t, words = date_stamps(t + header.start, zone, tally)
    return dataclasses.replace(whole, t=t), f"line stamps ({how}; {words})"


def _header(head: bytes) -> Header:
    try:
        text = head.decode("utf-8")
    except UnicodeDecodeError:
        text = head.decode("cp1252", "replace")
    base = BASE.search(text)
    date = BEGINS.search(text) or HEAD_DATE.search(text)
    return Header(
        10 if base and base["base"].lower() == "dec" else 16,
        bool(base and (base["stamps"] or "").lower() == "relative"),
        _local(date["date"]) if date else None,
    )


def _local(text: str) -> int | None:
    """A date as the header has it [ns since 1970 of the local clock]; None when it is none.

    Vector writes three digits of milliseconds. One or two are what python-can writes, which leaves
    out the leading zeros: `20.1` is 20.001 s.
    """
    found = DATE.match(text.strip())
    if found is None or found["month"].lower() not in MONTHS:
        return None
    part = found["part"] or "0"
    micro = int(part) * (1000 if len(part) <= 3 else 10 ** (6 - len(part)))
    hour = int(found["hour"])
    if found["half"]:
        hour = hour % 12 + 12 * (found["half"].lower() == "pm")
    month, day, year = MONTHS[found["month"].lower()], int(found["day"]), int(found["year"])
    minute, second = int(found["minute"]), int(found["second"])
    try:
        date = datetime(year, month, day, hour, minute, second, tzinfo=UTC)
    except ValueError:
        return None
    if not 1970 <= year < 2250:
        return None
    return int(date.timestamp()) * 1_000_000_000 + micro * 1000


def _block(lines: Fields, header: Header, tally: Tally) -> Frames:
    """Data frames of a block of lines."""
    every = np.arange(len(lines))
    t, is_time = text_fields.seconds(lines.text, *lines.at(every, 0))
    bus, is_bus = can_columns.numbers(lines, every, 1, 10)
    framed = np.flatnonzero(is_time & is_bus & (lines.count > 4))
    start, end = lines.at(framed, 2)
    extended = (lines.text[end - 1] | 0x20) == ord("x")
    can_id, is_id = text_fields.integers(lines.text, start, end - extended, header.base)
    length, is_length = can_columns.numbers(lines, framed, 5, header.base)
    remote = is_id & can_columns.is_word(lines, framed, 4, b"r")
    data = is_id & is_length & can_columns.is_word(lines, framed, 4, b"d")
    rows = framed[data]
    made, good = can_columns.frames_of_rows(
        lines=lines,
        rows=rows,
        t=t[rows],
        can_id=can_id[data],
        extended=extended[data],
        length=length[data],
        data=6,
        bus=bus[rows],
        base=header.base,
    )
    _count(lines, is_time, is_bus, rows[good], framed[remote], tally)
    return made


def _count(
    lines: Fields, is_time: Bools, is_bus: Bools, used: Ints, remote: Ints, tally: Tally
) -> None:
    """What the lines are that hold no data frame."""
    every = np.arange(len(lines))
    known = np.zeros(len(lines), np.bool_)
    known[used] = known[remote] = True
    flexible = is_time & can_columns.is_word(lines, every, 1, b"canfd")
    error = is_time & can_columns.is_word(lines, every, 2, b"errorframe")
    tally.flexible += int(flexible.sum())
    tally.errors += int(error.sum())
    tally.remote += len(remote)
    known |= flexible | error | (is_time & ~is_bus)
    for word in KEYWORDS:
        known |= can_columns.is_word(lines, every, 0, word)
    for word in EVENTS:
        known |= is_time & can_columns.is_word(lines, every, 2, word)
    tally.lines += len(lines)
    tally.strange += int(np.sum(~known))
