"""A run of a fleet as a worker does it: a parcel in, the files of its folder and its rows out."""

import tempfile
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from trialid.errors import TrialidError
from trialid.fleet.rows_of_run import fitted_rows, run_row
from trialid.pipeline_file import read
from trialid.result.fleet_rows import FittedRow, RunLabel, RunRow
from trialid.threads import one_thread
from trialid.version import VERSION
from trialid.workflow.run import run
from trialid.workflow.write_run import run_files


@dataclass(frozen=True, kw_only=True)
class Parcel:
    """What a worker needs.

    Attributes
    ----------
    root
        The folder that all other paths begin at: one that the worker sees, too, or None where the
        files come by content.
    pipeline, folder
        The pipeline's place and that of the run's folder, from the root.
    files
        Contents by place from the root; empty where they travel by path.
    """

    label: RunLabel
    key: str
    version: str
    root: str | None
    pipeline: str
    folder: str
    content: bytes
    files: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Done:
    """What comes back: files of the run's folder by name, and its rows.

    It is `kept` unless it says nothing of the run, but of the worker.
    """

    row: RunRow
    fitted: tuple[FittedRow, ...] = ()
    files: Mapping[str, bytes] = field(default_factory=dict)
    kept: bool = True


class OtherVersion(Exception):
    """A worker has another version than the one that planned the run."""


@one_thread
def do_run(parcel: Parcel) -> Done:
    """Do a run; a mistake of the input is its failure, in one line, and no error."""
    if parcel.version != VERSION:
        raise OtherVersion(f"the worker has trialid {VERSION}, the batch {parcel.version}")
    warnings.filterwarnings("ignore", category=RuntimeWarning)  # as the command line does
    with _root(parcel) as root:
        place = root / parcel.pipeline
        try:
            done = run(read(parcel.content, place))
        except TrialidError as error:
            said = _from_pipeline(str(error), place)
            return Done(row=failure_row(parcel.label, parcel.key, said))
        return Done(
            row=run_row(parcel.label, parcel.key, done.result),
            fitted=fitted_rows(parcel.label, done.result),
            files=run_files(done, root / parcel.folder),
        )


def failure_row(label: RunLabel, key: str, said: str) -> RunRow:
    """The row of a run that came to nothing."""
    return RunRow(**vars(label), key=key, version=VERSION, failure=said)


def _from_pipeline(said: str, place: Path) -> str:
    """What is wrong with paths as the pipeline writes them: the same wherever it was done."""
    return said.removeprefix(f"{place}: ").replace(f"{place.parent}/", "")


@contextmanager
def _root(parcel: Parcel) -> Iterator[Path]:
    """The folder that the parcel's paths begin at; its contents laid out where they came along."""
    if parcel.root is not None:
        yield Path(parcel.root)
        return
    with tempfile.TemporaryDirectory(prefix="trialid-") as folder:
        for name, content in parcel.files.items():
            _check_inside(name)
            place = Path(folder, name)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)
        Path(folder, parcel.pipeline).parent.mkdir(parents=True, exist_ok=True)
        yield Path(folder)


def _check_inside(name: str) -> None:
    """Refuse a name that leads out of the folder."""
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts:
        raise ValueError(f"{name}: leads out of the parcel's folder")
