"""TRC files of PEAK's tools to frames, of all versions.

What the columns are stands in the header (`;$COLUMNS=N,O,T,B,I,d,R,L,D`) or follows from the
version. The stamp O counts milliseconds from the start in the header, days since 30 December 1899
in the local time of the computer.
"""

import dataclasses
import re
from decimal import Decimal
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest.bytes import text_fields
from trialid.ingest.bytes.text_fields import DAY_NS, Fields
from trialid.ingest.can import can_columns
from trialid.ingest.can.can_frames import Frames, Tally, date_stamps, join_frames

HEADER = 1 << 16
VERSION = re.compile(rb"^;\$FILEVERSION=(?P<version>[\d.]+)", re.M)
COLUMNS = re.compile(rb"^;\$COLUMNS=(?P<columns>[\w,]+)", re.M)
START = re.compile(rb"^;\$STARTTIME=(?P<days>\d{1,6}(\.\d{1,20})?)\s*$", re.M)
BEFORE_1970 = 25_569
"""Days from 30 December 1899 to 1 January 1970."""
LAYOUTS = {
    "1.0": "N,O,I,L,D",
    "1.1": "N,O,d,I,L,D",
    "1.2": "N,O,B,d,I,L,D",
    "1.3": "N,O,B,d,I,R,L,D",
    "2.0": "N,O,T,I,d,l,D",
    "2.1": "N,O,T,B,I,d,R,L,D",
}
KINDS = {b"rr": "remote", b"er": "errors", b"fd": "flexible", b"fb": "flexible"} | {
    b"fe": "flexible", b"bi": "flexible", b"error": "errors"
}  # fmt: skip


def frames(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of the file, and words for their clock; LogError when there is none."""
    with path.open("rb") as file:
        head = file.read(HEADER)
    columns = _columns(path, head)
    parts = [
        _block(text_fields.fields(text, b" \t"), columns, tally)
        for text in text_fields.blocks(path)
    ]
    whole = join_frames(parts)
    if not len(whole):
        raise LogError(f"{path}: none of its {tally.lines} lines is a CAN frame; copy it again")
    start = START.search(head)
    if start is None:
        return whole, "line stamps (since the start; no date)"
    days = Decimal(start["days"].decode()) - BEFORE_1970
    t, words = date_stamps(whole.t + int(days * DAY_NS), zone, tally)
    return dataclasses.replace(whole, t=t), f"line stamps (since the start; {words})"


def _columns(path: Path, head: bytes) -> dict[str, int]:
    """Number of the field of each column."""
    version, stated = VERSION.search(head), COLUMNS.search(head)
    number = version["version"].decode() if version else "1.0"
    if stated is None and number not in LAYOUTS:
        raise LogError(f"{path}: is TRC of version {number}; known: {', '.join(LAYOUTS)}")
    text = stated["columns"].decode() if stated else LAYOUTS[number]
    columns = {name: i for i, name in enumerate(text.split(","))}
    if not {"O", "I", "D"} <= set(columns) or not {"L", "l"} & set(columns):
        raise LogError(f"{path}: its columns {text} lack one of O, I, L and D; write it anew")
    return columns


def _block(lines: Fields, columns: dict[str, int], tally: Tally) -> Frames:
    """Data frames of a block of lines."""
    comment = lines.text[lines.start[lines.first]] == ord(";")
    tally.lines += int(np.sum(~comment))
    rows = np.flatnonzero(~comment & (lines.count > columns["D"] - 1))
    other = np.zeros(len(rows), np.bool_)
    for word, kind in KINDS.items():
        column = columns.get("T", columns.get("d"))
        if column is not None:
            alike = can_columns.is_word(lines, rows, column, word) & ~other
            setattr(tally, kind, getattr(tally, kind) + int(alike.sum()))
            other |= alike
    request = can_columns.is_word(lines, rows, columns["D"], b"rtr") & ~other
    tally.remote += int(request.sum())
    rows, kept = rows[~(other | request)], int(np.sum(other | request))
    start, end = lines.at(rows, columns["I"])
    can_id, is_id = text_fields.integers(lines.text, start, end, 16)
    t, is_time = text_fields.seconds(lines.text, *lines.at(rows, columns["O"]))
    length, is_length = can_columns.numbers(lines, rows, columns.get("L", columns.get("l", 0)), 10)
    bus = np.ones(len(rows), np.int64)
    is_bus = np.ones(len(rows), np.bool_)
    if "B" in columns:
        bus, is_bus = can_columns.numbers(lines, rows, columns["B"], 10)
    good = is_id & is_time & is_length & is_bus
    frames, used = can_columns.frames_of_rows(
        lines=lines,
        rows=rows[good],
        t=t[good] // 1000,
        can_id=can_id[good],
        extended=(end - start)[good] > 4,
        length=length[good],
        data=columns["D"],
        bus=bus[good],
    )
    tally.strange += int(np.sum(~comment)) - kept - int(used.sum())
    return frames
