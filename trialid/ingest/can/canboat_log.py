"""Logs of NMEA 2000 as lines of text: canboat, Yacht Devices and Actisense gateways.

canboat writes `2016-02-28T19:57:02.364Z,2,127250,7,255,8,ff,..`, whole messages (FAST) or single
frames (PLAIN); Yacht Devices `16:29:27.082 R 09F8017F 50 C3 ..`, frames; Actisense `A173321.107
23FF7 1F513 012F30..`, messages. The two last state the time of the day and no date: their stamps
count from the midnight before the log, and no date is made up.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, sha256
from trialid.ingest.bytes import text_fields
from trialid.ingest.bytes.text_fields import DAY_NS, SECOND_NS, Bools, Fields, Ints
from trialid.ingest.nmea2000 import nmea2000_frames, nmea2000_messages
from trialid.ingest.nmea2000.nmea2000_messages import FAST, NEEDED, Payloads
from trialid.recording import Recording

CANBOAT = re.compile(
    rb"\d{4}-\d\d-\d\d[T-]\d\d:\d\d:\d\d[.\d]*Z?,\d,\d{1,6},\d{1,3},\d{1,3},\d{1,3},"
)
YACHT_DEVICES = re.compile(rb"\d\d:\d\d:\d\d\.\d+ [RT] [0-9A-Fa-f]{8}( [0-9A-Fa-f]{2})*\s*$")
ACTISENSE = re.compile(rb"A\d{6}\.\d+ [0-9A-Fa-f]{5} [0-9A-Fa-f]{5,6} [0-9A-Fa-f]*\s*$")

WHOLE = re.compile(rb"#\s*format\s*=\s*FAST", re.IGNORECASE)
"""A first comment by which every line is a whole message."""
HEADER = 4096
LONGEST = 1785
"""Bytes of a message of the transport protocol, the longest of the bus."""


DATED = "line stamps"
UNDATED = "line stamps (time of the day, no date)"


@dataclass(frozen=True)
class Lines:
    """Messages or frames of N lines of a block, and how many lines were read and how many not."""

    t: Ints
    pgn: Ints
    source: Ints
    payloads: Payloads
    lines: int
    strange: int


@dataclass(frozen=True)
class Form:
    """How a kind of line is written; `framed` says lines of up to 8 bytes may be single frames."""

    name: str
    pattern: re.Pattern[bytes]
    separators: bytes
    clock: str
    framed: bool
    parse: Callable[[Fields], Lines]


def _adapter(form: Form) -> Adapter:
    def recognises(head: bytes) -> bool:
        """At least half the whole lines, comments aside, are of this form."""
        lines = head.split(b"\n")
        whole = lines[:-1] if len(lines) > 1 else lines
        told = [line for line in whole if line.strip() and not line.startswith(b"#")]
        alike = sum(form.pattern.match(line) is not None for line in told)
        return b"\0" not in head and alike > 0 and 2 * alike >= len(told)

    def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
        del aids
        return _read(form, path, wanted)

    return Adapter(form.name, recognises, read)


def _read(form: Form, path: Path, wanted: Wanted) -> Recording:
    blocks = text_fields.blocks(path)
    parts = [form.parse(text_fields.fields(block, form.separators)) for block in blocks]
    lines, strange = sum(part.lines for part in parts), sum(part.strange for part in parts)
    if lines == strange:
        raise LogError(f"{path}: none of its {lines} lines is a {form.name} line; copy it again")
    remarks = [f"{strange} of {lines} lines are no messages, left out"] if strange else []
    with path.open("rb") as file:
        framed = form.framed and not WHOLE.search(file.read(HEADER))
    t = np.concatenate([part.t for part in parts])
    whole = Lines(
        t if form.clock == DATED else _over_midnight(t),
        np.concatenate([part.pgn for part in parts]),
        np.concatenate([part.source for part in parts]),
        _stacked([part.payloads for part in parts]),
        lines,
        strange,
    )
    if framed:
        whole = _assembled(whole, remarks)
    channels, more = nmea2000_messages.channels(
        whole.t, whole.pgn, whole.source, whole.payloads, form.clock, wanted
    )
    return Recording(path, form.name, sha256(path), channels, (*remarks, *more))


def _over_midnight(t: Ints) -> Ints:
    """Times of the day that go on beyond midnight instead of beginning anew."""
    step = np.diff(t, prepend=t[:1])
    days = np.cumsum((step < -DAY_NS // 2).astype(np.int64) - (step > DAY_NS // 2))
    return t + days * DAY_NS


def _stacked(parts: list[Payloads]) -> Payloads:
    sizes = np.array([len(part.buffer) for part in parts], np.int64)
    before = np.cumsum(sizes) - sizes
    return Payloads(
        np.concatenate([part.buffer for part in parts]),
        np.concatenate([part.start + at for part, at in zip(parts, before, strict=True)]),
        np.concatenate([part.length for part in parts]),
    )


def _assembled(lines: Lines, remarks: list[str]) -> Lines:
    """Fast packets joined, where their frames stand in lines of their own."""
    data = lines.payloads
    frames = np.isin(lines.pgn, list(FAST)) & (data.length <= 8) & (data.length > 1)
    rows = np.flatnonzero(frames)
    if not len(rows):
        return lines
    places = data.start[rows][:, None] + np.arange(8)
    inside = np.arange(8) < data.length[rows][:, None]
    table = np.where(inside, data.buffer[np.where(inside, places, 0)], 0).astype(np.uint8)
    t, pgn, source = lines.t[rows], lines.pgn[rows], lines.source[rows]
    every = np.arange(len(rows))
    first, joined, packets = nmea2000_frames.join_packets(
        t, pgn, source, every, table, data.length[rows]
    )
    if packets > len(first):
        lost = packets - len(first)
        remarks.append(f"{lost} of {packets} messages of several frames lack a frame, left out")
    kept = np.flatnonzero(~frames)
    chosen = np.concatenate([kept, rows[first]])
    rest = Payloads(data.buffer, data.start[kept], data.length[kept])
    return Lines(
        lines.t[chosen],
        lines.pgn[chosen],
        lines.source[chosen],
        _stacked([rest, joined]),
        lines.lines,
        lines.strange,
    )


def _canboat(lines: Fields) -> Lines:
    """`2016-02-28T19:57:02.364Z,2,127250,7,255,8,ff,..`: stamp, priority, group, source, ..."""
    text, comment = lines.text, _comments(lines)
    rows = np.flatnonzero(~comment & (lines.count >= 6))
    start, end = lines.at(rows, 0)
    end = end - (text[end - 1] == ord("Z"))
    long = end - start > 18
    rows, start, end = rows[long], start[long], end[long]
    day, is_day = text_fields.date(text, start)
    hour, is_hour = text_fields.time_of_day(text, start + 11, end)
    numbers = [text_fields.integers(text, *lines.at(rows, k), 10) for k in range(1, 6)]
    _, pgn, source, _, length = (number for number, _ in numbers)
    good = is_day & is_hour & np.all([fine for _, fine in numbers], axis=0) & (source < 256)
    good &= (length <= LONGEST) & (lines.count[rows] >= 6 + length)
    return _spaced(
        lines=lines,
        comment=comment,
        rows=rows[good],
        t=(day + hour)[good],
        pgn=pgn[good],
        source=source[good],
        field=6,
        length=length[good],
    )


def _yacht_devices(lines: Fields) -> Lines:
    """`16:29:27.082 R 09F8017F 50 C3 ..`: a frame as the gateway received or sent it."""
    text, comment = lines.text, _comments(lines)
    rows = np.flatnonzero(~comment & (lines.count >= 3) & (lines.count <= 11))
    t, is_time = text_fields.time_of_day(text, *lines.at(rows, 0))
    start, end = lines.at(rows, 2)
    can_id, is_id = text_fields.integers(text, start, end, 16)
    side = text[lines.at(rows, 1)[0]]
    good = is_time & is_id & (end - start == 8) & ((side == ord("R")) | (side == ord("T")))
    pgn, source = nmea2000_frames.group_and_source(can_id[good])
    rows = rows[good]
    return _spaced(
        lines=lines,
        comment=comment,
        rows=rows,
        t=t[good],
        pgn=pgn,
        source=source,
        field=3,
        length=lines.count[rows] - 3,
    )


def _actisense(lines: Fields) -> Lines:
    """`A173321.107 23FF7 1F513 012F30..`: time, source with destination and priority, group."""
    text, comment = lines.text, _comments(lines)
    rows = np.flatnonzero(~comment & (lines.count == 4))
    start, end = lines.at(rows, 0)
    clock, is_clock = text_fields.integers(text, start + 1, np.minimum(start + 7, end), 10)
    rest, is_rest = text_fields.seconds(text, np.minimum(start + 5, end), end)
    hour, minute = clock // 10000, clock // 100 % 100
    sender, is_sender = text_fields.integers(text, *lines.at(rows, 1), 16)
    pgn, is_group = text_fields.integers(text, *lines.at(rows, 2), 16)
    start_data, end_data = lines.at(rows, 3)
    digits = end_data - start_data
    good = is_clock & is_rest & is_sender & is_group & (digits % 2 == 0) & (digits <= 2 * LONGEST)
    good &= (hour < 24) & (minute < 60) & (rest < 61 * SECOND_NS) & (text[start] == ord("A"))
    t, source = (hour * 60 + minute) * 60 * SECOND_NS + rest, sender >> 12
    return _gathered(
        lines=lines,
        comment=comment,
        rows=rows[good],
        t=t[good],
        pgn=pgn[good],
        source=source[good] & 0xFF,
        start=start_data[good],
        step=2,
        length=digits[good] // 2,
    )


def _comments(lines: Fields) -> Bools:
    return lines.text[lines.start[lines.first]] == ord("#")


def _spaced(
    lines: Fields, comment: Bools, rows: Ints, t: Ints, pgn: Ints, source: Ints,
    field: int, length: Ints,
) -> Lines:  # fmt: skip
    """Messages whose bytes are fields of two digits, from this field on."""
    first = lines.first[rows] + field
    last = np.minimum(first + np.maximum(length - 1, 0), len(lines.start) - 1)
    begins = lines.start[np.minimum(first, len(lines.start) - 1)]
    regular = (length == 0) | (lines.end[last] - begins == 3 * length - 1)
    return _gathered(
        lines=lines,
        comment=comment,
        rows=rows[regular],
        t=t[regular],
        pgn=pgn[regular],
        source=source[regular],
        start=begins[regular],
        step=3,
        length=length[regular],
    )


def _gathered(
    lines: Fields, comment: Bools, rows: Ints, t: Ints, pgn: Ints, source: Ints,
    start: Ints, step: int, length: Ints,
) -> Lines:  # fmt: skip
    """Messages whose bytes begin at `start`, each `step` characters after the one before."""
    total = int(np.sum(~comment))
    strange = total - len(rows)
    needed = np.isin(pgn, list(NEEDED))
    t, pgn, source, start, length = (one[needed] for one in (t, pgn, source, start, length))
    first = np.cumsum(length) - length
    count = np.arange(int(length.sum())) - np.repeat(first, length)
    places = np.repeat(start, length) + step * count
    octets, is_octet = text_fields.octets(lines.text, places)
    wrong = np.bincount(np.repeat(np.arange(len(t)), length)[~is_octet], minlength=len(t)) > 0
    payloads = Payloads(octets, first[~wrong], length[~wrong])
    strange += int(wrong.sum())
    return Lines(t[~wrong], pgn[~wrong], source[~wrong], payloads, total, strange)


ADAPTERS = (
    _adapter(Form("canboat", CANBOAT, b",", DATED, True, _canboat)),
    _adapter(Form("yacht devices", YACHT_DEVICES, b" \t", UNDATED, True, _yacht_devices)),
    _adapter(Form("actisense", ACTISENSE, b" \t", UNDATED, False, _actisense)),
)
