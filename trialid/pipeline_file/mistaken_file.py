"""A file that is not there, or of another kind than was asked for: where the right one is."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, Literal

from trialid.errors import PipelineError, nearest

LISTED_AT_MOST: Final = 8
"""How many file names an error lists before it only counts them."""

Kind = Literal["pipeline", "design", "ship", "fleet"]

MARKS: Final[Mapping[Kind, str]] = {
    "pipeline": "trial",
    "design": "test",
    "ship": "particulars",
    "fleet": "fleet",
}
"""The table that only a file of this kind has."""

MEANT: Final[Mapping[Kind, str]] = {
    "pipeline": "is a pipeline; to fit it: trialid run {}",
    "design": "is a design of tests; to rate them: trialid design {}",
    "ship": "is the file of a ship; a pipeline names it: ship = {!r}",
    "fleet": "is a fleet; to fit its runs: trialid batch {}",
}


def check_kind(table: Mapping[str, Any], path: Path, wanted: Kind) -> None:
    """Refuse a file that is plainly of another kind, with what it is for.

    Raises
    ------
    PipelineError
        It holds the table of another kind, and not that of the one wanted.
    """
    if MARKS[wanted] in table:
        return
    for kind, mark in MARKS.items():
        if mark in table:
            raise PipelineError(f"{path}: {MEANT[kind].format(str(path))}")


def neighbours(path: Path) -> str:
    """Words about the files of the same kind beside a missing one."""
    if not path.parent.is_dir():
        return f"there is no folder {path.parent}"
    names = [other.name for other in path.parent.iterdir() if other.suffix == path.suffix]
    hint = nearest(path.name, names)
    if not names:
        return f"no {path.suffix or 'such'} file there"
    if len(names) > LISTED_AT_MOST and not hint.startswith("did you mean"):
        kind = f"{path.suffix} files" if path.suffix else "files without a suffix"
        return f"{len(names)} {kind} there, none of a similar name"
    return hint


def log_hint(path: Path) -> str:
    """What to do with a file that is no TOML by its name either."""
    if path.suffix.lower() == ".toml":
        return ""
    return f"; a log is looked into by trialid inspect {path}"
