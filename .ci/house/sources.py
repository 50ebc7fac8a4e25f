"""What the rules look at: the files of a tree, read and parsed once, and the lists kept by hand."""

import ast
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Final

FOLDERS: Final = (".ci", "sample_data", "tests", "trialid")
WORDS: Final = "house_words.toml"


@dataclass(frozen=True, kw_only=True)
class Breach:
    """One thing that a rule forbids."""

    path: str
    """Of the file or folder, from the root."""

    line: int = 0
    """0 where it is about the whole."""

    what: str
    todo: str

    key: str
    """What is counted together and compared with the ratchet: the file, or the thing itself."""

    amount: int = 1
    """What counts: 1, or a size."""

    def __str__(self) -> str:
        """Give one line, as compilers write them."""
        place = f"{self.path}:{self.line}" if self.line else self.path
        return f"{place}: {self.what}; {self.todo}"


@dataclass(frozen=True)
class Source:
    """One file."""

    path: str
    text: str

    @property
    def folder(self) -> str:
        """Where it lies, from the root."""
        return self.path.rpartition("/")[0]

    @property
    def name(self) -> str:
        """Its name without the folder."""
        return self.path.rpartition("/")[2]

    @cached_property
    def lines(self) -> list[str]:
        """The text by lines."""
        return self.text.splitlines()

    @cached_property
    def nodes(self) -> list[ast.AST]:
        """Every node of a Python file."""
        return list(ast.walk(self.tree))

    @cached_property
    def tree(self) -> ast.Module:
        """A Python file, parsed."""
        return ast.parse(self.text, self.path)


@dataclass(frozen=True)
class House:
    """A tree of files and the words kept beside the rules."""

    root: Path
    words: Mapping[str, Any] = field(default_factory=dict)

    @cached_property
    def python(self) -> list[Source]:
        """Every Python file."""
        return list(self._read("*.py"))

    @cached_property
    def scripts(self) -> list[Source]:
        """Every JavaScript file written by hand."""
        return [each for each in self._read("*.js") if not each.name.endswith(".min.js")]

    @property
    def package(self) -> list[Source]:
        """The Python files that are shipped."""
        return [each for each in self.python if each.path.startswith("trialid/")]

    def text(self, name: str) -> str:
        """A file of the root, empty where it is absent."""
        path = self.root / name
        return path.read_text(encoding="utf-8") if path.is_file() else ""

    def listed(self, *keys: str) -> Any:
        """A list or table of the words, empty where it is absent."""
        found: Any = self.words
        for key in keys:
            found = found.get(key, {})
        return found

    def _read(self, pattern: str) -> Iterator[Source]:
        for folder in FOLDERS:
            for path in sorted((self.root / folder).rglob(pattern)):
                yield Source(path.relative_to(self.root).as_posix(), path.read_text("utf-8"))


def house_at(root: Path) -> House:
    """Give the tree below a root, with its words."""
    path = root / ".ci" / WORDS
    words = tomllib.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    return House(root, words)
