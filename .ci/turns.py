"""Whose turn it is: what takes long is tried at every twenty-fourth commit, and all in as many.

`pytest -m study` runs all studies; with `TRIALID_STUDIES=turn` the long ones only where it is their
turn by the number of commits. `python .ci/turns.py` prints that turn, for the benchmarks.
"""

import os
import subprocess
import sys
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Final

import pytest

TURNS: Final = 24
VARIABLE: Final = "TRIALID_STUDIES"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the long studies whose turn it is not, where turns are asked for."""
    turn = asked(os.environ.get(VARIABLE, ""), commits)
    if turn is None:
        return
    drawn: list[pytest.Item] = []
    left: list[pytest.Item] = []
    for item in items:
        own = of_study(item.get_closest_marker("study"), case_of(item))
        (drawn if comes_up(own, turn) else left).append(item)
    config.hook.pytest_deselected(items=left)
    items[:] = drawn


def asked(word: str, commits: Callable[[], int]) -> int | None:
    """Give the turn asked for: `turn`, by the number of commits, or a number; None for all.

    `short` asks for those that have no turn, at no turn.
    """
    if not word:
        return None
    if word == "short":
        return TURNS
    if word == "turn":
        return commits() % TURNS
    if word.isdecimal() and int(word) < TURNS:
        return int(word)
    raise pytest.UsageError(f"{VARIABLE}={word}: turn, 0 to {TURNS - 1}, short, or nothing for all")


def comes_up(own: int | None, turn: int) -> bool:
    """Say whether a study with a turn of its own, or with none, runs at this turn."""
    return own in (None, turn)


def of_study(marker: pytest.Mark | None, case: int = 0) -> int | None:
    """Give the turn of a study; None for a short one, and for what is no study: each time.

    The cases of a parametrized study marked `turn="each"` come up one after another.
    """
    turn = marker.kwargs.get("turn") if marker else None
    if turn == "each":
        return case % TURNS
    if turn is not None and turn not in range(TURNS):
        raise pytest.UsageError(f"study(turn={turn}): 0 to {TURNS - 1}, or each")
    return turn


def case_of(item: pytest.Item) -> int:
    """Give the number of a parametrized case, from a place of each test's own.

    Else the first cases of all tests, of which there are most, would have the same turn.
    """
    called = getattr(item, "callspec", None)
    first = zlib.crc32(getattr(item, "originalname", item.name).encode())
    return first + (sum(set(called.indices.values())) if called else 0)


def commits() -> int:
    """Count the commits that lead to this one."""
    command = ["git", "rev-list", "--count", "HEAD"]
    folder = Path(__file__).parent
    return int(subprocess.run(command, cwd=folder, capture_output=True, check=True).stdout)


if __name__ == "__main__":
    sys.stdout.write(f"{commits() % TURNS}\n")
