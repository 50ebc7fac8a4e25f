"""Where a run of a pipeline goes, and whether what is there may be replaced."""

import json
from pathlib import Path
from typing import Final

from trialid import own_files, user_files
from trialid.errors import PipelineError
from trialid.pipeline_file import Pipeline, sources

ORIGIN: Final = "trialid-run/1"
FILES: Final = (
    "report.html", "result.json", "series.csv", "predicted.mcap", "missing_force.csv",
    "track.csv", "pipeline.toml", "run.json", "standing.npz",
)  # fmt: skip
"""What a run writes."""


def folder_of(pipeline: Pipeline) -> Path:
    """The folder of a run whose place nobody states, from where the command is given."""
    return Path("runs", pipeline.path.stem)


def check_replaceable(folder: Path, pipeline: Pipeline) -> None:
    """Refuse, before the work, to replace a folder that holds anything but an earlier run.

    Raises
    ------
    PipelineError
        It is a file, holds what the run reads, or other files and no run.
    OSError
        It cannot be looked into.
    """
    if folder.exists() and not folder.is_dir():
        raise PipelineError(f"{folder}: is a file; --out takes a folder")
    inside = [path for path in sources(pipeline) if path.resolve().is_relative_to(folder.resolve())]
    if folder.is_dir() and inside:
        raise PipelineError(
            f"{folder}: holds {inside[0]}, which this run reads; choose another --out"
        )
    if folder.is_dir() and any(folder.iterdir()) and not _is_of_a_run(folder):
        raise PipelineError(f"{folder}: holds other files and no earlier run; choose another --out")
    if folder.is_dir():
        own_files.check(folder, FILES)


def _is_of_a_run(folder: Path) -> bool:
    """Whether a run of ours was written there; a file called result.json alone says nothing."""
    try:
        text = user_files.text(folder / "run.json")
        origin = json.loads(text)
    except (OSError, ValueError, RecursionError):
        return False
    return isinstance(origin, dict) and origin.get("schema") == ORIGIN
