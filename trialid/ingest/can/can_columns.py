"""Frames from the columns of a trace: what the text formats of Vector and PEAK have in common."""

import numpy as np

from trialid.ingest.bytes import text_fields
from trialid.ingest.bytes.text_fields import Bools, Fields, Ints
from trialid.ingest.can.can_frames import EXTENDED_ID, STANDARD_ID, Frames


def frames_of_rows(
    lines: Fields,
    rows: Ints,
    t: Ints,
    can_id: Ints,
    extended: Bools,
    length: Ints,
    data: Ints | int,
    bus: Ints,
    base: int = 16,
) -> tuple[Frames, Bools]:
    """Frames of the lines `rows` whose bytes are fields from number `data` on.

    All columns are (n,) for the n rows. Gives the frames of the rows that are right in all, and
    which rows these are. The index of a bus is its number, its name `CAN1`.
    """
    good = (length <= 8) & (lines.count[rows] >= data + length)
    good &= (can_id <= np.where(extended, EXTENDED_ID, STANDARD_ID)) & (bus < 256)
    length = np.where(good, length, 0)
    k = np.arange(8)
    used = k < length[:, None]
    index = np.minimum((lines.first[rows] + data)[:, None] + k, len(lines.start) - 1)[used]
    value, is_byte = text_fields.integers(lines.text, lines.start[index], lines.end[index], base)
    is_byte &= value < 256
    table = np.zeros(used.shape, np.uint8)
    table[used] = np.where(is_byte, value, 0)
    wrong = np.zeros(used.shape, np.bool_)
    wrong[used] = ~is_byte
    good &= ~wrong.any(axis=1)
    names = tuple(f"CAN{n}" for n in range(int(bus[good].max(initial=0)) + 1))
    frames = Frames(
        t=t[good],
        can_id=can_id[good],
        extended=extended[good],
        table=table[good],
        length=length[good],
        bus=bus[good],
        buses=names,
    )
    return frames, good


def is_word(lines: Fields, rows: Ints, field: int, word: bytes) -> Bools:
    """Which of these lines have a field of that number that begins so, in any case of letters."""
    there = lines.count[rows] > field
    start = lines.start[lines.first[rows] + np.where(there, field, 0)]
    alike = there
    for i, character in enumerate(word.lower()):
        alike = alike & ((lines.character(start + i) | 0x20) == (character | 0x20))
    return alike


def numbers(lines: Fields, rows: Ints, field: int, base: int) -> tuple[Ints, Bools]:
    """Whole numbers of the fields of that number; which lines have one."""
    there = lines.count[rows] > field
    index = lines.first[rows] + np.where(there, field, 0)
    value, good = text_fields.integers(lines.text, lines.start[index], lines.end[index], base)
    return value, good & there
