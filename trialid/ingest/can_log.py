"""Logs of a CAN bus: candump text, and the files of Vector, PEAK and python-can.

Frames with 29 bit identifiers are read as NMEA 2000, unless `dbc` names a file that says what the
frames mean: then a channel is `Message:signal`. Where frames of several interfaces are read, the
source of a channel begins with the interface: `rudder/can1.11/255:position`, `Message/can1:signal`.
"""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest import can_candump, nmea2000, nmea2000_frames
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, sha256
from trialid.ingest.can_frames import Frames, Tally
from trialid.recording import Channel, Recording

Reader = Callable[[Path, str | None, Tally], tuple[Frames, str]]

CANDUMP = re.compile(
    rb"\s*(\([0-9. :-]+\)\s+)?(\S{1,15}\s+[0-9A-Fa-f]{3,8}#|"
    rb"\S{1,15}\s+([RT]X\s+\S\s+\S\s+)?[0-9A-Fa-f]{3,8}\s+\[\d{1,2}\]|"
    rb"<0x[0-9A-Fa-f]{3,8}>\s+\[\d\])"
)


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


def read_with(reader: Reader, name: str) -> Callable[[Path, Wanted, Aids], Recording]:
    """Reading of a file whose frames come from `reader`."""

    def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
        tally = Tally()
        frames, clock = reader(path, aids.zone, tally)
        if aids.dbc is not None:
            from trialid.ingest import can_dbc

            channels, remarks = can_dbc.channels(frames, aids.dbc, clock, wanted)
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
    rows = np.flatnonzero(extended)
    whole = nmea2000_frames.assemble(
        frames.t[rows], frames.can_id[rows], frames.table[rows], frames.length[rows],
        frames.bus[rows],
    )  # fmt: skip
    several = len(np.unique(frames.bus[rows])) > 1
    channels, remarks = nmea2000.channels(
        whole.t,
        whole.pgn,
        whole.source,
        whole.payloads,
        clock,
        wanted,
        frames.buses if several else (),
    )
    if len(rows) < len(frames):
        odd = len(frames) - len(rows)
        remarks.append(f"{odd} of {len(frames)} frames have 11 bit identifiers, not NMEA 2000")
    if whole.lost:
        words = f"{whole.lost} of {whole.packets} messages of several frames lack a frame"
        remarks.append(f"{words}, left out")
    return channels, remarks


ADAPTERS = (
    Adapter(
        "candump",
        is_candump,
        read_with(can_candump.frames, "candump"),
        frozenset({"dbc", "zone"}),
    ),
)
