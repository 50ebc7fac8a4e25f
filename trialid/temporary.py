"""Files on their way to their place: made beside it, moved at one stroke, swept if left behind.

A process that is killed leaves what it had begun. Its number stands in the names, so that the next
one that writes into the folder takes away what belongs to nobody any more, and nothing else.
"""

import errno
import os
import re
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from trialid.errors import TrialidError

NAME: Final = re.compile(r"\.trialid-([0-9]{1,10})-[a-z0-9_]{8}")
ROOM: Final = 5_000_000
"""Bytes that must be free: a small run wrote a third of a million, of several trials it is more.
Half or twice of it matters only on a disk that is full but for so much."""


def prefix() -> str:
    """How the names of this process's own files on their way begin."""
    return f".trialid-{os.getpid()}-"


def sweep(folder: Path) -> None:
    """Take away what processes that are no more have left in a folder."""
    with suppress(OSError):
        for path in list(folder.iterdir()):
            found = NAME.fullmatch(path.name)
            if found is None or _runs(int(found[1])):
                continue
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink(missing_ok=True)


def _runs(process: int) -> bool:
    """Whether a process of this number runs; True where nobody can tell."""
    if os.name != "posix":
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


@contextmanager
def replace_whole(path: Path) -> Iterator[Path]:
    """A place to write a file to, which then takes its place at one stroke, or leaves it alone."""
    sweep(path.parent)
    with tempfile.TemporaryDirectory(prefix=prefix(), dir=path.parent) as folder:
        ready = Path(folder, path.name)
        yield ready
        ready.replace(path)


def replace_all(contents: Mapping[Path, bytes]) -> None:
    """Write files of one folder that belong together: none takes its place before all are whole."""
    folder = next(iter(contents)).parent
    sweep(folder)
    with tempfile.TemporaryDirectory(prefix=prefix(), dir=folder) as made:
        ready = {path: Path(made, path.name) for path in contents}
        for path, content in contents.items():
            ready[path].write_bytes(content)
        for path, whole in ready.items():
            whole.replace(path)


def write_new(path: Path, text: str) -> None:
    """Write a file that is not there yet, whole or not at all.

    Raises
    ------
    OSError
        It is there, or cannot be written; then nothing is left of it.
    """
    content = text.encode("utf-8", errors="backslashreplace")
    with path.open("xb") as stream:
        try:
            stream.write(content)
            stream.flush()
        except OSError:
            path.unlink(missing_ok=True)
            raise


def check_writable(folder: Path, option: str = "--out") -> None:
    """Refuse, before the work, a place that what it gives could not be written to.

    Raises
    ------
    TrialidError
        The folder, or the nearest that is there, cannot be written into, or is full.
    """
    there = next(p for p in (folder, *folder.absolute().parents) if p.exists())
    code = 0
    if not os.access(there, os.W_OK | os.X_OK):
        read_only = hasattr(os, "statvfs") and os.statvfs(there).f_flag & os.ST_RDONLY
        code = errno.EROFS if read_only else errno.EACCES
    elif shutil.disk_usage(there).free < ROOM:
        code = errno.ENOSPC
    if code:
        raise TrialidError(
            f"{folder}: cannot be written ({os.strerror(code).lower()}); choose another {option}"
        )
