"""Rudder angles and rates of turn that a table has as text: a number and the side it is to."""

import math
import re
from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from trialid.arrays import Vector
from trialid.ingest.tables.table import MISSING

PORT: Final = frozenset(("P", "PORT", "BB", "L", "LEFT"))
STARBOARD: Final = frozenset(("S", "STB", "STBD", "STARBOARD", "SB", "R", "RIGHT"))
_SIDED: Final = re.compile(
    r"(?P<before>[A-Za-z]{1,9})?\.?\s*+(?P<size>\d{1,4}(?:[.,]\d{1,6})?)\s*+[°º]?\s*+"
    r"(?P<after>[A-Za-z]{1,9})?\.?"
)


def written_sides(cells: Sequence[Any], of_ship: bool) -> Vector | None:
    """Numbers of cells, positive to starboard (N,); None where they are none.

    Each has its side before or behind, but for zero. Where the column is not called by a quantity
    `of_ship` that has a side, both are there: an `S` alone may be seconds, or south. Empty ones are
    NaN.

    >>> written_sides(["5.2 P", "S10", "0", "STBD 3,5°", ""], False)
    array([-5.2, 10. ,  0. ,  3.5,  nan])
    >>> [written_sides(["5.2 S", "4.8 S"], called) for called in (False, True)]
    [None, array([5.2, 4.8])]
    """
    texts = ["" if cell is None else str(cell).strip() for cell in cells]
    known: dict[str, tuple[float, str]] = {}
    for text in texts:
        if text.lower() not in MISSING and text not in known:
            found = _sided(text)
            if found is None:
                return None
            known[text] = found
    sides = {side for _, side in known.values()} - {""}
    if len(sides) < (1 if of_ship else 2):
        return None
    return np.array([known[text][0] if text in known else math.nan for text in texts])


def _sided(text: str) -> tuple[float, str] | None:
    """One number, positive to starboard, and the side that stands there; none of a zero."""
    match = _SIDED.fullmatch(text)
    if match is None or (match["before"] and match["after"]):
        return None
    size, word = float(match["size"].replace(",", ".")), match["before"] or match["after"]
    if word is None:
        return (0.0, "") if size == 0.0 else None
    if word.upper() in STARBOARD:
        return size, "starboard"
    return (-size, "port") if word.upper() in PORT else None
