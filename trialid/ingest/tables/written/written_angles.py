"""Latitudes and longitudes that a table has as text: degrees, minutes and a side."""

import math
import re
from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from trialid.arrays import Vector
from trialid.ingest.tables.table import MISSING

_ANGLE: Final = re.compile(
    r"(?P<before>[NSEW])?\s*+"
    r"(?:(?P<run>\d{4,5}(?:[.,]\d+)?)"  # ddmm.mmmm
    r"|(?P<deg>\d{1,3}(?P<part>[.,]\d+)?)\s*+(?P<sign>[°º])?"
    r"(?:[\s:-]*+(?P<min>\d{1,2}(?:[.,]\d+)?)\s*+['\u2032\u2019]?"
    r"(?:[\s:]*+(?P<sec>\d{1,2}(?:[.,]\d+)?)\s*+(?:\"|\u2033|'')?)?)?)"
    r"\s*+(?P<after>[NSEW])?",
    re.IGNORECASE,
)
"""Spaces are given back by none of its parts: a long row of them is passed over once."""
AXES: Final = {"N": "latitude", "S": "latitude", "E": "longitude", "W": "longitude"}
MOST: Final = {"latitude": 90.0, "longitude": 180.0}
"""How far it goes to either side [deg]."""


def written_angles(cells: Sequence[Any]) -> tuple[Vector, str] | None:
    """Angles [deg] of cells, positive north and east (N,), and which; None where they are none.

    Each has its side, one letter before or behind, and all are of one axis; empty ones are NaN.

    >>> written_angles(["56°30.6'N", "S 12 15 36", "5630.600 N", ""])
    (array([ 56.51, -12.26,  56.51,    nan]), 'latitude')
    >>> written_angles(["56°30.6'N", "11°12.0'E"]), written_angles(["12:30", "12:31"])
    (None, None)
    """
    known: dict[str, tuple[float, str]] = {}
    for cell in cells:
        text = "" if cell is None else str(cell).strip()
        if text.lower() not in MISSING and text not in known:
            found = _angle(text)
            if found is None:
                return None
            known[text] = found
    axes = {axis for _, axis in known.values()}
    if len(axes) != 1:
        return None
    texts = ("" if cell is None else str(cell).strip() for cell in cells)
    angles = np.array([known[text][0] if text in known else math.nan for text in texts])
    return angles, axes.pop()


def _angle(text: str) -> tuple[float, str] | None:
    """One angle with its sign [deg], and of which axis."""
    match = _ANGLE.fullmatch(text)
    if match is None or (match["before"] is None) == (match["after"] is None):
        return None
    if not any(match[n] for n in ("run", "min", "part", "sign")):
        return None  # E 1 is a code
    side = (match["before"] or match["after"]).upper()
    parts = [float((match[n] or "0").replace(",", ".")) for n in ("deg", "min", "sec")]
    if match["run"] is not None:
        whole = float(match["run"].replace(",", "."))
        parts = [whole // 100.0, whole % 100.0, 0.0]
    broken = match["min"] is not None and match["part"] is not None
    size = parts[0] + parts[1] / 60.0 + parts[2] / 3600.0
    if broken or max(parts[1:]) > 60.0 or size > MOST[AXES[side]]:
        return None
    return (-size if side in "SW" else size), AXES[side]
