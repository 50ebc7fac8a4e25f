"""Packages that only some formats need: there, or one line on how to have them."""

import importlib
import importlib.util
from pathlib import Path
from typing import Any

from trialid.errors import LogError


def is_installed(module: str, path: Path, what: str, extra: str) -> None:
    """LogError as `require`, for a package that another process will load."""
    try:
        there = importlib.util.find_spec(module) is not None
    except ValueError:  # told to be none
        there = False
    if not there:
        raise LogError(
            f"{path}: {what} needs the package {module}, which is not installed; run: pip install "
            f"'trialid[{extra}]'"
        )


def require(module: str, path: Path, what: str, extra: str = "tables") -> Any:
    """The module; LogError that says how to install what reads this kind of file."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise LogError(
            f"{path}: {what} needs the package {module.partition('.')[0]}, which is not "
            f"installed; run: pip install 'trialid[{extra}]'"
        ) from error
