"""What the guide claims: words, a figure, on how many cases, and where it comes from.

A figure of a page of results is quoted from it, never typed, and goes with the commit that the page
carries. One that a test holds goes with the lines of the test that hold it.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).parents[2]
RESULTS: Final = ROOT / "tests" / "benchmarks" / "results"
CLAIMS: Final = RESULTS / "claims.toml"
COMMIT: Final = re.compile(r"\b(?:commit|at) `?([0-9a-f]{7,40})\b")
QUOTED: Final = re.compile(r"\{([^|{}]+)\|([^|{}]*)\}")
NUMBER: Final = re.compile(r"[\d.]+( ?%)?")
POINT: Final = re.compile(r"\* (.+?) [<>]= \S+: (.+?) (?:ok|MISSED)")


def claims() -> list[str]:
    """A line each."""
    return [
        f"{row['claim']}: **{figure(row)}**{_cases(row)}. From {_sources(row)}."
        for row in tomllib.loads(CLAIMS.read_text(encoding="utf-8"))["claim"]
    ]


def of_results(row: Mapping[str, Any]) -> bool:
    """Whether a claim comes from a page of results."""
    return (ROOT / row["from"][0]).parent == RESULTS


def figure(row: Mapping[str, Any], key: str = "figure") -> str:
    """A text of a claim with what it quotes of the first file it comes from filled in.

    `{row|column}` is a cell; `{*|column}` the least and the most of a column; `{+|column}` its sum;
    `{point|}` what stands at a point of a list, `* point >= 95%: 96.1% ok`; `{words|=}` words of
    the page.
    """
    return QUOTED.sub(lambda q: _quote(ROOT / row["from"][0], q[1], q[2]), str(row[key]))


def _quote(path: Path, what: str, column: str) -> str:
    """What a page says there.

    Raises
    ------
    KeyError
        It does not say it any more: the claim outlived the page.
    """
    text = path.read_text(encoding="utf-8")
    if column == "=":
        found = [what] * (what in " ".join(text.split()))
    elif column == "":
        found = [p[2] for p in map(POINT.fullmatch, text.splitlines()) if p and p[1] == what]
    else:
        cells = [(names, x) for names, x in _column(text, column) if what in (*names, "*", "+")]
        found = [_whole(cells, what)] if what in "*+" and cells else [x for _, x in cells[:1]]
    if not found:
        raise KeyError(f"{path.name} has no {column!r} of {what!r}")
    return found[0]


def _whole(cells: list[tuple[list[str], str]], what: str) -> str:
    """The least and the most of a column, or its sum."""
    numbers = [n for _, x in cells if (n := NUMBER.match(x))]
    if what == "+":
        return f"{sum(int(n[0]) for n in numbers)}"
    ends = [pick(numbers, key=_size)[0] for pick in (min, max)]
    return " to ".join(dict.fromkeys(ends))


def _size(number: re.Match[str]) -> float:
    return float(number[0].rstrip(" %"))


def _column(text: str, column: str) -> Iterator[tuple[list[str], str]]:
    """The cells of every row, and of these the one of a column; of the first table that has it."""
    header: list[str] = []
    for line in text.splitlines():
        cells = [cell.strip().replace("**", "") for cell in line.strip().strip("|").split("|")]
        if not line.startswith("|"):
            if column in header:
                return
            header = []
        elif not header:
            header = cells
        elif column in header and not all(set(cell) <= {*":- "} for cell in cells):
            yield cells, cells[header.index(column)]


def _cases(row: Mapping[str, Any]) -> str:
    if "cases" not in row:
        return ""
    number = isinstance(row["cases"], int)
    return f" ({figure(row, 'cases')}{' cases' if number else ''})"


def _sources(row: Mapping[str, Any]) -> str:
    return ", ".join(f"`{path}`{_at(ROOT / path)}" for path in row["from"])


def _at(path: Path) -> str:
    return f" at `{commit(path)}`" if path.parent == RESULTS else ""


def commit(path: Path) -> str:
    """The commit that a page of results carries.

    Raises
    ------
    KeyError
        It carries none.
    """
    found = COMMIT.search(path.read_text(encoding="utf-8"))
    if found is None:
        raise KeyError(f"{path.name} carries no commit")
    return found[1]
