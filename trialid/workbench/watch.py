"""Which files somebody has changed."""

from pathlib import Path

from trialid.recipe import Recipe, sources

Seen = tuple[int, int, int] | None
Files = dict[Path, Seen]


def seen(path: Path) -> Seen:
    """What tells one state of a file from another, None where there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def watched(recipe: Recipe) -> Files:
    """The pipeline, the user's own effects and the ship, as they are now."""
    ship = () if recipe.ship is None else (recipe.ship,)
    return {path: seen(path) for path in (recipe.path, *recipe.model.effects_from, *ship)}


def resting(recipe: Recipe) -> Files:
    """What a model rests on besides its pipeline, as it is now: logs, ship, the user's effects."""
    found: Files = {}
    for place in sources(recipe)[1:]:
        inside = sorted(place.glob("*")) if place.is_dir() else []
        found |= {path: seen(path) for path in (place, *inside)}
    return found
