"""Aligned trials as a file other programs read: CSV, Parquet, MATLAB, MCAP.

Everything is in SI and says so; a sample that was not measured is empty or NaN, whatever the
simulation would put there; and each file carries where it comes from.
"""

import hashlib
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from trialid import temporary
from trialid.errors import TrialidError
from trialid.export import csv_file, mat_file, mcap_file, parquet_file
from trialid.plugins import plugins
from trialid.trial import Trial

__all__ = ["FORMATS", "check_place", "check_unread", "place", "provenance_beside", "write"]

Writer = Callable[[Path, Sequence[Trial], Mapping[str, Any]], None]

FORMATS: Final[Mapping[str, Writer]] = {
    ".csv": csv_file.write_csv,
    ".parquet": parquet_file.write_parquet,
    ".mat": mat_file.write_mat,
    ".mcap": mcap_file.write_mcap,
    **plugins("trialid.exporters"),
}
"""What a file's suffix asks for."""


def provenance_beside(path: Path) -> Path | None:
    """Where the provenance of a file goes that cannot hold it; None where it is inside."""
    return path.with_name(f"{path.name}.json") if path.suffix.lower() == ".csv" else None


def check_place(
    path: Path,
    *,
    replace: bool,
    formats: Collection[str] = FORMATS,
    more: Collection[Path] = (),
    words: tuple[str, str] = ("--out ", "add --force"),
) -> None:
    """Refuse, before the work, a file that cannot or should not be written.

    Parameters
    ----------
    more
        Files that are written with it.
    words
        What a mistake is told of, and what replaces a file, as the user says it.

    Raises
    ------
    TrialidError
        Its suffix is none of the formats, its folder is missing, or it exists.
    """
    named, forced = f"{words[0]}{path}", words[1]
    if path.suffix.lower() not in formats:
        known = ", ".join(formats)
        given = f"{path.suffix!r} is none of them" if path.suffix else "it has none"
        raise TrialidError(f"{named}: the suffix says the format, {known}; {given}")
    if not path.parent.is_dir():
        raise TrialidError(f"{named}: there is no folder {path.parent}; make it first")
    for file in filter(None, (path, provenance_beside(path), *more)):
        if file.is_dir():
            raise TrialidError(f"{named}: {file} is a folder; name a file")
        if (file.exists() or file.is_symlink()) and not replace:
            raise TrialidError(f"{named}: {file} exists; name another, or {forced}")
    temporary.check_writable(path.parent)


def check_unread(path: Path, files: Iterable[Path], hashes: Collection[str] = ()) -> None:
    """Refuse, `--force` or not, to replace what a command itself reads: a log is not made again.

    Parameters
    ----------
    files
        Files and folders that it reads.
    hashes
        SHA-256 of logs, wherever they lie.

    Raises
    ------
    TrialidError
        It is one of them.
    """
    if not path.is_file():
        return
    place = path.resolve()
    read = any(place.is_relative_to(file.resolve()) for file in files)
    if read or hashlib.sha256(path.read_bytes()).hexdigest() in hashes:
        raise TrialidError(f"--out {path}: is read by this command, or by its run; name another")


def write(path: Path, trials: Sequence[Trial], provenance: Mapping[str, Any]) -> None:
    """Write the trials at one stroke, in the format of the file's suffix.

    Raises
    ------
    TrialidError
        The file cannot be written, or a package its format needs is not there.
    """
    writer = FORMATS[path.suffix.lower()]
    place(path, lambda ready: writer(ready, trials, provenance), provenance)


def place(path: Path, fill: Callable[[Path], None], provenance: Mapping[str, Any]) -> None:
    """Let a file be filled and put in its place at one stroke, with what it is beside it.

    Raises
    ------
    TrialidError
        The file cannot be written.
    """
    beside = provenance_beside(path)
    try:
        with temporary.replace_whole(path) as ready:
            fill(ready)
            if beside is not None:
                near = ready.with_name(beside.name)
                csv_file.write_provenance(near, provenance)
                near.replace(beside)
    except OSError as error:
        raise TrialidError(f"--out {path}: {(error.strerror or str(error)).lower()}") from error
