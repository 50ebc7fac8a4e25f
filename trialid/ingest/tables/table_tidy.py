"""What spreadsheets and programs leave around a table: empty columns, empty rows, row numbers."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from trialid.ingest.tables.table import MISSING, MOST_COLUMNS, Table, Values, head

LABELS = ("", "Unnamed: 0")
"""What stands above the rows' own labels in a table that pandas saved."""


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
