"""Tables whose columns stand blanks apart, as basins write them: read where nothing is in doubt.

Names in one line, units in one below or none, then numbers: as many in each row as there are names,
one of which is the time. A blank within a name would move all columns behind it.
"""

from collections.abc import Sequence
from typing import Final

from trialid.ingest.tables import table_header
from trialid.ingest.tables.table import MISSING
from trialid.ingest.tables.table import head as head_of
from trialid.ingest.tables.table_names import is_time
from trialid.ingest.tables.templates.template_guess import is_number

FEWEST_ROWS: Final = 2
"""Rows of numbers below a header; one may be a line of any text."""
ROWS: Final = 8
"""Rows that tell the layout; a row below that is none of it is named as it is read."""
FEWEST_COLUMNS: Final = 3
"""Numbers in a row: a time and two more; two words above two numbers stand in any text."""


def header_of(lines: Sequence[str]) -> tuple[int, bool] | None:
    """The line of the header, and whether units follow; None where it is no such table.

    >>> header_of(["t  psi  r", "0.0  1.0  2.0", "0.1  1.1  2.0"])
    (0, False)
    >>> header_of(["t  yaw rate  r", "0.0  1.0  2.0", "0.1  1.1  2.0"]) is None
    True
    """
    found = _above_numbers(lines)
    if found is None:
        return None
    names, stated, width = found
    if len(lines[names].split()) != width or not _named(lines[names].split()):
        return None
    return names, stated


def doubt(lines: Sequence[str]) -> str | None:
    """What is in doubt about such a table, in words; None where nothing is or it is none."""
    found = _above_numbers(lines)
    if found is None or header_of(lines) is not None:
        return None
    names, _, width = found
    told = lines[names].split()
    if not any(is_time(head_of(word).name) for word in told):
        return None
    return (
        f"its rows are {width} numbers that stand blanks apart, and the {len(told)} words of "
        f"line {names + 1} above them are not as many names, each in one word, units in a line of "
        "their own"
    )


def _named(told: Sequence[str]) -> bool:
    """Whether words are names, one of a time and each another."""
    timed = any(is_time(head_of(word).name) for word in told)
    return timed and table_header.names(told) == len(told) == len(set(told))


def _above_numbers(lines: Sequence[str]) -> tuple[int, bool, int] | None:
    """The last line before rows of numbers that is no units, whether units follow, their width."""
    told = [(at, line.split()) for at, line in enumerate(lines) if line.strip()]
    first = next((i for i, (_, row) in enumerate(told) if _numbers(row)), None)
    if first is None or not first or any("\t" in lines[at] for at, _ in told):
        return None
    below = [row for _, row in told[first : first + ROWS]]
    width = len(below[0])
    even = all(len(row) == width and _numbers(row) for row in below)
    if not even or width < FEWEST_COLUMNS or len(below) < FEWEST_ROWS:
        return None
    at, above = told[first - 1]
    stated = first > 1 and table_header.are_units(told[first - 2][1], above)
    return (told[first - 2][0] if stated else at), stated, width


def _numbers(row: Sequence[str]) -> bool:
    """Whether a row holds numbers, of which some may be missing."""
    told = [word for word in row if word.lower() not in MISSING]
    return bool(told) and all(map(is_number, told))
