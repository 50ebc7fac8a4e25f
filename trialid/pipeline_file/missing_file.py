"""What to say of a file that is not there: the ones beside it."""

from pathlib import Path
from typing import Final

from trialid.errors import nearest

LISTED_AT_MOST: Final = 8
"""How many file names an error lists before it only counts them."""


def neighbours(path: Path) -> str:
    """Words about the files of the same kind beside a missing one."""
    if not path.parent.is_dir():
        return f"there is no folder {path.parent}"
    names = [other.name for other in path.parent.iterdir() if other.suffix == path.suffix]
    hint = nearest(path.name, names)
    if not names:
        return f"no {path.suffix or 'such'} file there"
    if len(names) > LISTED_AT_MOST and not hint.startswith("did you mean"):
        return f"{len(names)} {path.suffix} files there, none of a similar name"
    return hint
