"""Which channels of a log are her position, by what they are called, and how fast she goes."""

from collections.abc import Iterable, Mapping
from typing import Final

import numpy as np

from trialid.alignment.track.position import plane
from trialid.arrays import Vector
from trialid.inspection.channel_names import is_column
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.name_words import words
from trialid.inspection.sketch import Sketch, on_one_clock
from trialid.inspection.usual_units import to_si

PAIRS: Final[tuple[Mapping[str, frozenset[str]], ...]] = (
    {
        "lat": frozenset(("lat", "latitude", "breite", "breitengrad", "bredde", "breedte")),
        "lon": frozenset(
            (
                *("lon", "lng", "long", "longitude", "laenge", "länge", "lengde", "lengte"),
                *("laengengrad", "längengrad"),
            )
        ),
    },
    {"x": frozenset(("northing", "hochwert")), "y": frozenset(("easting", "rechtswert"))},
)
"""Words of channels that are a position; one without the other is none: `Breite` is a beam too."""
AXES: Final = (("x", "y"), ("north", "east"), ("n", "e"))
PLANE: Final = frozenset(("0", "ned", "pos", "position", "pose", "m"))
"""Words with which an axis is a position in a plane: `x0`, `x_ned`, `pos_n`."""
Track = tuple[float, Vector, Vector]
"""Period [s], metres to the north and to the east; (N,)."""

MOVED: Final = 3.0
"""Times as large as squared ways over a time are those over twice of it, where they are hers: 4 of
a straight way without noise, 1 of noise alone. Of straight ways and circles of 0.6 to 8 m/s, with
fixes that scatter by 0.02 to 2 m, the speed came within 2.6 % with it, and with 2.5 and 3.5 too."""

FASTEST: Final = 0.9
"""Share of her ways that are no faster than her approach."""

GAP: Final = 8
"""Times as long as usual without a new position from which on nothing is known between: a clock
that was put on by an hour had 0.00 m/s over most of it."""

FURTHER: Final = 8
"""Times as long as noise allows are ways of which the fastest are counted: noise makes some longer,
by a tenth at most then."""


def positions(channels: Iterable[ChannelInspection]) -> dict[str, ChannelInspection]:
    """The first pair of channels that moves and is called a position, by signal; or nothing."""
    moving = [one for one in channels if not one.constant]
    metres = {one.guess.quantity: one for one in reversed(moving) if one.guess is not None}
    for pair in PAIRS:
        found: dict[str, ChannelInspection] = {}
        for name, called in pair.items():
            told = [c for c in moving if called & _told(c)]
            found |= {name: told[0]} if told else {}
        if len(found) == len(pair):
            return found
    if {"x", "y"} <= metres.keys():
        return {name: metres[name] for name in ("x", "y")}
    return _in_a_plane(moving)


def _in_a_plane(channels: Iterable[ChannelInspection]) -> dict[str, ChannelInspection]:
    """Two channels in metres called alike but for their axes, `x0` and `y0`; or nothing.

    A table's `X [mm]` says by its unit what it is; of messages `x` alone is many things.
    """
    fields = {
        words(one.name.rpartition(":")[2]): one
        for one in channels
        if one.unit is None or to_si(one.unit, "m") is not None
    }
    for told, one in fields.items():
        for north, east in AXES:
            beside = {*told} - {north}
            plain = north == "north" or (north == "x" and one.unit and is_column(one.name))
            if told.count(north) != 1 or not beside <= PLANE or not (beside or plain):
                continue
            other = fields.get(tuple(east if word == north else word for word in told))
            if other is not None:
                return {"x": one, "y": other}
    return {}


def _told(one: ChannelInspection) -> set[str]:
    return {*words(one.name.rpartition(":")[2]), *words(one.description)}


def position_words(channels: Iterable[ChannelInspection]) -> list[str]:
    """What a person is told of them: one sentence, or none."""
    found = positions(channels)
    if not found:
        return []
    named = ", ".join(f"{name} = {one.name}" for name, one in found.items())
    told = {word for one in found.values() for word in words(one.name)}
    named += ", if that is to the north" if "x" in told else ""
    return [f"a position is here ({named}): `trialid guide track` says what to do with it"]


def usual_speed(channels: Iterable[ChannelInspection]) -> float | None:
    """The usual speed over ground [m/s] by a position; None where there is none that moves.

    Squared ways grow with the square of the time, and a receiver's noise adds the same to all.
    """
    way = _way(channels)
    if way is None:
        return None
    (period, north, east), over = way
    short, long = (float(np.median(_squared(north, east, n))) for n in (over, 2 * over))
    return float(np.sqrt((long - short) / 3.0)) / (over * period)


def approach_by_positions(channels: Iterable[ChannelInspection]) -> float | None:
    """The same at her fastest, for turns cost speed: what nine tenths of her ways do not exceed."""
    way = _way(channels)
    if way is None:
        return None
    (period, north, east), over = way
    further = FURTHER * over
    if 2 * further < len(north) and len(_squared(north, east, further)):
        over = further
    return float(np.sqrt(np.quantile(_squared(north, east, over), FASTEST))) / (over * period)


def _way(channels: Iterable[ChannelInspection]) -> tuple[Track, int] | None:
    """The way of a position, and over how many samples it is more than a receiver's noise."""
    track = _track(positions(channels))
    if track is None:
        return None
    period, north, east = _fresh(*track)
    over = 1
    while 8 * over <= len(north):
        short, long = (_middle(_squared(north, east, n)) for n in (over, 2 * over))
        if long > MOVED * short:
            return (period, north, east), over
        over *= 2
    return None


def _middle(ways: Vector) -> float:
    """Their median; not a number where there are none."""
    return float(np.median(ways)) if len(ways) else np.nan


def _squared(north: Vector, east: Vector, over: int) -> Vector:
    """Squared ways over so many samples [m^2] that lie in no gap."""
    ways = (north[over:] - north[:-over]) ** 2 + (east[over:] - east[:-over]) ** 2
    return np.asarray(ways[np.isfinite(ways)])


def _track(found: Mapping[str, ChannelInspection]) -> Track | None:
    """The way that a position says; None where it is none, or its two have too little in common."""
    way = way_beside(found)
    return None if way is None else way[0]


def way_beside(
    found: Mapping[str, ChannelInspection], *beside: Sketch
) -> tuple[Track, list[Vector]] | None:
    """The way that a position says, and other channels on its clock; None as of a way alone."""
    globe = "lat" in found
    usual, si = ("deg", "rad") if globe else ("m", "m")
    pair = [found[name] for name in (("lat", "lon") if globe else ("x", "y")) if name in found]
    sizes = [to_si(one.stated_unit or usual, si) for one in pair]
    common = on_one_clock(*(one.sketch for one in pair), *beside) if pair else None
    if common is None or None in sizes:
        return None
    period, values, whole = common
    fixed = whole & ((values[0] != 0.0) | (values[1] != 0.0))
    north, east = (
        np.where(fixed, y * (x or 0.0), np.nan) for y, x in zip(values[:2], sizes, strict=True)
    )
    if globe:
        north, east = plane(north, east, int(np.argmax(fixed)))
    return (period, north, east), values[2:]


def _fresh(period: float, north: Vector, east: Vector) -> Track:
    """A way as often as the receiver tells it anew; what a log repeats is no standing still."""
    moved = (np.diff(north, prepend=np.nan) != 0.0) | (np.diff(east, prepend=np.nan) != 0.0)
    at = np.flatnonzero(moved & np.isfinite(north) & np.isfinite(east))
    if len(at) < 2:
        return period, np.zeros(0), np.zeros(0)
    every = round(float(np.median(np.diff(at))))
    on = np.arange(at[0], at[-1] + 1, every)
    following = at[np.minimum(np.searchsorted(at, on), len(at) - 1)]
    before = at[np.maximum(np.searchsorted(at, on, side="right") - 1, 0)]
    lost = following - before > GAP * every
    there = np.where(lost, np.nan, 1.0)
    north, east = there * np.interp(on, at, north[at]), there * np.interp(on, at, east[at])
    return period * every, north, east
