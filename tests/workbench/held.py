"""A computation held where a test likes, and looks that see nothing new for a while."""

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import quick

from trialid.workbench import compute
from trialid.workbench.desk import Desk

EXAMINE = compute.examine


class Gate:
    """Holds a computation where it examines its fit: for as long as a test likes."""

    def __init__(self) -> None:
        self.open = threading.Event()
        self.reached = threading.Event()
        self.open.set()

    def examine(self, *arguments: Any, **words: Any) -> Any:
        self.reached.set()
        assert self.open.wait(quick.LONGEST)
        return EXAMINE(*arguments, **words)

    def close(self) -> None:
        self.open.clear()
        self.reached.clear()


class Looks:
    """Looks at the files of one pipeline that see nothing new for a while; others look on."""

    def __init__(self, watched: Callable[..., Any], path: Path) -> None:
        self.watched_, self.path, self.still, self.last = watched, path, False, None

    def watched(self, recipe: Any) -> Any:
        if recipe.path != self.path:
            return self.watched_(recipe)
        if not self.still or self.last is None:
            self.last = self.watched_(recipe)
        return self.last

    def stop(self) -> None:
        self.still = True

    def go(self) -> None:
        self.still = False


def add_upon(desk: Desk, gate: Gate) -> None:
    """Add an effect, and another one while the model with the first is worked out."""
    gate.close()
    quick.edit(desk, "add", effect=quick.ADDED)
    assert gate.reached.wait(quick.LONGEST)
    quick.edit(desk, "add", effect=quick.OTHER)
    gate.open.set()
