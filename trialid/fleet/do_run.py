"""A run of a fleet as a worker does it: a parcel in, the files of its folder and its rows out."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from trialid.errors import TrialidError
from trialid.fleet.inputs import Inputs, laid_out
from trialid.fleet.rows_of_run import fitted_rows, run_row
from trialid.pipeline_file import read
from trialid.result.fleet_rows import FittedRow, RunLabel, RunRow
from trialid.threads import one_thread
from trialid.version import VERSION
from trialid.workflow.run import run
from trialid.workflow.write_run import run_files


@dataclass(frozen=True, kw_only=True)
class Parcel:
    """What a worker needs: what the run reads, and the place of its folder from their root."""

    label: RunLabel
    key: str
    inputs: Inputs
    folder: str
    grown: bool = False


@dataclass(frozen=True, kw_only=True)
class Done:
    """What comes back: files of the run's folder by name, and its rows.

    It is `kept` unless it says nothing of the run, but of the worker.
    """

    row: RunRow
    fitted: tuple[FittedRow, ...] = ()
    files: Mapping[str, bytes] = field(default_factory=dict)
    kept: bool = True


@one_thread
def do_run(parcel: Parcel) -> Done:
    """Do a run; a mistake of the input is its failure, in one line, and no error."""
    with laid_out(parcel.inputs) as root:
        warnings.filterwarnings("ignore", category=RuntimeWarning)  # as the command line does
        place = root / parcel.inputs.pipeline
        try:
            done = run(read(parcel.inputs.content, place), grown=parcel.grown)
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
