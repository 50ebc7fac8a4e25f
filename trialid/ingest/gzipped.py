"""Logs packed with gzip: unpacked beside the cache, within a bound, read, and removed again."""

import contextlib
import dataclasses
import gzip
import shutil
import tempfile
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from trialid.errors import LogError
from trialid.ingest.adapter import Adapter, Aids, Wanted, sha256
from trialid.recording import Recording

MAGIC: Final = b"\x1f\x8b"
MOST: Final = 4_000_000_000
"""Bytes that any log unpacks to."""
SMALL: Final = 64_000_000
"""Bytes that a log unpacks to whatever it was packed to."""
TIMES: Final = 200
"""... and how often its packed size a longer one may be: text logs pack 5 to 30 times, one that
never changes 100 times. Half of it would still let those in, twice of it lets a bomb be twice as
large; deflate ends at 1032."""
BLOCK: Final = 1 << 17


def is_packed(head: bytes) -> bool:
    """Whether the first bytes of a file are those of gzip."""
    return head.startswith(MAGIC)


def head(path: Path, count: int) -> bytes:
    """The first bytes of what is packed; LogError where none can be unpacked."""
    try:
        with gzip.open(path, "rb") as file:
            return file.read(count)
    except (OSError, EOFError, zlib.error) as error:
        raise LogError(f"{path}: is packed with gzip and damaged; copy it again") from error


def unpack_beside(adapter: Adapter) -> Adapter:
    """The adapter for logs of its format that are packed."""

    def read(path: Path, wanted: Wanted, aids: Aids) -> Recording:
        with unpack_bytes(path) as (there, remarks):
            found = adapter.read(there, wanted, aids)
            own = tuple(remarks) + found.remarks
            return dataclasses.replace(found, path=path, sha256=sha256(path), remarks=own)

    def batches(path: Path, aids: Aids) -> Iterable[Wanted]:
        with unpack_bytes(path) as (there, _):
            return tuple(adapter.batches(there, aids))

    return dataclasses.replace(adapter, read=read, batches=batches)


@contextlib.contextmanager
def unpack_bytes(path: Path) -> Iterator[tuple[Path, list[str]]]:
    """The log in a file of its own, and remarks; the file is there no longer than it is used.

    What is said of the file is said of the packed one.

    Raises
    ------
    LogError
        It unpacks to more than any log, or to a packed file again.
    """
    most = min(MOST, max(SMALL, TIMES * path.stat().st_size))
    with tempfile.TemporaryDirectory(prefix="trialid-gzip-") as folder:
        there = Path(folder, path.name.removesuffix(".gz"))
        remarks = _unpack(path, there, most)
        try:
            yield there, remarks
        except LogError as error:
            raise LogError(str(error).replace(str(there), str(path))) from error


def _unpack(path: Path, there: Path, most: int) -> list[str]:
    """Remarks on what could not be unpacked."""
    _check_room(path, there, most)
    size = 0
    try:
        with gzip.open(path, "rb") as packed, there.open("wb") as file:
            while block := packed.read1(BLOCK):  # what comes before a cut
                size += len(block)
                if size > most:
                    raise LogError(
                        f"{path}: is packed with gzip and unpacks to more than "
                        f"{most / 1e6:.0f} MB, which no log of its size does; unpack it by hand "
                        "if it is yours"
                    )
                file.write(block)
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        if not size:
            raise LogError(f"{path}: is packed with gzip and damaged; copy it again") from error
        return [f"the packed file is damaged or cut after {size} unpacked bytes: the rest is lost"]
    except OSError as error:
        raise LogError(f"{path}: cannot be unpacked, {error.strerror}; make room") from error
    return []


def _check_room(path: Path, there: Path, most: int) -> None:
    """LogError where even what is packed would not fit."""
    free = shutil.disk_usage(there.parent).free
    if free < min(most, path.stat().st_size):
        raise LogError(f"{path}: no room to unpack it in {there.parent.parent}; make some")
