"""Frames of a CAN bus in columns, whatever file they came from."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.times import local_time
from trialid.recording import ZONELESS

Ints = NDArray[np.int64]

EXTENDED_ID = 0x1FFF_FFFF
STANDARD_ID = 0x7FF


@dataclass(frozen=True)
class Frames:
    """N data frames of up to 8 bytes, in the order of the log.

    Parameters
    ----------
    t
        Stamps [ns]; (N,).
    can_id
        Identifiers of 11 or, where `extended`, 29 bits; (N,).
    table, length
        Data bytes (N, 8), of which `length` count, (N,); those behind are zero.
    bus
        Index of the bus of each in `buses`; (N,).
    """

    t: Ints
    can_id: Ints
    extended: NDArray[np.bool_]
    table: NDArray[np.uint8]
    length: Ints
    bus: Ints
    buses: tuple[str, ...] = ("",)

    def __len__(self) -> int:
        return len(self.t)


@dataclass
class Tally:
    """What a reading came across besides data frames."""

    lines: int = 0
    strange: int = 0
    remote: int = 0
    errors: int = 0
    flexible: int = 0
    remarks: list[str] = field(default_factory=list)

    def told(self) -> list[str]:
        """Remarks on it, what was lost first."""
        words = []
        if self.strange:
            words.append(f"{self.strange} of {self.lines} lines are not frames, left out")
        for count, what in (
            (self.errors, "error frames"),
            (self.remote, "remote frames, which carry no data,"),
            (self.flexible, "CAN FD frames"),
        ):
            if count:
                words.append(f"{count} {what} left out")
        return [*self.remarks, *words]


def join_frames(parts: Sequence[Frames]) -> Frames:
    """One after the other; a bus of the same name is the same bus."""
    parts = [part for part in parts if len(part)]
    names = tuple(sorted({name for part in parts for name in part.buses})) or ("",)
    if not parts:
        return no_frames()
    bus = [np.array([names.index(n) for n in part.buses], np.int64)[part.bus] for part in parts]
    return Frames(
        t=np.concatenate([part.t for part in parts]),
        can_id=np.concatenate([part.can_id for part in parts]),
        extended=np.concatenate([part.extended for part in parts]),
        table=np.concatenate([part.table for part in parts]),
        length=np.concatenate([part.length for part in parts]),
        bus=np.concatenate(bus),
        buses=names,
    )


def no_frames() -> Frames:
    """No frames."""
    none, table = np.zeros(0, np.int64), np.zeros((0, 8), np.uint8)
    return Frames(none, none, none > 0, table, none, none)


def select_frames(frames: Frames, rows: NDArray[np.bool_] | Ints) -> Frames:
    """These frames of them."""
    return Frames(
        t=frames.t[rows],
        can_id=frames.can_id[rows],
        extended=frames.extended[rows],
        table=frames.table[rows],
        length=frames.length[rows],
        bus=frames.bus[rows],
        buses=frames.buses,
    )


def date_stamps(t: Ints, zone: str | None, tally: Tally) -> tuple[Ints, str]:
    """Stamps that count from a local date in UTC, and words for it; a remark without a zone."""
    if zone is not None:
        return local_time.utc(t, zone), f"start in {zone}"
    tally.remarks.append(
        "the header's date is of a local clock, of which time zone it does not say: taken as UTC; "
        "`zone` can state it"
    )
    return t, f"start local, zone not stated, {ZONELESS}"
