"""What spreadsheets and programs leave around a table: empty columns, empty rows, row numbers."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trialid.errors import LogError, list_names
from trialid.ingest.tables.table import MISSING, MOST_COLUMNS, Head, Table, Values, head

LABELS = ("", "Unnamed: 0")
"""What stands above the rows' own labels in a table that pandas saved."""
MOST_TORN: Final = 0.01
"""Of the rows that a logger may leave torn, as a disk that was full or a line that was lost does. A
table that is laid out otherwise than its header has all rows of another width, or every other one:
half and twice as many tell the two apart as well."""


def tidy(table: Table) -> Table:
    """The table without nameless columns that hold nothing, or the number of the row.

    >>> columns = (np.array([0.0, 1.0]), np.array([7.0, 8.0]), np.array([np.nan, np.nan]))
    >>> heads = (head(""), head("u"), head(""))
    >>> [one.name for one in tidy(Table("log", heads, columns, str)).heads]
    ['u']
    """
    if all(one.name not in LABELS for one in table.heads):
        return table
    names, columns, remarks = [], [], list(table.remarks)
    for i, (one, values) in enumerate(zip(table.heads, table.columns, strict=True)):
        if one.name in LABELS and is_empty(values):
            continue
        if one.name in LABELS and _counts_rows(values):
            remarks.append("the first column only numbers the rows, left out")
            continue
        names.append(head(f"column {i + 1}") if not one.name else one)
        columns.append(values)
    return dataclasses.replace(
        table, heads=tuple(names), columns=tuple(columns), remarks=tuple(remarks)
    )


def is_empty(values: Values) -> bool:
    """Whether a column holds no value in any row."""
    if values.dtype.kind == "f":
        return bool(np.isnan(values).all())
    if values.dtype.kind != "O":
        return False
    return all(one is None or str(one).strip().lower() in MISSING for one in values)


def _counts_rows(values: Values) -> bool:
    """Whether a column is 0, 1, 2, ... or 1, 2, 3, ...; some numbers may be left out."""
    try:
        y = values.astype(np.float64)
    except (TypeError, ValueError):
        return False
    whole = np.isfinite(y).all() and (y == np.rint(y)).all() and y[0] >= 0.0
    return bool(whole and (np.diff(y) == 1.0).all())


def cut(rows: Sequence[list[str]], width: int) -> Sequence[list[str]]:
    """The rows without the empty fields that all of them have too many."""
    most = max(map(len, rows), default=width)
    if not width < most <= MOST_COLUMNS or any(any(row[width:]) for row in rows):
        return rows
    return [row[:width] for row in rows]


def even(
    path: Path, rows: Sequence[list[str]], lines: Sequence[int], heads: Sequence[Head]
) -> tuple[list[list[str]], list[int], list[str]]:
    """The rows as wide as the header and their lines, and what of the others is left out.

    A header that is repeated, as loggers do that start again, is none of the rows. LogError names
    the first row of another width where they are more than a logger leaves torn.
    """
    names = [one.name for one in heads]
    again = [row == [one.text for one in heads] for row in rows]
    torn = [len(row) != len(names) and not same for row, same in zip(rows, again, strict=True)]
    if sum(torn) > MOST_TORN * len(rows):
        at = torn.index(True)
        raise LogError(
            f"{path}, line {lines[at]}: {len(rows[at])} fields where the header has {len(names)}"
            f" ({list_names(names)}); mend or delete the line, or, where the table is laid out "
            "otherwise, draft a template (trialid inspect LOG --template FILE)"
        )
    kept = [i for i in range(len(rows)) if not (torn[i] or again[i])]
    told = [
        f"left out: {what} (first line {lines[odd.index(True)]}, {sum(odd)} in all)"
        for odd, what in (
            (again, "the header, repeated"),
            (torn, f"rows that have not the header's {len(names)} fields"),
        )
        if any(odd)
    ]
    return [rows[i] for i in kept], [lines[i] for i in kept], told
