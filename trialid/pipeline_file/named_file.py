"""Files that a pipeline names: found beside it, or told what is there instead."""

from pathlib import Path
from typing import Annotated, Literal, NamedTuple, cast

from pydantic import AfterValidator, ValidationInfo

from trialid.pipeline_file.mistaken_file import neighbours


class Origin(NamedTuple):
    """The file a pipeline stands in, and all that it holds."""

    path: Path
    content: bytes


def _existing(path: Path, info: ValidationInfo) -> Path:
    found = cast(Origin, info.context).path.parent / path
    match _kind(found):
        case "file":
            return found
        case "folder":
            raise ValueError(f"{str(path)!r} is a folder; name the file in it")
    raise ValueError(f"no file {str(path)!r} (looked for {found}; {neighbours(found)})")


def _existing_log(path: Path, info: ValidationInfo) -> Path:
    found = cast(Origin, info.context).path.parent / path
    return found if _kind(found) == "folder" else _existing(path, info)


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
