"""Logs of a CAN bus: candump text, and the files of Vector, PEAK, ASAM and python-can.

Frames with 29 bit identifiers are read as NMEA 2000, unless `dbc` names a file that says what the
frames mean: then a channel is `Message:signal`. Where frames of several interfaces are read, the
source of a channel begins with the interface: `rudder/can1.11/255:position`, `Message/can1:signal`.
"""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, sha256
from trialid.ingest.can import asc, blf, can_table, candump, mf4, sqlite, trc
from trialid.ingest.can.can_frames import Frames, Tally
from trialid.ingest.nmea2000 import nmea2000_frames, nmea2000_messages
from trialid.recording import Channel, Recording

Reader = Callable[[Path, str | None, Tally], tuple[Frames, str]]

CANDUMP = re.compile(
    rb"\s*(\([0-9. :-]+\)\s+)?(\S{1,15}\s+[0-9A-Fa-f]{3,8}#|"
    rb"\S{1,15}\s+([RT]X\s+\S\s+\S\s+)?[0-9A-Fa-f]{3,8}\s+\[\d{1,2}\]|"
    rb"<0x[0-9A-Fa-f]{3,8}>\s+\[\d\])"
)


ASC = re.compile(
    rb"\A\s*(//[^\n]*\n\s*)*(date\s[^\n]*\n\s*(//[^\n]*\n\s*)*)?base\s+(hex|dec)", re.IGNORECASE
)
TRC = re.compile(rb"\s*;(\$FILEVERSION=\d|#{20})")


def lines_of(head: bytes) -> list[bytes]:
    """Whole lines of the first bytes of a file that are neither blank nor comments."""
    lines = head.split(b"\n")
    whole = lines[:-1] if len(lines) > 1 else lines
    return [line for line in whole if line.strip() and not line.lstrip().startswith(b"#")]


def is_candump(head: bytes) -> bool:
    """Lines of which at least half look like candump's."""
    lines = lines_of(head)
    alike = sum(CANDUMP.match(line) is not None for line in lines)
    return b"\0" not in head and alike > 0 and 2 * alike >= len(lines)


def is_asc(head: bytes) -> bool:
    """A date and the base of the numbers at the beginning of a text."""
    return b"\0" not in head and ASC.search(head) is not None


def is_trc(head: bytes) -> bool:
    """PEAK's version line, or the head of its first version."""
    return b"\0" not in head and TRC.match(head) is not None


def is_blf(head: bytes) -> bool:
    """The magic bytes of BLF."""
    return head.startswith(b"LOGG")


def read_with(reader: Reader, name: str) -> Callable[[Path, Wanted, Aids], Recording]:
    """Reading of a file whose frames come from `reader`."""

    def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
        tally = Tally()
        frames, clock = reader(path, aids.zone, tally)
        if aids.dbc is not None:
            from trialid.ingest.can import dbc

            channels, remarks = dbc.channels(frames, aids.dbc, clock, wanted)
        else:
            channels, remarks = _nmea2000(path, frames, clock, wanted)
        return Recording(path, name, sha256(path), channels, (*tally.told(), *remarks))

    return read


def _nmea2000(
    path: Path, frames: Frames, clock: str, wanted: Wanted
) -> tuple[dict[str, Channel], list[str]]:
    """Channels of the frames with 29 bit identifiers."""
    extended = frames.extended
    if not extended.any():
        raise LogError(
            f"{path}: none of its {len(frames)} frames has a 29 bit identifier, so it is not NMEA "
            "2000; name the file that says what the frames mean with `dbc`"
        )
    count = int(extended.sum())
    rows = slice(None) if count == len(frames) else extended
    several = len(np.unique(frames.bus[rows])) > 1
    whole = nmea2000_frames.assemble(
        frames.t[rows], frames.can_id[rows], frames.table[rows], frames.length[rows],
        frames.bus[rows] if several else 0,
    )  # fmt: skip
    channels, remarks = nmea2000_messages.channels(
        t=whole.t,
        pgn=whole.pgn,
        source=whole.source,
        payloads=whole.payloads,
        clock=clock,
        wanted=wanted,
        buses=frames.buses if several else (),
    )
    if count < len(frames):
        odd = len(frames) - count
        remarks.append(f"{odd} of {len(frames)} frames have 11 bit identifiers, not NMEA 2000")
    if whole.lost:
        words = f"{whole.lost} of {whole.packets} messages of several frames lack a frame"
        remarks.append(f"{words}, left out")
    return channels, remarks


def _adapter(name: str, recognises: Callable[[bytes], bool], reader: Reader, *aids: str) -> Adapter:
    return Adapter(name, recognises, read_with(reader, name), frozenset(aids))


ADAPTERS = (
    _adapter("candump", is_candump, candump.frames, "dbc", "zone"),
    _adapter("asc", is_asc, asc.frames, "dbc", "zone"),
    _adapter("trc", is_trc, trc.frames, "dbc", "zone"),
    _adapter("blf", is_blf, blf.frames, "dbc", "zone"),
    _adapter("mf4", mf4.is_mf4, mf4.frames, "dbc"),
    _adapter("python-can csv", can_table.is_csv, can_table.of_csv, "dbc"),
    _adapter("python-can sqlite", sqlite.is_sqlite, sqlite.of_sqlite, "dbc"),
)
