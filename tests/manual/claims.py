"""What the guide claims: words, a figure that stands in a result file, and where it comes from."""

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).parents[2]
CLAIMS: Final = ROOT / "tests" / "benchmarks" / "results" / "claims.toml"
COMMIT: Final = re.compile(r"commit ([0-9a-f]{7,})")
CELL: Final = re.compile(r"\{([^|{}]+)\|([^|{}]+)\}")


def claims() -> list[str]:
    """A line each: `{row|column}` in a figure is that cell of the first file it comes from."""
    table = tomllib.loads(CLAIMS.read_text(encoding="utf-8"))
    return [
        f"{row['claim']}: **{figure(row)}**{_cases(row)}. From {_sources(row)}."
        for row in table["claim"]
    ]


def stated_at() -> str:
    """The commit at which figures were stated whose file does not carry its own."""
    return str(tomllib.loads(CLAIMS.read_text(encoding="utf-8"))["commit"])


def figure(row: Mapping[str, Any]) -> str:
    """The figure with its cells filled in."""
    return CELL.sub(lambda found: cell(ROOT / row["from"][0], found[1], found[2]), row["figure"])


def cell(path: Path, row: str, column: str) -> str:
    """What stands in the first table of a page with such a column, in the first row of that name.

    Raises
    ------
    KeyError
        There is no such cell: the claim outlived the table.
    """
    header: list[str] = []
    for line in path.read_text(encoding="utf-8").splitlines():
        cells = [text.strip() for text in line.strip().strip("|").split("|")]
        if not line.startswith("|"):
            header = []
        elif not header:
            header = cells
        elif cells[0] == row and column in header:
            return cells[header.index(column)]
    raise KeyError(f"{path.name} has no {column!r} of {row!r}")


def _cases(row: Mapping[str, Any]) -> str:
    return f" ({row['cases']} cases)" if "cases" in row else ""


def _sources(row: Mapping[str, Any]) -> str:
    return ", ".join(f"`{path}`{_commit(ROOT / path)}" for path in row["from"])


def _commit(path: Path) -> str:
    """The commit that a page of results carries."""
    found = COMMIT.search(path.read_text(encoding="utf-8")) if path.suffix == ".md" else None
    return f" at `{found[1]}`" if found else ""
