"""Where the header of a table stands, if titles stand above it.

A header is a line of names that a line of as many values follows. Where the line above it is names
too, the header may have two lines: nothing is guessed then, a template says it.
"""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from trialid.errors import UnitError
from trialid.ingest.tables.table import MISSING
from trialid.ingest.tables.table_names import is_time
from trialid.ingest.tables.templates.template_guess import DATE, is_number
from trialid.names import unit_words, units

DEEPEST = 60
"""Lines above a header; titles of a trial take a few."""
OF_CLOCK = re.compile(r"(?=.*h.*m)[dmyhst:./ -]+", re.IGNORECASE)
"""How a time is written, where a unit might stand: `hh:mm:ss`, `DD.MM.YYYY hh:mm`."""
WITHOUT = ("", "-", "UTC", "GMT", "Z")
"""What stands where there is no unit, as of dates."""
NAME = re.compile(r"([^\w\s(\[]{1,2}|\d{1,3}_)?[^\W\d]")
"""Topics begin with a slash, what `rostopic` prints with `%time`; a column may be `-rudder`, `#row`
or `1_rpm`. A number with its unit, `5 kn`, is none."""


def names(fields: Sequence[Any]) -> int:
    """How many fields of a header there are, 0 for a row that is none.

    All but the first begin like names, for what counts the rows has none; at the end some may be
    empty.

    >>> names(["t", "u", ""]), names(["", "t", "u"]), names(["t", "", "u"]), names(["0.0", "1"])
    (2, 3, 0, 0)
    """
    texts = [str(one).strip(' "\t') for one in fields]
    while texts and not texts[-1]:
        texts.pop()
    told = texts[1:] if texts and not texts[0] else texts
    if len(told) < 1 + (told is texts):
        return 0
    return len(texts) if all(NAME.match(text) for text in told) else 0


def is_data(fields: Sequence[Any]) -> bool:
    """Whether more than half of what a row tells are numbers and dates."""
    told = [one for one in fields if str(one).strip().lower() not in MISSING]
    return bool(told) and sum(map(_is_value, told)) > 0.5 * len(told)


def _is_value(one: Any) -> bool:
    if not isinstance(one, str):
        return not isinstance(one, bool | np.bool_)
    text = one.strip(' "\t')
    return is_number(text) or DATE.fullmatch(text) is not None


def row_of(rows: Sequence[Sequence[Any]]) -> tuple[int, bool] | None:
    """The row that names the columns, and whether one of units follows; None where two may be."""
    for at, row in enumerate(rows[:DEEPEST]):
        width = names(row)
        below = [one for one in rows[at + 1 : at + 4] if any(str(cell).strip() for cell in one)]
        if not width or not below:
            continue
        stated = are_units(_texts(row), _texts(below[0]))
        values = below[1:2] if stated else below[:1]
        if any(len(one) >= width and is_data(one) for one in values):
            above = _texts(rows[at - 1]) if at else []
            return (at, stated) if 2 * sum(map(_may_be_a_name, above)) < width else None
    return None


def _may_be_a_name(text: str) -> bool:
    """Of a header's first line, and no label of a title with its value: `Date:`, `14.05.2026`."""
    return bool(text) and not text.endswith(":") and not _is_value(text)


def _texts(row: Sequence[Any]) -> list[str]:
    return [str(cell).strip(' "\t') for cell in row]


def are_units(names: Sequence[str], fields: Sequence[str]) -> bool:
    """True for a second row that can be nothing but units: in brackets, or a unit of time first.

    Or, where the time has none as dates have, units that logs are full of.

    >>> are_units(["t", "roll", "mode"], ["[s]", "[deg]", ""])
    True
    >>> are_units(["t", "roll", "mode"], ["s", "deg", "-"])
    True
    >>> are_units(["Time", "roll"], ["hh:mm:ss", "deg"])
    True
    >>> are_units(["Time", "roll", "mode"], ["UTC", "deg", "-"])
    True
    >>> are_units(["t", "roll", "mode"], ["0.0", "", "AUTO"])
    False
    >>> are_units(["t", "roll", "mode"], ["", "m", "AUTO"])
    False
    >>> are_units(["Vessel", "Trial", "Place"], ["Time", "rpm", "kn"])
    False
    """
    stated = [field.strip(' "') for field in fields]
    told = [field for field in stated if field not in ("", "-")]
    if len(names) != len(fields) or not told:
        return False
    if all(re.fullmatch(r"\[\D*\]|\(\D*\)|\[\w[^/]*/.*\]", field) for field in told):
        return True
    times = [i for i, name in enumerate(names) if is_time(name.strip(' "'))]
    bare = [field.strip("[]()") for field in stated]
    clocks = [i for i in times if _counts_time(bare[i]) or OF_CLOCK.fullmatch(bare[i])]
    rest = [one for i, one in enumerate(bare) if i not in times and one not in WITHOUT]
    if not all(units.TEXT.fullmatch(one) for one in rest):
        return False
    silent = bool(times) and all(bare[i].upper() in WITHOUT for i in times)
    return bool(clocks) or (silent and _are_usual(rest))


def _are_usual(stated: Sequence[str]) -> bool:
    """Whether most measure what logs are full of: an angle, a rate, a speed, a distance."""
    usual = [one for one in stated if unit_words.plain(one) in units.USUAL]
    if 2 * len(usual) > len(stated):  # without the library of all units, which takes its time
        return True
    known = [any(units.becomes(one, si) for si in ("rad", "rad/s", "m/s", "m")) for one in stated]
    return 2 * sum(known) > len(stated)


def _counts_time(text: str) -> bool:
    try:
        return bool(re.fullmatch(r"[A-Za-z]{1,12}", text)) and units.factor(text, "s") > 0.0
    except UnitError:
        return False
