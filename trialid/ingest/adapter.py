"""What an adapter is: how to recognise a log from its first bytes, and how to read it.

Channels are named `message:field`, and `message/source:field` where several devices send the same
message: `/imu:angular_velocity.z`, `rudder/11/255:position`, `ROT/HE:rate`, `ATTITUDE/1/1:roll`.
Two sources are two channels, never one. A table's columns keep their bare names.
"""

import functools
import hashlib
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, fields
from pathlib import Path

from trialid.recording import Recording

Wanted = Collection[str] | None


@dataclass(frozen=True)
class Aids:
    """What a log cannot say about itself, and the user does.

    Parameters
    ----------
    template
        File that says how a table is laid out.
    dbc
        File that says what the frames of a CAN bus mean that is not NMEA 2000.
    zone
        Time zone of stamps that state none, an IANA name: `Europe/Oslo`.
    """

    template: Path | None = None
    dbc: Path | None = None
    zone: str | None = None

    @property
    def given(self) -> tuple[str, ...]:
        """Names of those that are given."""
        return tuple(one.name for one in fields(self) if getattr(self, one.name) is not None)


NO_AIDS = Aids()


def whole(path: Path, aids: Aids) -> Iterable[Wanted]:
    """All channels in one reading."""
    del path, aids
    return (None,)


@dataclass(frozen=True)
class Adapter:
    """One log format.

    Parameters
    ----------
    name
        What messages and results call the format.
    recognises
        True when the first bytes of a file are of this format; the file's name plays no part.
    read
        Path, wanted channels and aids to Recording. Wanted are channel names or their beginnings,
        None for all; what nobody wants may be skipped. It converts names and stamps, nothing else:
        no filtering, no resampling, no repair.
    aids
        Names of the aids it can use; any other that is given is refused.
    batches
        For who wants to see every channel of a log of any size: readings that together give all
        channels, each within a few hundred megabytes of memory.
    general
        True for a format so loose that any other that recognises the file is meant.
    by_template
        For formats that a template can lay out: True when the first bytes are of a file that the
        format may hold, whatever its content looks like; None when `recognises` says it all.
    nearly
        For formats with a near miss: what the first bytes of a file that it does not recognise
        lack, in words; None where that cannot be told.
    """

    name: str
    recognises: Callable[[bytes], bool]
    read: Callable[[Path, Wanted, Aids], Recording]
    aids: frozenset[str] = frozenset()
    batches: Callable[[Path, Aids], Iterable[Wanted]] = whole
    general: bool = False
    by_template: Callable[[bytes], bool] | None = None
    nearly: Callable[[bytes], str | None] | None = None


def is_wanted(channel: str, wanted: Wanted) -> bool:
    """True when a channel of this name is wanted.

    >>> is_wanted("/imu:orientation.x", ["/imu:orientation", "/rudder:data"])
    True
    >>> is_wanted("/gnss:speed", ["/imu:orientation"]), is_wanted("/gnss:speed", None)
    (False, True)
    """
    return wanted is None or channel.startswith(tuple(wanted))


State = tuple[Path, int, int, int]
"""A file as it is now: place, node, size and last change [ns]."""


def state(path: Path) -> State:
    """What tells one state of a file from another; what was found in one is found in it again."""
    now = path.stat()
    return path.resolve(), now.st_ino, now.st_size, now.st_mtime_ns


def sha256(path: Path) -> str:
    """SHA-256 of the file's bytes, in hexadecimal; once for a log that is read in batches."""
    return _sha256(state(path))


@functools.lru_cache(maxsize=16)
def _sha256(of: State) -> str:
    with of[0].open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
