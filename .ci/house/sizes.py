"""Rules about how long and how many."""

import ast
import re
from collections import Counter
from collections.abc import Iterator
from typing import Final

from house.sources import Breach, House, Source

FILE: Final = 300
"""Lines of a file: what is read in one sitting."""

TABLE: Final = 400
"""Lines of a file that is mostly a table of data."""

FOLDER: Final = 20
"""Python files in a folder: what is seen at one glance."""

FUNCTION: Final = 40
"""Lines of a function without its docstring: one screen."""

README: Final = (250, 100)
"""Lines of the README, and characters of a line."""

SKIP: Final = "# fmt: skip"

Function = ast.FunctionDef | ast.AsyncFunctionDef


def file_lengths(house: House) -> Iterator[Breach]:
    """Find files longer than the limit; tables of data are listed among the words."""
    for source in (*house.python, *house.scripts):
        most = TABLE if source.path in house.listed("tables", "files") else FILE
        size = len(source.lines)
        if size > most:
            yield Breach(
                path=source.path,
                what=f"{size} lines, at most {most}",
                todo="split it by topic into files that can be named",
                key=source.path,
                amount=size,
            )


def folder_sizes(house: House) -> Iterator[Breach]:
    """Find folders with more Python files than are seen at a glance."""
    for folder, count in Counter(each.folder for each in house.python).items():
        if count > FOLDER:
            yield Breach(
                path=folder,
                what=f"{count} Python files, at most {FOLDER}",
                todo="give a group of them a folder of its own",
                key=folder,
                amount=count,
            )


def function_lengths(house: House) -> Iterator[Breach]:
    """Find functions longer than a screen, in Python and in JavaScript."""
    for source in house.python:
        for node in source.nodes:
            if isinstance(node, Function):
                yield from _too_long(source, node.lineno, node.name, _lines(node))
    for source in house.scripts:
        for first, last, name in script_functions(source.text):
            yield from _too_long(source, first, name, last - first + 1)


def _lines(node: Function) -> int:
    """Lines of a function, its docstring left out: that may be as long as it needs."""
    parts = [node, node.body[0]] if ast.get_docstring(node) else [node]
    sizes = [(each.end_lineno or each.lineno) - each.lineno + 1 for each in parts]
    return sizes[0] - sum(sizes[1:])


def _too_long(source: Source, line: int, name: str, lines: int) -> Iterator[Breach]:
    if lines > FUNCTION:
        yield Breach(
            path=source.path,
            line=line,
            what=f"{name}() has {lines} lines, at most {FUNCTION}",
            todo="take out steps that have a name",
            key=f"{source.path} {name}",
            amount=lines,
        )


_QUOTED = re.compile(
    r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`"
    r"|(?<=[(=,:?])\s*/(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\\n\[])+/",
    re.DOTALL,
)
_OPENED = re.compile(r"function\s*(?P<name>\w*)\s*\(|(?P<arrow>=>)\s*\{")


def script_functions(text: str) -> Iterator[tuple[int, int, str]]:
    """Give the first line, last line and name of each function of a script, by its braces."""
    bare = _QUOTED.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    for match in _OPENED.finditer(bare):
        start = match.end() - 1
        if not match["arrow"]:
            start = bare.find("{", _closing(bare, start, "()"))
        end = _closing(bare, start, "{}")
        name = match["name"] or "an unnamed function"
        yield bare.count("\n", 0, match.start()) + 1, bare.count("\n", 0, end) + 1, name


def _closing(text: str, start: int, pair: str) -> int:
    """Where the bracket opened at `start` is closed; the end where it is not."""
    depth = 0
    for place in range(start, len(text)):
        depth += (text[place] == pair[0]) - (text[place] == pair[1])
        if depth == 0:
            return place
    return len(text)


def format_skips(house: House) -> Iterator[Breach]:
    """Find lines laid out by hand; there may be no more of them, and every one less is kept."""
    for source in house.python:
        for line, text in enumerate(source.lines, start=1):
            if text.rstrip().endswith(SKIP):
                yield Breach(
                    path=source.path,
                    line=line,
                    what=f"{SKIP!r} again",
                    todo="let `ruff format` lay it out, or make it a table of rows",
                    key=source.path,
                )


def readme(house: House) -> Iterator[Breach]:
    """Find what is too much of the README, which is a door and no manual."""
    lines = house.text("README.md").splitlines()
    todo = "the rest belongs to the guide"
    most, wide = README
    if len(lines) > most:
        what = f"{len(lines)} lines, at most {most}"
        yield Breach(path="README.md", what=what, todo=todo, key="lines", amount=len(lines))
    for place, line in enumerate(lines, start=1):
        if len(line) > wide:
            what = f"{len(line)} characters, at most {wide}"
            yield Breach(path="README.md", line=place, what=what, todo="break it", key="wide")
