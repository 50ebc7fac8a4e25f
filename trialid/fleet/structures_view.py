"""Structures compared from a notebook: the same as the command, as DataFrames."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from trialid.fleet.structure_fits import compute_of
from trialid.pipeline_file import load
from trialid.progress import Progress, silent
from trialid.result.structure_rows import Structures
from trialid.user_files import path_of
from trialid.workflow.structures.compare_structures import compare_structures

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, repr=False)
class StructuresView:
    """Compared structures; `result` is what `structures.json` holds."""

    result: Structures

    @property
    def table(self) -> "pd.DataFrame":
        """A row for each structure, the best first; the columns of `rows`, the name as index."""
        import pandas as pd

        return pd.DataFrame([asdict(row) for row in self.result.rows]).set_index("name")

    @property
    def errors(self) -> "pd.DataFrame":
        """Error of each structure on each trial when it was left out; a column for each trial."""
        import pandas as pd

        rows = {row.name: row.left_out for row in self.result.rows}
        return pd.DataFrame.from_dict(rows, orient="index", columns=list(self.result.trials))

    def __repr__(self) -> str:
        return "\n".join(self.result.sentences)


def structures(
    pipeline: str | Path,
    folder: str | Path | None = None,
    *,
    stability: bool = True,
    on: str | None = None,
    jobs: int | None = None,
    progress: Progress = silent,
) -> StructuresView:
    """Compare whole model structures, as `trialid structures` does, digit for digit.

    Parameters
    ----------
    folder
        Where fits are kept as they are done, and the result is written; None writes nothing.
    stability
        Whether the choice is made again without any use of each trial.
    on, jobs
        Which workers do the fits, as for `batch`; None does them here, one after the other.

    Raises
    ------
    TrialidError
        The input is wrong; one line says what, where and what to do.
    """
    asked = load(path_of(pipeline, "ti.structures"))
    place = None if folder is None else path_of(folder, "ti.structures")
    with compute_of(asked, on, jobs, lambda words: progress(words, None)) as compute:
        return StructuresView(compare_structures(asked, progress, place, stability, compute))
