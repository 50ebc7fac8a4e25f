"""The folder where what is compiled once is kept, private to the user."""

import os
from pathlib import Path


def cache_folder() -> Path:
    """Where what is compiled once is kept; `TRIALID_CACHE` names another place."""
    stated = os.environ.get("TRIALID_CACHE")
    if stated:
        return Path(stated)
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(home) / "trialid" / "kernels"


def is_ours_alone(path: Path) -> bool:
    """Whether a file or folder is this user's, and nobody else may write it."""
    if not hasattr(os, "getuid"):
        return True  # Windows: the home folder is the user's
    found = path.stat()
    return found.st_uid == os.getuid() and not found.st_mode & 0o022
