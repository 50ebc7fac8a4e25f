"""Which files somebody has changed."""

from pathlib import Path

from trialid.recipe import Recipe

Seen = tuple[int, int, int] | None


def seen(path: Path) -> Seen:
    """What tells one state of a file from another, None where there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def watched(recipe: Recipe) -> dict[Path, Seen]:
    """The pipeline, the user's own effects and the ship, as they are now."""
    ship = () if recipe.ship is None else (recipe.ship,)
    return {path: seen(path) for path in (recipe.path, *recipe.model.effects_from, *ship)}
