"""A batch from a notebook: the same as the command, as DataFrames."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from trialid.fleet import batch as done_batch
from trialid.fleet.batch import Batch, by_dask
from trialid.fleet.parquet_tables import CHANGES, PARAMETERS, RUNS_TABLE, check_parquet
from trialid.pipeline_file.fleet_file import load_fleet
from trialid.progress import Progress, silent
from trialid.user_files import path_of

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, repr=False)
class FleetView:
    """A finished batch; its tables are those of its folder."""

    batch: Batch

    @property
    def runs(self) -> "pd.DataFrame":
        """A row for each run: `runs.parquet`."""
        return self._table(RUNS_TABLE)

    @property
    def parameters(self) -> "pd.DataFrame":
        """A row for each parameter of each run: `parameters.parquet`."""
        return self._table(PARAMETERS)

    @property
    def changes(self) -> "pd.DataFrame":
        """A row for each change that was found: `changes.parquet`."""
        return self._table(CHANGES)

    def _table(self, name: str) -> "pd.DataFrame":
        import pandas as pd

        return pd.read_parquet(self.batch.folder / name)

    def __repr__(self) -> str:
        return self.batch.sentence


def batch(
    fleet: str | Path,
    folder: str | Path,
    *,
    on: str = "local",
    jobs: int | None = None,
    progress: Progress = silent,
) -> FleetView:
    """Do the runs of a fleet file, as `trialid batch` does, digit for digit.

    Parameters
    ----------
    folder
        Where runs, tables and report go, and where runs done earlier are found.
    on
        `local`, a scheduler's address like `tcp://host:8786`, or a YAML file with a cluster.
    jobs
        Worker processes on this machine; a core each where nothing is said.

    Raises
    ------
    TrialidError
        The input is wrong; one line says what, where and what to do.
    """
    file, place = path_of(fleet, "ti.batch"), path_of(folder, "ti.batch")
    check_parquet()
    compute = by_dask(on, jobs, lambda words: progress(words, None))
    return FleetView(done_batch.batch(load_fleet(file), place, compute, progress))
