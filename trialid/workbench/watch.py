"""Which files somebody has changed."""

from pathlib import Path

from trialid.pipeline_file import Pipeline, sources

Seen = tuple[int, int, int] | None
Files = dict[Path, Seen]


def file_state(path: Path) -> Seen:
    """What tells one state of a file from another, None where there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def watch_list(pipeline: Pipeline) -> Files:
    """The pipeline, the user's own effects and the ship, as they are now."""
    ship = () if pipeline.ship is None else (pipeline.ship,)
    return {path: file_state(path) for path in (pipeline.path, *pipeline.model.effects_from, *ship)}


def source_states(pipeline: Pipeline) -> Files:
    """What a model rests on besides its pipeline, as it is now: logs, ship, the user's effects."""
    found: Files = {}
    for place in sources(pipeline)[1:]:
        inside = sorted(place.glob("*")) if place.is_dir() else []
        found |= {path: file_state(path) for path in (place, *inside)}
    return found
