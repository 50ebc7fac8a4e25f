"""The folders of a fleet's runs: each there whole or not at all, and found again by its key."""

import json
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from trialid import own_files, temporary
from trialid.errors import TrialidError
from trialid.fleet.do_run import Done
from trialid.result.fleet_rows import FittedRow, RunLabel, RunRow
from trialid.result.json_file import plain, read_object, row_of

NAME: Final = "fleet_run.json"
"""In a run's folder: its key and its rows, or its failure."""
SCHEMA: Final = "trialid-fleet-run/2"


@dataclass(frozen=True, kw_only=True)
class Kept:
    """What is read back of a run that was done: its rows, and what its folder has to hold."""

    row: RunRow
    fitted: tuple[FittedRow, ...] = ()
    files: tuple[str, ...] = ()

    def under(self, label: RunLabel) -> "Kept":
        """The rows as a plan labels them: a date may have been stated since the run was done."""
        own = vars(label)
        fitted = tuple(replace(row, **own) for row in self.fitted)
        return replace(self, row=replace(self.row, **own), fitted=fitted)


def kept_run(folder: Path, key: str) -> Kept | None:
    """The rows of a run that was done of these very inputs; None where it is to be done.

    That is so, too, where a file of it is not there any more.

    Raises
    ------
    TrialidError
        A file of it was changed since, or cut off: nobody knows what it is worth.
    """
    own_files.check(folder, ())
    try:
        found = read_object(folder / NAME, "")
        if found.pop("schema", None) != SCHEMA:
            return None
        kept = row_of(Kept, found)
    except TrialidError:
        return None
    whole = all((folder / name).is_file() for name in kept.files)
    return kept if whole and kept.row.key == key else None


def set_aside(folder: Path, aside: Path) -> None:
    """Move the folder of a run that is no longer what the batch says of it out of the way.

    It is found again by its key, should its inputs be again what they were.

    Raises
    ------
    TrialidError
        An earlier one that it would take the place of holds what is not ours.
    """
    if not folder.exists():
        return
    if aside.exists():
        own_files.check_all_ours(aside)
        shutil.rmtree(aside)
    aside.parent.mkdir(parents=True, exist_ok=True)
    folder.rename(aside)


def put_back(aside: Path, folder: Path, key: str) -> Kept | None:
    """The rows of a run of these very inputs that was set aside, its folder put back; else None.

    One that was changed since stays where it is: the run can be done anew.
    """
    try:
        kept = kept_run(aside, key) if aside.exists() and not folder.exists() else None
    except TrialidError:
        kept = None
    if kept is not None:
        folder.parent.mkdir(parents=True, exist_ok=True)
        aside.rename(folder)
    return kept


def kept_of(done: Done) -> Kept:
    """What is to be read back of a run."""
    return Kept(row=done.row, fitted=done.fitted, files=tuple(done.files))


def keep_run(done: Done, folder: Path) -> None:
    """A run's folder, there at one stroke; an earlier one of other inputs makes way for it.

    Raises
    ------
    TrialidError
        The earlier folder holds what is not ours; it is left as it is.
    OSError
        There is no room, or no right to write; an earlier folder is as it was.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    rows = {"schema": SCHEMA, **plain(kept_of(done))}
    text = json.dumps(rows, indent=1, default=str, allow_nan=False) + "\n"
    with _aside(folder.parent) as work:
        whole = work / folder.name
        with own_files.replacing(whole) as inside:
            for name, content in {**done.files, NAME: text.encode()}.items():
                (inside / name).write_bytes(content)
        _put(whole, folder, work / "earlier")


def _put(whole: Path, folder: Path, earlier: Path) -> None:
    """A whole folder in its place; one that is there is put aside, and back where that fails."""
    if not folder.exists():
        whole.rename(folder)
        return
    own_files.check_all_ours(folder)
    folder.rename(earlier)
    try:
        whole.rename(folder)
    except BaseException:  # and where it is broken off
        earlier.rename(folder)
        raise


@contextmanager
def _aside(parent: Path) -> Iterator[Path]:
    """A folder beside those of the runs for what is on its way; swept if it is left behind."""
    temporary.sweep(parent)
    work = Path(tempfile.mkdtemp(prefix=temporary.prefix(), dir=parent))
    try:
        yield work
    finally:
        shutil.rmtree(work, ignore_errors=True)


def write_pipelines(texts: Mapping[str, bytes], folder: Path) -> dict[str, str]:
    """Write the pipelines that a fleet makes, where they are not there already.

    Returns
    -------
    dict
        Why one is not written, by name: it is not ours, or was changed by hand. It stays as it is.
    """
    if all((folder / n).is_file() and (folder / n).read_bytes() == x for n, x in texts.items()):
        return {}
    try:
        with own_files.replacing(folder) as work:
            for name, content in texts.items():
                (work / name).write_bytes(content)
    except TrialidError:  # one of them is in the way: of the others each by itself
        return dict(_each_by_itself(texts, folder))
    return {}


def _each_by_itself(texts: Mapping[str, bytes], folder: Path) -> Iterator[tuple[str, str]]:
    for name, content in texts.items():
        try:
            with own_files.replacing(folder, below=(name,)) as work:
                (work / name).write_bytes(content)
        except TrialidError as error:
            yield name, str(error)
