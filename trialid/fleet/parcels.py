"""A run made up for a worker: its paths from one folder, its files along where they must travel."""

from pathlib import Path

from trialid.fleet.do_run import Parcel
from trialid.fleet.inputs import Travel, from_root, pack_inputs
from trialid.fleet.task import Task


def pack(task: Task, folder: Path, logs: Travel) -> Parcel:
    """What a worker needs for a run whose results go to this folder."""
    inputs, root = pack_inputs(task.pipeline, task.content, task.files, logs, [folder])
    return Parcel(
        label=task.label,
        key=task.key,
        inputs=inputs,
        folder=from_root(folder, root),
        grown=task.grown,
    )
