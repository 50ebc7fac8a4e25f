"""Packages that only some formats need: there, or one line on how to have them."""

import importlib
from pathlib import Path
from typing import Any

from trialid.errors import LogError


def needed(module: str, path: Path, what: str, extra: str = "tables") -> Any:
    """The module; LogError that says how to install what reads this kind of file."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise LogError(
            f"{path}: {what} needs the package {module.partition('.')[0]}, which is not "
            f"installed; run: pip install 'trialid[{extra}]'"
        ) from error
