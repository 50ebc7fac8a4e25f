"""Latitudes and longitudes whose side stands in the next column, in degrees or with minutes."""

import re
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.ingest.tables.table import MISSING, Head, Table, numbers
from trialid.ingest.tables.written.written_angles import AXES, MOST

NEGATIVE: Final = "SW"
POSITION: Final = re.compile(r"(?<![a-z])(lat|lon|breite|länge|laenge)", re.IGNORECASE)


def beside_position(heads: Sequence[Head]) -> set[int]:
    """Columns behind one that is called a latitude or longitude: a side may stand there."""
    return {i for i in range(1, len(heads)) if POSITION.search(heads[i - 1].name)}


def hemispheres(table: Table, columns: Sequence[int]) -> Mapping[int, tuple[Vector, str]]:
    """Of these columns the angles [deg] with the sign of the letters beside them, and which.

    Numbers beyond a quarter of the earth, or half of it, are degrees and minutes run together, as
    of NMEA 0183 (5730.25 is 57.504), and then those of both are; what cannot be is not here.
    """
    there = beside_position(table.heads)
    beside = {
        i: (y, *side)
        for i in columns
        if i + 1 in there
        and (side := _sides(table.columns[i + 1].tolist())) is not None
        and (y := numbers(table, i)) is not None
    }
    minutes = any(np.nanmax(np.abs(y), initial=0.0) > MOST[axis] for y, _, axis in beside.values())
    found = {i: (sign * (_run(y) if minutes else y), axis) for i, (y, sign, axis) in beside.items()}
    return {
        i: (y, axis)
        for i, (y, axis) in found.items()
        if np.nanmax(np.abs(y), initial=0.0) <= MOST[axis]
    }


def _run(y: Vector) -> Vector:
    """Degrees of degrees and minutes run together; not a number where there are 60 and more."""
    whole, part = np.divmod(y, 100.0)
    return np.asarray(np.where(part < 60.0, whole + part / 60.0, np.nan))


def _sides(cells: Sequence[object]) -> tuple[Vector, str] | None:
    """A sign for each cell, and the axis; None where not every one is a side of the earth."""
    letters = ["" if cell is None else str(cell).strip().upper() for cell in cells]
    told = {one for one in letters if one.lower() not in MISSING}
    axes = {AXES.get(one) for one in told}
    if len(axes) != 1 or None in axes:
        return None
    sign = np.where(np.isin(letters, list(NEGATIVE)), -1.0, 1.0)
    return np.where(np.isin(letters, sorted(told)), sign, np.nan), str(axes.pop())
