"""What leaves the workbench: a copy of the pipeline beside it, the folder of a finished run."""

import re
from pathlib import PurePosixPath, PureWindowsPath
from typing import Final

from trialid.errors import PipelineError
from trialid.pipeline_file import Pipeline
from trialid.workbench.shown import Shown
from trialid.workflow.run_folder import check_replaceable, folder_of
from trialid.workflow.write_run import write

LONGEST: Final = 200
"""Bytes of a file's name; file systems end at 255."""

ODD: Final = frozenset('<>:"|?*')
DEVICE: Final = re.compile(r"(con|prn|aux|nul|(com|lpt)\d)\.", re.IGNORECASE)
"""What Windows cannot have in a name, or does not take for a file's."""


def copy_pipeline(pipeline: Pipeline, name: str) -> str:
    """Write the pipeline under another name into its own folder, where its paths hold; the name.

    Raises
    ------
    PipelineError
        The name is none, or taken.
    """
    if not _plain(name):
        raise PipelineError(f"{name!r}: give a plain file name, without a folder")
    if not name.endswith(".toml"):
        raise PipelineError(f"{name!r}: a pipeline's name ends in .toml")
    place = pipeline.path.with_name(name)
    try:
        with place.open("xb") as stream:
            stream.write(pipeline.content)
    except FileExistsError as error:
        raise PipelineError(f"{name}: is there already; choose another name") from error
    except OSError as error:
        raise PipelineError(f"{name}: cannot be written ({error.strerror})") from error
    return name


def _plain(name: str) -> bool:
    """Whether it names a file in the same folder, and on every system."""
    if not name.isprintable() or name.startswith(".") or len(name.encode()) > LONGEST:
        return False
    bare = {PurePosixPath(name).name, PureWindowsPath(name).name} == {name}
    return bare and not set(name) & ODD and DEVICE.match(name) is None


def write_folder(shown: Shown) -> list[str]:
    """Write the run's folder as `trialid run` would; what is in it.

    Raises
    ------
    PipelineError
        There is no finished run to write, or it cannot be written.
    """
    if shown.run is None:
        raise PipelineError("the model is still being worked out; write it when it is done")
    folder = folder_of(shown.pipeline)
    try:
        check_replaceable(folder, shown.pipeline)
        write(shown.run, folder)
    except OSError as error:
        raise PipelineError(f"{folder}: cannot be written ({error.strerror})") from error
    return [(folder / each.name).as_posix() for each in sorted(folder.iterdir())]
