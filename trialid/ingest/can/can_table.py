"""CSV files that python-can writes to frames.

They hold seconds since 1970, identifier, whether it is extended, remote, an error, and the data.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.bytes import text_fields
from trialid.ingest.bytes.text_fields import Bools, Fields, Ints
from trialid.ingest.can.can_frames import EXTENDED_ID, Frames, Tally, join_frames

CSV_HEAD = b"timestamp,arbitration_id,extended,remote,error,dlc,data"

SIXES = np.full(256, 99, np.int64)
"""Value of a character of base64; 99 for any other."""
for _value, _character in enumerate(
    b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
):
    SIXES[_character] = _value
NUMPY = b"np.float64("
"""What stands before a stamp that was handed over as a numpy number."""


def is_csv(head: bytes) -> bool:
    """The header row of python-can's CSV."""
    return head.lstrip(b"\xef\xbb\xbf").startswith(CSV_HEAD)


def of_csv(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of a CSV file, and words for their clock; LogError when there is none."""
    del zone
    parts = [_rows(text_fields.fields(b, b","), tally) for b in text_fields.blocks(path)]
    whole = join_frames(parts)
    tally.lines, tally.strange = tally.lines - 1, tally.strange - 1  # the header row
    if not len(whole):
        raise LogError(f"{path}: none of its {tally.lines} rows is a CAN frame; copy it again")
    return whole, "column timestamp"


def _rows(lines: Fields, tally: Tally) -> Frames:
    """Frames of rows `1483389946.197,0x00dadada,1,0,0,6,WzQyLCA5XQ==`; no data, no last field."""
    rows = np.flatnonzero((lines.count == 7) | (lines.count == 6))
    start, end = lines.at(rows, 0)
    dressed = lines.text[start] == ord("n")
    t, good = text_fields.seconds(lines.text, start + len(NUMPY) * dressed, end - dressed)
    start, end = lines.at(rows, 1)
    can_id, is_id = text_fields.integers(lines.text, np.minimum(start + 2, end), end, 16)
    good &= is_id & (can_id <= EXTENDED_ID)
    flags = [text_fields.integers(lines.text, *lines.at(rows, k), 10) for k in range(2, 6)]
    (extended, remote, error, length), fine = zip(*flags, strict=True)
    good &= np.all(fine, axis=0)
    plain = good & (remote == 0) & (error == 0)
    table, is_data = _base64(lines, rows, length)
    used = plain & is_data & (length <= 8)
    tally.lines += len(lines)
    tally.errors += int(np.sum(good & (error == 1)))
    tally.remote += int(np.sum(good & (error == 0) & (remote == 1)))
    tally.flexible += int(np.sum(plain & (length > 8) & (length <= 64)))
    known = used | (good & ((error == 1) | (remote == 1))) | (plain & (length > 8) & (length <= 64))
    tally.strange += len(lines) - int(known.sum())
    none = np.zeros(int(used.sum()), np.int64)
    return Frames(t[used], can_id[used], extended[used] == 1, table[used], length[used], none)


def _base64(lines: Fields, rows: Ints, length: Ints) -> tuple[NDArray[np.uint8], Bools]:
    """Data bytes (n, 8) of the last fields, and which are right."""
    there = lines.count[rows] == 7
    index = lines.first[rows] + np.where(there, 6, 0)
    start, width = lines.start[index], np.where(there, lines.end[index] - lines.start[index], 0)
    places = start[:, None] + np.arange(12)
    six = SIXES[lines.character(places)]
    needed = (np.minimum(length, 8)[:, None] * 8 + 5) // 6
    used = np.arange(12) < needed
    good = (width == 4 * ((length + 2) // 3)) & (~used | (six < 64)).all(axis=1)
    four = np.where(used, six, 0).reshape(-1, 3, 4)
    three = (four[..., 0] << 18) | (four[..., 1] << 12) | (four[..., 2] << 6) | four[..., 3]
    octets = np.stack([three >> 16, three >> 8 & 0xFF, three & 0xFF], axis=-1).reshape(-1, 9)[:, :8]
    return np.where(np.arange(8) < length[:, None], octets, 0).astype(np.uint8), good
