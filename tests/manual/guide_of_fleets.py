"""What the guide says of a fleet's tables, from the rows themselves."""

import ast
from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Final

from trialid.result import fleet_rows

TABLES: Final = {
    "RunLabel": "The first columns of `runs.parquet` and `parameters.parquet`",
    "RunRow": "`runs.parquet`, after these",
    "FittedRow": "`parameters.parquet`, after these",
    "ChangeRow": "`changes.parquet`",
}


def fleet_columns(items: Callable[[Iterable[str]], str]) -> str:
    """Every column of every table; `items` makes a list of points."""
    return "\n".join(
        f"### {heading}\n\n" + items(f"`{name}`: {said}" for name, said in _fields(row))
        for row, heading in TABLES.items()
    )


def _fields(name: str) -> Iterator[tuple[str, str]]:
    """Each field of a class of rows with the text under it."""
    tree = ast.parse(Path(fleet_rows.__file__).read_text(encoding="utf-8"))
    body = next(n for n in tree.body if isinstance(n, ast.ClassDef) and n.name == name).body
    for field, under in pairwise(body):
        if isinstance(field, ast.AnnAssign) and isinstance(under, ast.Expr):
            yield ast.unparse(field.target), " ".join(ast.literal_eval(under.value).split())
