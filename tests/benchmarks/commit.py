"""At which commit a result was made."""

import subprocess
from pathlib import Path


def commit_of(tree: Path = Path(__file__).parent) -> str:
    """Give the short name of the commit that a working tree stands at, this one's if none is given.

    Raises
    ------
    subprocess.CalledProcessError
        Where the folder is in no repository.
    """
    command = ["git", "-C", str(tree), "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
