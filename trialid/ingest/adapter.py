"""What an adapter is: how to recognise a log from its first bytes, and how to read it."""

import hashlib
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from trialid.recording import Recording

Wanted = Collection[str] | None


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
        Path and wanted channels to Recording. Wanted are channel names or their beginnings, None
        for all; what nobody wants may be skipped. It converts names and stamps, nothing else: no
        filtering, no resampling, no repair.
    """

    name: str
    recognises: Callable[[bytes], bool]
    read: Callable[[Path, Wanted], Recording]


def asked(channel: str, wanted: Wanted) -> bool:
    """True when a channel of this name is wanted.

    >>> asked("/imu:orientation.x", ["/imu:orientation", "/rudder:data"])
    True
    >>> asked("/gnss:speed", ["/imu:orientation"]), asked("/gnss:speed", None)
    (False, True)
    """
    return wanted is None or channel.startswith(tuple(wanted))


def sha256(path: Path) -> str:
    """SHA-256 of the file's bytes, in hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
