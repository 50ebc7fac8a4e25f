"""Latitude and longitude to north and east in a plane at the trial's beginning."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.alignment.clocks import Grid, Series
from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError
from trialid.names.quantities import SIGNALS

RADIUS: Final = 6_378_137.0
"""[m] Semi-major axis of WGS 84."""

FLATTENING: Final = 1.0 / 298.257223563
"""Of WGS 84."""

SLACK: Final = 15.0
"""[m] What two fixes of a ship at rest may lie apart: the standard positioning service is within
8 m horizontally, 95 of 100 (GPS SPS Performance Standard, 2020), and both ends have that."""

FASTER: Final = 2.0
"""Times her own speed of nine fixes in ten that no ship exceeds between two of them: water does not
run as fast as she does, or no manoeuvre could be sailed in it."""

FROZEN_S: Final = 5.0
"""[s] A position held so long, and left by a step that no ship makes, was frozen."""

Fixes = tuple[Series, Series]
Places = NDArray[np.intp]


def to_plane(
    series: Sequence[Series], grid: Grid, where: str
) -> tuple[list[Series], tuple[str, ...]]:
    """The series with `lat` and `lon` in place turned into `x` and `y` [m], and remarks.

    The plane touches the ellipsoid of WGS 84 at the first fix of the trial; the date line is no
    line there.

    Raises
    ------
    AlignmentError
        One without the other, of two messages, swapped, or degrees and minutes read as degrees.
    """
    names = [one.quantity.name for one in series]
    if not {"lat", "lon"} & {*names}:
        return list(series), ()
    for name, other in (("lat", "lon"), ("lon", "lat")):
        if name not in names:
            raise AlignmentError(f"{where}: {other!r} needs {name!r} beside it; map both")
    if {"x", "y"} & {*names}:
        raise AlignmentError(f"{where}: x, y and lat, lon are one position; keep one of the pairs")
    places = names.index("lat"), names.index("lon")
    lat, lon = (series[i] for i in places)
    if not np.array_equal(lat.t, lon.t):
        raise AlignmentError(f"{where}: lat and lon do not share their stamps; take both of a fix")
    remarks = [_refuse_no_angle(lat, lon, where)]
    (x, y), found = _tracked(_projected(lat, lon, grid), grid)
    made = list(series)
    made[places[0]], made[places[1]] = x, y
    return made, (*(r for r in remarks if r), *found)


def _refuse_no_angle(lat: Series, lon: Series, where: str) -> str:
    """Refuse what is no latitude, in words that say what it may be instead."""
    high, wide = (np.nanmax(np.abs(np.rad2deg(one.y)), initial=0.0) for one in (lat, lon))
    if high <= 90.0 and wide <= 360.0:
        return ""
    if high <= 180.0 and wide <= 90.0:
        raise AlignmentError(
            f"{where}: lat goes up to {high:.4g} deg and lon only to {wide:.4g}; they are swapped: "
            "exchange their channels"
        )
    raise AlignmentError(
        f"{where}: lat goes up to {high:.6g} deg, lon to {wide:.6g}; as ddmm.mmmm, degrees and "
        "minutes in one number, they cannot be read as degrees: convert them in the table, or take "
        "a channel in deg"
    )


def _projected(lat: Series, lon: Series, grid: Grid) -> Fixes:
    """East and north of the first fix from the trial's start on; NaN where there is no fix."""
    fixed = np.isfinite(lat.y) & np.isfinite(lon.y) & ~((lat.y == 0.0) & (lon.y == 0.0))
    later = np.flatnonzero(fixed & (lat.t >= grid.start))
    first = int(later[0]) if len(later) else int(np.argmax(fixed))
    north, east = plane(np.where(fixed, lat.y, np.nan), np.where(fixed, lon.y, np.nan), first)
    x, y = SIGNALS["x"], SIGNALS["y"]
    return replace(lat, quantity=x, y=north), replace(lon, quantity=y, y=east)


def plane(lat: Vector, lon: Vector, first: int = 0) -> tuple[Vector, Vector]:
    """North and east [m] in the plane that touches the ellipsoid at one of the fixes; (N,) each.

    Parameters
    ----------
    lat, lon
        [rad]; (N,).

    >>> north, east = plane(np.deg2rad([0.0, 0.1]), np.deg2rad([179.95, -179.95]))
    >>> north.round(1).tolist(), east.round(1).tolist()
    ([0.0, 11057.4], [0.0, 11131.9])
    """
    squared = FLATTENING * (2.0 - FLATTENING)
    normal = RADIUS / np.sqrt(1.0 - squared * np.sin(lat) ** 2)
    apart = lon - lon[first]
    out, east = normal * np.cos(lat) * np.cos(apart), normal * np.cos(lat) * np.sin(apart)
    up = normal * (1.0 - squared) * np.sin(lat)
    north = np.cos(lat[first]) * (up - up[first]) - np.sin(lat[first]) * (out - out[first])
    return north, east


def _tracked(fixes: Fixes, grid: Grid) -> tuple[Fixes, list[str]]:
    """The fixes without what is surely none, and remarks."""
    speed = _usual_speed(fixes)
    remarks = []
    for find, words in ((_frozen, "frozen"), (_jumps, "further off than she can go")):
        wrong = find(fixes, speed)
        if wrong.any():
            t = grid.seconds(fixes[0].t[wrong])
            first = ", ".join(f"{one:.1f}" for one in t[:3]) + (", ..." if len(t) > 3 else "")
            count = "1 fix" if len(t) == 1 else f"{len(t)} fixes"
            remarks.append(f"position: {count} {words}, at {first} s; masked")
            x, y = (replace(one, y=np.where(wrong, np.nan, one.y)) for one in fixes)
            fixes = x, y
    return fixes, [*remarks, *_stayed(fixes, speed, grid)]


def _fixed(fixes: Fixes) -> tuple[Places, Vector, Vector, Vector]:
    """Places of the fixes, and their time [s], north and east."""
    x, y = fixes
    at = np.flatnonzero(np.isfinite(x.y) & np.isfinite(y.y))
    return at, (x.t[at] - x.t[0]) / 1e9, x.y[at], y.y[at]


def _usual_speed(fixes: Fixes) -> float:
    """What nine steps in ten do not exceed [m/s]."""
    _, t, x, y = _fixed(fixes)
    dt = np.diff(t)
    steps = np.hypot(np.diff(x), np.diff(y))[dt > 0] / dt[dt > 0]
    return float(np.quantile(steps, 0.9)) if len(steps) else 0.0


def _jumps(fixes: Fixes, speed: float) -> Mask:
    """Fixes out of reach from the last good one; the first good one has a neighbour in reach."""
    at, t, x, y = _fixed(fixes)
    wrong = np.zeros(len(fixes[0].y), dtype=bool)

    def reached(i: int, j: int) -> bool:
        return bool(np.hypot(x[j] - x[i], y[j] - y[i]) <= FASTER * speed * (t[j] - t[i]) + SLACK)

    if len(at) < 3 or all(reached(i, i + 1) for i in range(len(at) - 1)):
        return wrong
    good = next((i for i in range(len(at) - 2) if reached(i, i + 1) and reached(i + 1, i + 2)), 0)
    wrong[at[:good]] = True
    for i in range(good + 1, len(at)):
        if reached(good, i):
            good = i
        else:
            wrong[at[i]] = True
    return wrong


def _frozen(fixes: Fixes, speed: float) -> Mask:
    """Fixes held and then left by a step that she cannot make: all of the run but the first."""
    at, t, x, y = _fixed(fixes)
    wrong = np.zeros(len(fixes[0].y), dtype=bool)
    step = np.hypot(np.diff(x), np.diff(y))
    edges = np.append(0, np.flatnonzero(step > 0.0) + 1)
    for first, end in zip(edges, np.append(edges[1:], len(at)), strict=True):
        if end < len(at) and t[end - 1] - t[first] > FROZEN_S:
            reach = FASTER * speed * (t[end] - t[end - 1]) + SLACK
            if step[end - 1] > reach:
                wrong[at[first + 1 : end]] = True
    return wrong


def _stayed(fixes: Fixes, speed: float, grid: Grid) -> Iterator[str]:
    """Say where a track goes on elsewhere after a gap: nothing tells which side of it is right."""
    at, t, x, y = _fixed(fixes)
    usual = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    for i in np.flatnonzero(np.diff(t) > 3.0 * usual):
        dt = t[i + 1] - t[i]
        away = float(np.hypot(x[i + 1] - x[i], y[i + 1] - y[i]))
        if away > speed * dt + SLACK:
            when = float(grid.seconds(fixes[0].t[at[i : i + 1]])[0])
            yield (
                f"position: after {when:.1f} s the track goes on {away:.0f} m away and stays; "
                "the jump is not bridged: use a window on one side of it"
            )
