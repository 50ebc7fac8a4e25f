"""Files of ours in a folder: known by a list kept beside them, the only ones ever replaced.

`.trialid-files.json` holds the name and the SHA-256 of every file written into a folder. Whatever
is not in it, or was changed since, belongs to somebody else and stays as it is.
"""

import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from trialid import temporary
from trialid.errors import TrialidError

LIST: Final = ".trialid-files.json"
SCHEMA: Final = "trialid-files/1"
Hashes = dict[str, list[str]]
"""Names below a folder, with the hashes a file of ours may have there."""


@contextmanager
def write_or_say_why(place: Path, option: str = "--out") -> Iterator[None]:
    """A place that cannot be written is the user's to mend."""
    try:
        yield
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise TrialidError(
            f"{place}: cannot be written ({reason}); choose another {option}"
        ) from error


def check(
    folder: Path,
    names: tuple[str, ...],
    option: str = "--out",
) -> None:
    """Refuse, before the work, a folder in which one of these names is not ours to replace.

    Parameters
    ----------
    names
        Files that will be written, beside those that were.
    option
        What of the command says the folder.

    Raises
    ------
    TrialidError
        In one line: the file, and what to do.
    """
    ours = _ours(folder)
    for name in dict.fromkeys([*names, *ours]):
        _check(folder, name, ours, option)


def check_folder(folder: Path, names: tuple[str, ...], what: str) -> None:
    """Refuse, before the work, a folder that holds anything but earlier files of these names.

    Raises
    ------
    TrialidError
        In one line: the folder or the file, and what to do; `what` is what such files are.
    """
    if folder.exists() and not folder.is_dir():
        raise TrialidError(f"{folder}: is a file; --out takes a folder")
    temporary.check_writable(folder)
    if not folder.is_dir() or not any(folder.iterdir()):
        return
    if not _ours(folder).keys() & {*names}:
        raise TrialidError(
            f"{folder}: holds other files and no earlier {what}; choose another --out"
        )
    check(folder, names)


def check_all_ours(folder: Path, option: str = "--out") -> None:
    """Refuse to take away a folder that holds anything but unchanged files of ours.

    Raises
    ------
    TrialidError
        In one line: the file, and what to do.
    """
    ours = _ours(folder)
    for path in _files(folder):
        name = path.relative_to(folder).as_posix()
        if name != LIST:
            _check(folder, name, ours, option)


@contextmanager
def replacing(
    folder: Path,
    below: tuple[str, ...] = ("",),
    option: str = "--out",
) -> Iterator[Path]:
    """A place to write into; at the end its files are moved into the folder.

    Nothing moves before all is written, and each file at one stroke. Files of ours that were not
    written again are taken away where their names begin with one of `below`.

    Raises
    ------
    TrialidError
        A file that is not ours has the name of one that was written; then nothing has moved.
    """
    made = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        temporary.sweep(folder)
        work = Path(tempfile.mkdtemp(prefix=temporary.prefix(), dir=folder))
        try:
            yield work
            _move(work, folder, below, option=option)
        finally:
            shutil.rmtree(work, ignore_errors=True)
    finally:
        for parent in made:
            with suppress(OSError):  # holds what was written
                parent.rmdir()


def _move(work: Path, folder: Path, below: tuple[str, ...], option: str) -> None:
    ours = _ours(folder)
    new = {path.relative_to(work).as_posix(): [_hash(path)] for path in _files(work)}
    for name in new:
        _check(folder, name, ours, option)
    gone = [name for name in ours if name not in new and name.startswith(below)]
    gone = [name for name in gone if not _foreign(folder, name, ours)]
    both = {n: [*ours.get(n, []), *new.get(n, [])] for n in dict.fromkeys([*ours, *new])}
    _write_list(folder, both)  # whenever it is broken off, what lies there is known as ours
    for name in new:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (work / name).replace(folder / name)
    for name in gone:
        (folder / name).unlink(missing_ok=True)
    kept = {name: hashes for name, hashes in ours.items() if name not in gone}
    _write_list(folder, kept | new)


def _check(folder: Path, name: str, ours: Mapping[str, list[str]], option: str) -> None:
    path = folder / name
    if path.is_dir():
        raise TrialidError(f"{path}: is a folder, and a file of this name would be written; "
                           f"choose another {option}")  # fmt: skip
    for parent in path.relative_to(folder).parents[:-1]:
        if (folder / parent).exists() and not (folder / parent).is_dir():
            raise TrialidError(f"{folder / parent}: is a file; choose another {option}")
    if _foreign(folder, name, ours):
        was = "was changed since it was written" if name in ours else "is no file of trialid's"
        raise TrialidError(f"{path}: {was} and is not replaced; move it away, or choose "
                           f"another {option}")  # fmt: skip


def _foreign(folder: Path, name: str, ours: Mapping[str, list[str]]) -> bool:
    """Whether somebody else's file stands under a name."""
    path = folder / name
    return os.path.lexists(path) and (path.is_symlink() or _hash(path) not in ours.get(name, []))


def _ours(folder: Path) -> Hashes:
    """The list of a folder; empty where there is none, or none that can be read."""
    try:
        found = json.loads((folder / LIST).read_text(encoding="utf-8"))
        if found["schema"] != SCHEMA:
            return {}
        return {str(name): [str(one) for one in each] for name, each in found["files"].items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def _write_list(folder: Path, files: Hashes) -> None:
    text = json.dumps({"schema": SCHEMA, "files": files}, indent=1) + "\n"
    with temporary.replace_whole(folder / LIST) as ready:
        ready.write_text(text, encoding="utf-8")


def _files(work: Path) -> list[Path]:
    return sorted(path for path in work.rglob("*") if path.is_file())


def _hash(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise TrialidError(f"{path}: cannot be read ({reason}); choose another --out") from error
