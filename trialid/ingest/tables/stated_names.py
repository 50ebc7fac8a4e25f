"""Names of a table's columns that are no row of it: behind a comment sign, or told to Tecplot.

`numpy.savetxt` writes `# t, delta, r` above numbers that stand blanks apart, a basin's file for
Tecplot has `VARIABLES = "t [s]" "delta [deg]"` and zones below. As many names as each row has
numbers, one of them a time; a table of which that does not hold is left to a template.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from trialid.ingest.tables import table_header
from trialid.ingest.tables.table import MISSING
from trialid.ingest.tables.table import head as head_of
from trialid.ingest.tables.table_layout import SPACES, Layout
from trialid.ingest.tables.table_names import is_time
from trialid.ingest.tables.templates.template_guess import is_number

SEPARATORS: Final = ("\t", ";", ",", SPACES)
MARKS: Final = re.compile(r"\A\s*+(?:[#%!*]++|//++)\s*+")
VARIABLES: Final = re.compile(r"\A\s*+variables\s*+=", re.IGNORECASE)
ZONE: Final = re.compile(r"\A\s*+zone\b", re.IGNORECASE)
QUOTED: Final = re.compile(r'"([^"\n]*+)"')
ROWS: Final = 3
"""Rows of numbers below the names that have to be as wide as they."""


@dataclass(frozen=True)
class _Rows:
    """Where numbers begin, what parts them, and how many are in a row."""

    begin: int
    separator: str
    width: int


def layout_of(lines: Sequence[str]) -> Layout | None:
    """How a text is laid out whose names are stated so; None of any other.

    >>> layout_of(["# t r", "0 1", "1 2", "2 2"]).names
    ('t', 'r')
    >>> layout_of(["t r", "0 1", "1 2", "2 2"]) is None
    True
    """
    rows = _rows_of(lines)
    if rows is None:
        return None
    above = lines[: rows.begin]
    names = next((one for one in _stated(above) if _are_names(one, rows.width)), None)
    if names is None:
        return None
    return Layout(rows.separator, skip=rows.begin, header_rows=0, names=tuple(names))


def _rows_of(lines: Sequence[str]) -> _Rows | None:
    """The first rows of numbers, all as wide; None where there are no three."""
    for separator in SEPARATORS:
        told = [_fields(line, separator) for line in lines]
        begin = next((at for at, row in enumerate(told) if len(row) > 1 and _numbers(row)), None)
        if begin is None:
            continue
        width, below = len(told[begin]), [row for row in told[begin:] if row][:ROWS]
        if len(below) == ROWS and all(len(row) == width and _numbers(row) for row in below):
            return _Rows(begin, separator, width)
    return None


def _stated(above: Sequence[str]) -> Iterator[list[str]]:
    """What may be the names, the likeliest first."""
    yield _variables(above)
    marked = [MARKS.sub("", line, count=1).strip() for line in above if MARKS.match(line)]
    for separator in SEPARATORS:
        told = [_fields(line, separator) for line in marked[-2:]]
        if len(told) == 2 and table_header.are_units(*told):
            yield [f"{name} [{unit.strip('[]()')}]" for name, unit in zip(*told, strict=True)]
        yield from reversed(told)


def _variables(above: Sequence[str]) -> list[str]:
    """Names in quotes behind Tecplot's `VARIABLES =`, down to its zone."""
    begin = next((at for at, line in enumerate(above) if VARIABLES.match(line)), None)
    if begin is None:
        return []
    end = next((at for at in range(begin, len(above)) if ZONE.match(above[at])), len(above))
    text = "\n".join(above[begin:end])
    quoted = [name.strip() for name in QUOTED.findall(text)]
    return quoted or [one for one in re.split(r"[\s,]+", text.partition("=")[2]) if one]


def _are_names(told: Sequence[str], width: int) -> bool:
    """Whether these are the names of so many columns, one of a time and each another."""
    timed = any(is_time(head_of(word).name) for word in told)
    return timed and table_header.names(told) == width == len(told) == len({*told})


def _fields(line: str, separator: str) -> list[str]:
    parts = line.split() if separator == SPACES else line.split(separator)
    return [part.strip(' "\r\n') for part in parts] if line.strip() else []


def _numbers(row: Sequence[str]) -> bool:
    told = [word for word in row if word.lower() not in MISSING]
    return bool(told) and all(map(is_number, told))
