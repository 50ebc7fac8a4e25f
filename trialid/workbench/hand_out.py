"""What leaves the workbench: a copy of the pipeline beside it, the folder of a finished run."""

import re
from pathlib import PurePosixPath, PureWindowsPath
from typing import Final

from trialid.errors import RecipeError
from trialid.pipeline import write
from trialid.recipe import Recipe
from trialid.recipe.run_folder import check_replaceable, folder_of
from trialid.workbench.shown import Shown

LONGEST: Final = 200
"""Bytes of a file's name; file systems end at 255."""

ODD: Final = frozenset('<>:"|?*')
DEVICE: Final = re.compile(r"(con|prn|aux|nul|(com|lpt)\d)\.", re.IGNORECASE)
"""What Windows cannot have in a name, or does not take for a file's."""


def copied(recipe: Recipe, name: str) -> str:
    """Write the pipeline under another name into its own folder, where its paths hold; the name.

    Raises
    ------
    RecipeError
        The name is none, or taken.
    """
    if not _plain(name):
        raise RecipeError(f"{name!r}: give a plain file name, without a folder")
    if not name.endswith(".toml"):
        raise RecipeError(f"{name!r}: a pipeline's name ends in .toml")
    place = recipe.path.with_name(name)
    try:
        with place.open("xb") as stream:
            stream.write(recipe.content)
    except FileExistsError as error:
        raise RecipeError(f"{name}: is there already; choose another name") from error
    except OSError as error:
        raise RecipeError(f"{name}: cannot be written ({error.strerror})") from error
    return name


def _plain(name: str) -> bool:
    """Whether it names a file in the same folder, and on every system."""
    if not name.isprintable() or name.startswith(".") or len(name.encode()) > LONGEST:
        return False
    bare = {PurePosixPath(name).name, PureWindowsPath(name).name} == {name}
    return bare and not set(name) & ODD and DEVICE.match(name) is None


def written(shown: Shown) -> list[str]:
    """Write the run's folder as `trialid run` would; what is in it.

    Raises
    ------
    RecipeError
        There is no finished run to write, or it cannot be written.
    """
    if shown.run is None:
        raise RecipeError("the model is still being worked out; write it when it is done")
    folder = folder_of(shown.recipe)
    try:
        check_replaceable(folder, shown.recipe)
        write(shown.run, folder)
    except OSError as error:
        raise RecipeError(f"{folder}: cannot be written ({error.strerror})") from error
    return [(folder / each.name).as_posix() for each in sorted(folder.iterdir())]
