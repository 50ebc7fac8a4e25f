"""Where a run of a pipeline goes, and whether what is there may be replaced."""

from pathlib import Path

from trialid.errors import RecipeError
from trialid.recipe import Recipe, sources


def folder_of(recipe: Recipe) -> Path:
    """The folder of a run whose place nobody states, from where the command is given."""
    return Path("runs", recipe.path.stem)


def check_replaceable(folder: Path, recipe: Recipe) -> None:
    """Refuse, before the work, to replace a folder that holds anything but an earlier run.

    Raises
    ------
    RecipeError
        It is a file, holds what the run reads, or other files and no run.
    OSError
        It cannot be looked into.
    """
    if folder.exists() and not folder.is_dir():
        raise RecipeError(f"{folder}: is a file; --out takes a folder")
    inside = [path for path in sources(recipe) if path.resolve().is_relative_to(folder.resolve())]
    if folder.is_dir() and inside:
        raise RecipeError(
            f"{folder}: holds {inside[0]}, which this run reads; choose another --out"
        )
    if folder.is_dir() and any(folder.iterdir()) and not (folder / "result.json").is_file():
        raise RecipeError(f"{folder}: holds other files and no earlier run; choose another --out")
