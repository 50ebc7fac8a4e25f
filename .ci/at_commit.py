"""Which commit a page of results was made at."""

import subprocess
from pathlib import Path


def commit_of(folder: Path) -> str:
    """Short name of the commit that the repository about a folder stands at."""
    command = ["git", "-C", str(folder), "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
