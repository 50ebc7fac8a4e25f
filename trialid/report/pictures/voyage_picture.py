"""A parameter over voyages or ships: estimates with likely ranges, and where it changed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trialid.names import wording
from trialid.result.fleet_rows import ChangeRow, FittedRow

WIDE = 560.0
HIGH = 120.0
MARGIN = 4.0
NEAR = 3.0
"""A step that few voyages show is drawn up to three likely ranges, and what is off presses the
middle half into a quarter of the picture; with half of it up to one and a half and two fifths, with
twice of it up to six and a seventh."""
MOST_NAMES = 6
"""That a picture of 230 px names, one below each: some seven letters have room."""
MOST_SHIPS = 40
"""Whose borders a picture of 230 px shows: six pixels for each."""


@dataclass(frozen=True, kw_only=True)
class Whisker:
    """A run: where it stands, its estimate and its likely range; and what a pointer is told."""

    run: str
    x: float
    y: float
    low: float | None
    high: float | None
    words: str


@dataclass(frozen=True, kw_only=True)
class Mark:
    """A change: where it begins, and its words."""

    x: float
    words: str


@dataclass(frozen=True, kw_only=True)
class VoyagePicture:
    """What the page draws: places in a box of `WIDE` by `HIGH`, the scale's ends in words."""

    parameter: str
    unit: str
    top: str
    bottom: str
    first: str
    last: str
    whiskers: tuple[Whisker, ...]
    marks: tuple[Mark, ...]
    borders: tuple[float, ...]
    names: tuple[str, ...] = ()


def voyage_picture(
    parameter: str, rows: Sequence[FittedRow], names: Sequence[str], changes: Sequence[ChangeRow]
) -> VoyagePicture:
    """The picture of a parameter; each of `rows` has a value, `names` are those of the axis.

    The scale holds every estimate that is not far from the others, and likely ranges as far as
    they are not very wide; what is beyond stands at the border.
    """
    unit, factor = wording.shown_unit(rows[0].unit)
    bottom, top = _scale(rows)
    voyages = [row.voyage for row in rows]

    def down(value: float) -> float:
        share = (top - value) / (top - bottom)
        return MARGIN + (HIGH - 2.0 * MARGIN) * min(max(share, 0.0), 1.0)

    return VoyagePicture(
        parameter=parameter,
        unit=unit,
        top=wording.number(top * factor, 3),
        bottom=wording.number(bottom * factor, 3),
        first=names[0],
        last=names[-1],
        whiskers=tuple(
            Whisker(
                run=row.run,
                x=_across(place, len(rows)),
                y=down(row.value or 0.0),
                low=None if row.likely_low is None else down(row.likely_low),
                high=None if row.likely_high is None else down(row.likely_high),
                words=_words(row),
            )
            for place, row in enumerate(rows)
        ),
        marks=tuple(
            Mark(
                x=_across(voyages.index(each.voyage) - 0.5, len(rows)),
                words=f"{each.form} from {each.voyage}",
            )
            for each in changes
        ),
        borders=_borders(names),
        names=tuple(names) if len(names) <= MOST_NAMES else (),
    )


def _words(row: FittedRow) -> str:
    """A run's estimate and its likely range."""
    unit, factor = wording.shown_unit(row.unit)
    ends = (row.value, row.likely_low, row.likely_high)
    value, low, high = (None if x is None else wording.number(x * factor, 3) for x in ends)
    likely = "" if low is None or high is None else f", likely {low} to {high}"
    return f"{row.run}: {value} {unit}{likely}"


def _borders(names: Sequence[str]) -> tuple[float, ...]:
    """Between one ship and the next, while there are few enough to be seen."""
    places = [k for k in range(1, len(names)) if names[k] != names[k - 1]]
    if len(set(names)) == len(names) or len(places) >= MOST_SHIPS:
        return ()
    return tuple(_across(k - 0.5, len(names)) for k in places)


def _across(place: float, count: int) -> float:
    return WIDE * (place + 0.5) / count


def _scale(rows: Sequence[FittedRow]) -> tuple[float, float]:
    """The ends of the scale: estimates near the middle half, and ranges up to twice their spread.

    Near is within `NEAR` times the width of that half, or of a usual likely range.
    """
    values = np.array([row.value or 0.0 for row in rows])
    lower, upper = (float(each) for each in np.quantile(values, (0.25, 0.75)))
    ends = [(row.likely_low, row.likely_high) for row in rows]
    ranges = [high - low for low, high in ends if low is not None and high is not None]
    room = NEAR * max(upper - lower, float(np.median(ranges or [0.0])))
    near = values[(values >= lower - room) & (values <= upper + room)]
    low, high = float(near.min()), float(near.max())
    spread = (high - low) or abs(high) or 1.0
    known = [end for pair in ends for end in pair if end is not None]
    return (
        min([low, *(max(end, low - 2.0 * spread) for end in known)]),
        max([high, *(min(end, high + 2.0 * spread) for end in known)]) or low + spread,
    )
