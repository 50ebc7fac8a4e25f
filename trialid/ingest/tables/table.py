"""A table of any format: columns under headers, and its fields as numbers."""

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.names.side_words import LETTERS, SIDES

POSITIVE = frozenset(
    (
        *("+", "ve", "pos", "is", "to", "side", "down", "="),
        *("positive", "positiv", "positif", "positief"),
    )
)
"""What stands beside a side behind a unit: `deg, + stbd`."""

BRACKETED = re.compile(r"[\[(](.*)[\])]")
TO_NORTH = frozenset(("T", "true", "True"))
"""What stands behind a heading in the place of a unit; nothing aboard is measured in tesla."""

DASHES = frozenset("-\N{EN DASH}\N{EM DASH}")

MISSING = frozenset({"", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "---"})
"""What programs write, in any case of letters, where there is no value."""

MOST_COLUMNS = 10_000

Values = NDArray[Any]
"""One column; (N,) float64, datetime64[ns], or objects: texts and cells as they stand."""


@dataclass(frozen=True)
class Head:
    """One column's header: the text as it stands, and the name and unit it gives."""

    text: str
    name: str
    unit: str | None


@dataclass(frozen=True)
class Table:
    """The columns of a file, equally long.

    `place` says in words where a row is in the file, `number` reads one text or cell and raises
    ValueError for what is none. `utc` is True where dates are instants of UTC and no local time,
    `own` where nobody else holds the columns: stamps may take the place of the seconds they are of.
    """

    path: Path
    heads: tuple[Head, ...]
    columns: tuple[Values, ...]
    place: Callable[[int], str]
    number: Callable[[Any], float] = float
    remarks: tuple[str, ...] = ()
    utc: bool = False
    own: bool = False

    def where(self, row: int, column: int) -> str:
        """Place of a field, as an error names it."""
        return f"{self.path}, {self.place(row)}, column {self.heads[column].name!r}"


def check_width(path: Path, columns: int) -> None:
    """LogError for more columns than any instrument has."""
    if columns > MOST_COLUMNS:
        raise LogError(
            f"{path}: {columns} columns, where no more than {MOST_COLUMNS} can be read; export "
            "fewer channels"
        )


def without_side(unit: str) -> str:
    """A unit without the side that counts as positive, which the motion is asked for.

    >>> [without_side(one) for one in ("deg, S+", "deg, + stbd", "deg; port positive", "m, MSL")]
    ['deg', 'deg', 'deg', 'm, MSL']
    >>> [without_side(one) for one in ("deg +stbd", "grader, styrbord positiv", "deg C", "m s")]
    ['deg', 'grader', 'deg C', 'm s']
    """
    spaced = unit.replace(";", ",")
    plain, mark, rest = spaced.partition("," if "," in spaced else " ")
    told = set(rest.lower().replace("+", " + ").split())
    sides, known = told - POSITIVE, {*SIDES, *LETTERS}
    if mark != ",":  # no unit of two words, nor a letter, is a side
        known = {*SIDES} if told & POSITIVE and plain not in POSITIVE else set()
    return plain.strip() if mark and sides and sides <= known else unit


def head(text: str, unit: str | None = None) -> Head:
    """Name and unit out of a header's text; `unit` is the one a row of units gives.

    >>> head("roll rate [deg/s]")
    Head(text='roll rate [deg/s]', name='roll rate', unit='deg/s')
    >>> head("rudder [deg] (port positive)")
    Head(text='rudder [deg] (port positive)', name='rudder', unit='deg')
    >>> head("Heading (T)")  # to true north, no tesla
    Head(text='Heading (T)', name='Heading', unit=None)
    >>> head("left [-]")
    Head(text='left [-]', name='left', unit=None)
    """
    text = text.strip()
    for opening, closing in ("[]", "()"):
        if text.endswith(closing):
            at = text.find(opening, text.rfind(closing, 0, -1) + 1)
            if at >= 0:
                own = text[at + 1 : -1].strip()
                if own.lower() in SIDES:  # one of two
                    return Head(text, text, unit or None)
                if own in TO_NORTH:
                    return Head(text, text[:at].strip(), unit or None)
                if ("+" in own or "pos" in own) and without_side(f"deg, {own}") == "deg":
                    return replace(head(text[:at], unit), text=text)  # the side is no unit
                return Head(text, text[:at].strip(), stated_unit(without_side(own)) or unit or None)
    return Head(text, text, unit or None)


def stated_unit(text: str) -> str:
    """A unit without the brackets about it; empty for a dash, which is how tables write none."""
    text = text.strip()
    found = BRACKETED.fullmatch(text)
    text = found[1].strip() if found else text
    return "" if set(text) <= DASHES else text


def numbers(table: Table, column: int) -> NDArray[np.float64] | None:
    """A column as numbers, NaN where it is empty; None for a column of text or dates; (N,)."""
    values = table.columns[column]
    if values.dtype.kind in "fiu":
        return values.astype(np.float64, copy=False)
    if values.dtype.kind != "O":
        return None
    known = {value: _read(value, table.number) for value in dict.fromkeys(values.tolist())}
    read = [known[value] for value in values.tolist()]
    bad = next((row for row, y in enumerate(read) if y is None), -1)
    y = np.array([math.nan if one is None else one for one in read])
    if bad < 0:
        return y
    if np.isnan(y).all():
        return None
    place, value = table.where(bad, column), values[bad]
    raise LogError(f"{place}: {value!r:.60} where a number was expected; mend it or leave it empty")


def _read(value: Any, number: Callable[[Any], float]) -> float | None:
    try:
        return number(value)
    except (ValueError, TypeError, OverflowError):
        return None


def blank_out(values: Values, missing: Iterable[str]) -> Values:
    """The values with NaN for the numbers that stand for none."""
    if values.dtype.kind == "f":
        for number in map(_plain, missing):
            values = np.where(values == number, values.dtype.type(np.nan), values)
    return values


def reader_of_numbers(
    decimal: str, thousands: str | None, missing: frozenset[str]
) -> Callable[[Any], float]:
    """What reads a text as a number: NaN for a missing one, ValueError for any other text."""
    absent = {number for number in map(_plain, missing) if not math.isnan(number)}

    def number(value: Any) -> float:
        if value is None:
            return math.nan
        if not isinstance(value, str):
            return float(value)
        text = value.strip()
        if text.lower() in MISSING or text in missing:
            return math.nan
        if thousands:
            text = text.replace(thousands, "")
        y = float(text.replace(decimal, ".") if decimal != "." else text)
        return math.nan if y in absent else y

    return number


def _plain(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
