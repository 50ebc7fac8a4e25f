"""What a log may cost in all: the sum of what it unpacks to, its messages, its channels.

A bound on each piece alone holds nothing: a thousand pieces of the largest size are let through.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from trialid.errors import LogError

FEW_BYTES: Final = 500_000_000
BYTES_A_BYTE: Final = 50
"""A file may unpack to so many bytes, or to so many for each that it has. It lies
far above what numbers of sensors pack to, and the bytes are not all held at once; a recording that
never changes packs further and has the first bound. Twice of that lets a file of a megabyte
unpack to a gigabyte."""
FEW_MESSAGES: Final = 2_000_000
BYTES_A_MESSAGE: Final = 4
"""A file may hold so many messages, or one for so many of its bytes: a million of
messages that differ by their stamps alone packed to 19 bytes each and took 1.2 s of computing,
those of an attack to a thirtieth of a byte. Half of it refuses an unchanging log sooner, twice
doubles the time."""
MOST_CHANNELS: Final = 10_000
"""As of a table: no ship has so many, and every one is a row to look at."""
MOST_WHOLE: Final = 4_000_000_000
"""Bytes of a file that is read into memory at once; what is made of it takes as much again."""


@dataclass
class Cost:
    """What has been unpacked of a file so far.

    Raises LogError from `unpacks` and `holds` as soon as a sum is too large, before it is spent.
    """

    path: Path
    bytes: int = 0
    messages: int = 0

    def unpacks(self, count: int) -> None:
        """So many bytes more are about to be unpacked."""
        self.bytes += count
        most = max(FEW_BYTES, BYTES_A_BYTE * self.path.stat().st_size)
        if self.bytes > most:
            raise LogError(
                f"{self.path}: unpacks to more than {most / 1e6:.0f} MB, which no log of its size "
                "does; record it anew, or only the channels that matter"
            )

    def holds(self, count: int) -> None:
        """So many messages more are about to be read."""
        self.messages += count
        most = max(FEW_MESSAGES, self.path.stat().st_size // BYTES_A_MESSAGE)
        if self.messages > most:
            raise LogError(
                f"{self.path}: holds more than {most / 1e6:.3g} million messages, which no log of "
                "its size does; record it anew, or only the channels that matter"
            )


def check_channels(path: Path, count: int) -> None:
    """LogError for more channels than any ship has."""
    if count > MOST_CHANNELS:
        raise LogError(
            f"{path}: has more than {MOST_CHANNELS} channels; record only those that matter"
        )


def check_whole(path: Path) -> None:
    """LogError for a file too large to be read at once."""
    size = path.stat().st_size
    if size > MOST_WHOLE:
        raise LogError(
            f"{path}: has {size / 1e9:.1f} GB, where no more than {MOST_WHOLE / 1e9:.0f} GB are "
            "read at once; cut it in parts"
        )
