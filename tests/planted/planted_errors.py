"""Errors that a test has to notice: where each is planted, and the tests nearest to it.

The tables are the files `*.toml` beside this one, one entry an error.
"""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parents[2]
TABLES: Final = Path(__file__).parent


@dataclass(frozen=True, kw_only=True)
class Planted:
    """One error.

    Attributes
    ----------
    name
        What is wrong then, in a few words; no two alike.
    file
        Where, below `trialid/`.
    old, new
        The text that stands there once, and what takes its place.
    tests
        What pytest is given: the tests nearest to it.
    explained
        Why no test can notice it: what it changes is no number. Empty where one has to.
    """

    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]
    explained: str = ""

    @property
    def package(self) -> str:
        """The folder below `trialid/`, or the file where it lies in none."""
        return self.file.partition("/")[0]

    def path(self, root: Path) -> Path:
        """The file in a checkout."""
        return root / "trialid" / self.file

    def planted(self, text: str) -> str:
        """The file's text with the error in it.

        Raises
        ------
        ValueError
            The old text does not stand there, or more than once: nobody would know which is meant.
        """
        count = text.count(self.old)
        if count != 1:
            raise ValueError(f"{self.name}: stands {count} times in {self.file}; once is needed")
        return text.replace(self.old, self.new)


def planted_errors(folder: Path = TABLES) -> list[Planted]:
    """Every error of every table, in the order of the files and of their lines."""
    return [one for file in sorted(folder.glob("*.toml")) for one in _read(file)]


def _read(file: Path) -> list[Planted]:
    rows = tomllib.loads(file.read_text(encoding="utf-8"))["planted"]
    return [Planted(**{**row, "tests": tuple(row["tests"])}) for row in rows]


def chosen(errors: Sequence[Planted], names: Sequence[str]) -> list[Planted]:
    """The errors of these names, all where none is given.

    Raises
    ------
    ValueError
        A name is no error's.
    """
    known = {one.name for one in errors}
    for name in names:
        if name not in known:
            raise ValueError(f"no planted error is called {name!r}")
    return [one for one in errors if not names or one.name in names]
