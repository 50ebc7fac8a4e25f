"""Tables with one value a row: time, name, value, as historians and databases of ships export."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.errors import LogError
from trialid.ingest.tables.table import Head, Table, head, numbers
from trialid.ingest.tables.table_names import bare_words

NAMES: Final = (
    *("field", "tag", "signal", "channel", "variable", "sensor", "parameter", "point", "topic"),
    *("msgid", "measurement", "name", "key"),
)
"""What a column of names is called, the closest to a value first."""
BEHIND: Final = ("", "name", "id")
"""What may stand behind it: `TagName`, `parameter_id`; of a name and a number the name is meant."""
VALUES: Final = frozenset(("value", "val", "data", "reading", "wert", "valeur", "valor", "waarde"))
UNITS: Final = frozenset(("unit", "units", "uom", "einheit", "unite", "unidad", "eenheid"))


@dataclass(frozen=True)
class LongColumns:
    """Places of the columns of a long table: of names, of values, of units if there are any."""

    names: int
    values: int
    units: int | None


def one_value_a_row(heads: Sequence[Head]) -> LongColumns | None:
    """Which columns are which, by their names alone; None of a table with a column a channel.

    >>> one_value_a_row([head("time"), head("Tag"), head("Value")])
    LongColumns(names=1, values=2, units=None)
    >>> one_value_a_row([head("time"), head("mode"), head("rudder")])
    """
    called = ["".join(bare_words(one.name)) for one in heads]
    values = [i for i, word in enumerate(called) if word in VALUES]
    named = [word + behind for word in NAMES for behind in BEHIND]
    names = [called.index(word) for word in named if word in called]
    units = [i for i, word in enumerate(called) if word in UNITS]
    if len(values) != 1 or not names:
        return None
    return LongColumns(names[0], values[0], units[0] if len(units) == 1 else None)


def key_columns(heads: Sequence[Head]) -> set[int]:
    """Columns without which no channel of a table with one value a row is known; else none."""
    of = one_value_a_row(heads)
    return set() if of is None else {i for i in (of.names, of.values, of.units) if i is not None}


def columns_by_name(table: Table, of: LongColumns) -> Iterator[tuple[Head, Table, np.ndarray]]:
    """Each name with its unit, the table of its rows alone, and where these are."""
    names = np.array([_text(one) for one in table.columns[of.names].tolist()], object)
    for name in dict.fromkeys(names.tolist()):
        rows = np.flatnonzero(names == name)
        alone = replace(
            table,
            columns=tuple(column[rows] for column in table.columns),
            place=_place(table, rows),
        )
        unit = None if of.units is None else _text(table.columns[of.units][rows[0]]) or None
        called = f"{table.heads[of.names].name} {name}" if name.isdecimal() else name
        yield head(called, unit), alone, rows


def _place(table: Table, rows: np.ndarray) -> Callable[[int], str]:
    """Where the rows of one name are in the file."""

    def place(row: int) -> str:
        return table.place(int(rows[row]))

    return place


def values_of(table: Table, of: LongColumns) -> np.ndarray | None:
    """The values of one name (N,), NaN where there is none; None where they are texts."""
    try:
        return numbers(table, of.values)
    except LogError:
        return None


def _text(cell: object) -> str:
    return f"{cell:.10g}" if isinstance(cell, float) else str(cell).strip()
