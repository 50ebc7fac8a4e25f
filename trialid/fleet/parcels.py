"""A run made up for a worker: its paths from one folder, its files along where they must travel."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from trialid.fleet.do_run import Parcel
from trialid.fleet.task import Task
from trialid.version import VERSION


def pack(task: Task, folder: Path, logs: Literal["path", "content"]) -> Parcel:
    """What a worker needs for a run whose results go to this folder."""
    place, pipeline, *files = map(_absolute, (folder, task.pipeline, *task.files))
    root = Path(os.path.commonpath([pipeline.parent, place.parent, *(f.parent for f in files)]))
    along = logs == "content"
    return Parcel(
        label=task.label,
        key=task.key,
        version=VERSION,
        root=None if along else str(root),
        pipeline=_from(pipeline, root),
        folder=_from(place, root),
        content=task.content,
        files=_contents(files, root) if along else {},
    )


def _absolute(path: Path) -> Path:
    """Without `..`, and with symbolic links as they are: so the pipeline finds what it names."""
    return Path(os.path.abspath(path))  # noqa: PTH100


def _from(path: Path, root: Path) -> str:
    return path.relative_to(root).as_posix()


def _contents(files: Sequence[Path], root: Path) -> dict[str, bytes]:
    return {_from(path, root): path.read_bytes() for path in files}
