"""Files that a pipeline names: found beside it, or told what is there instead.

The copy in a run's folder names them as the pipeline did, from where that stood.
"""

import json
from pathlib import Path
from typing import Annotated, Literal, NamedTuple, cast

from pydantic import AfterValidator, ValidationInfo

from trialid import user_files
from trialid.pipeline_file.mistaken_file import neighbours


class Origin(NamedTuple):
    """The file a pipeline stands in, and all that it holds."""

    path: Path
    content: bytes


def _existing(path: Path, info: ValidationInfo) -> Path:
    found = _place(path, info)
    match _kind(found):
        case "file":
            return found
        case "folder":
            raise ValueError(f"{str(path)!r} is a folder; name the file in it")
    raise ValueError(f"no file {str(path)!r} (looked for {found}; {neighbours(found)})")


def _existing_log(path: Path, info: ValidationInfo) -> Path:
    found = _place(path, info)
    return found if _kind(found) == "folder" else _existing(path, info)


def _place(path: Path, info: ValidationInfo) -> Path:
    return place_of(path, cast(Origin, info.context).path)


def place_of(path: Path, origin: Path) -> Path:
    """A file beside the pipeline that names it; else, of a run's copy, beside what that is of."""
    found = origin.parent / path
    stood = stood_at(origin) if _kind(found) == "neither" else None
    return found if stood is None else stood.parent / path


def stood_at(pipeline: Path) -> Path | None:
    """Where a pipeline stood of which this is a finished run's copy; None where it is none."""
    if pipeline.name != "pipeline.toml":
        return None
    run = pipeline.with_name("run.json")
    try:
        return run.parent / json.loads(user_files.text(run))["pipeline"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def _kind(found: Path) -> Literal["file", "folder", "neither"]:
    try:
        return "file" if found.is_file() else "folder" if found.is_dir() else "neither"
    except OSError as error:  # a name too long for any file
        raise ValueError(f"{found}: {(error.strerror or '').lower()}") from error


def _python(path: Path) -> Path:
    if path.suffix != ".py":
        raise ValueError(f"{str(path)!r} is not a .py file; effects are written in Python")
    return path


ReadFile = Annotated[Path, AfterValidator(_existing)]
ReadLog = Annotated[Path, AfterValidator(_existing_log)]
PythonFile = Annotated[ReadFile, AfterValidator(_python)]
