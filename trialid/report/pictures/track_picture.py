"""The track of a trial as a picture to scale: north up, measured and predicted, the ship on it.

Geometry for inline SVG in px of its view box. East is to the right, one scale for both axes; a
trial without a position has no picture.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.names import wording
from trialid.result.track_series import TrackSeries, Way

WIDTH: Final = 340.0
TALLEST, LOWEST = 500.0, 196.0
MARGIN: Final = 26.0
HEAD: Final = 46.0
"""Above the track: arrows."""
FOOT: Final = 60.0
"""Below the track: scale, legend, current and wind."""
POINTS: Final = 800
"""Of a line: enough to be looked at from nearer."""
OUTLINES: Final = 9
"""Instants at which the ship is drawn."""
HULL: Final = ((0.5, 0.0), (0.3, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.3, -0.5))
"""Ahead in lengths, to starboard in beams."""
SLOWEST: Final = 0.005
"""m/s of current below which an arrow would say nothing."""
CALM: Final = 0.1
"""m/s of wind below which it has no direction: an anemometer tells no less."""


@dataclass(frozen=True)
class Mark:
    """The instant of an outline, and where its time is written."""

    t: float
    x: float
    y: float
    word: str


@dataclass(frozen=True)
class Line:
    """A piece of a track as points of a polyline, and the time of each [s]."""

    points: str
    times: str


@dataclass(frozen=True, kw_only=True)
class TrackPicture:
    """What the template draws; `current` and `wind` are where they go [deg] from north, or None.

    `way` is how much of the height the track takes, below `head`; `per_metre` px of it a metre.
    """

    label: str
    height: float
    head: float
    way: float
    measured: tuple[Line, ...]
    predicted: tuple[Line, ...]
    outlines: tuple[str, ...]
    marks: tuple[Mark, ...]
    per_metre: float
    scale: float
    scale_words: str
    current: float | None
    current_words: str
    wind: float | None
    wind_words: str
    predicted_words: str


def track_picture(
    track: TrackSeries | None, particulars: Mapping[str, float] | None = None
) -> TrackPicture | None:
    """The picture of a track; None without one. `particulars` are the ship's L and B [m]."""
    if track is None:
        return None
    ways = [way for way in (track.measured, track.predicted) if way.known.any()]
    if not ways:
        return None
    points = np.concatenate([way.columns[:2, way.known] for way in ways], axis=1)
    length = (particulars or {}).get("L", 0.0)
    to_page, height, scale = _frame(points, length)
    bar = _round_length(0.3 * WIDTH / scale)
    at = _instants(track)
    hull = length, (particulars or {}).get("B", 0.0)
    return TrackPicture(
        label=f"Track of {track.trial}, north up, {bar:g} m to the bar",
        height=height,
        head=HEAD,
        way=height - HEAD - FOOT,
        measured=tuple(_lines(track.t, track.measured, to_page)),
        predicted=tuple(_lines(track.t, track.predicted, to_page)),
        outlines=tuple(_outline(track.measured, k, hull, to_page) for k in at),
        marks=tuple(_mark(track, k, to_page) for k in at),
        per_metre=scale,
        scale=bar * scale,
        scale_words=f"{bar:g} m",
        current=_arrow(track.current),
        current_words=_current_words(track.current),
        wind=_arrow(track.wind, CALM),
        wind_words=_wind_words(track.wind),
        predicted_words="predicted" if track.over_ground else "predicted, through the water",
    )


@dataclass(frozen=True)
class _Frame:
    """From north and east [m] to the page."""

    north: float
    west: float
    scale: float
    left: float

    def __call__(self, x: Vector, y: Vector) -> tuple[Vector, Vector]:
        across = self.left + (np.asarray(y) - self.west) * self.scale
        return across, MARGIN + (self.north - np.asarray(x)) * self.scale


def _frame(points: Vector, length: float) -> tuple[_Frame, float, float]:
    """The frame that holds points (2, N) and a ship beyond, its height, and px a metre."""
    (south, west), (north, east) = points.min(axis=1), points.max(axis=1)
    reach = 0.6 * length
    tall, wide = north - south + 2.0 * reach, east - west + 2.0 * reach
    room = WIDTH - 2.0 * MARGIN
    scale = min(room / max(wide, 1e-6), (TALLEST - 2.0 * MARGIN - HEAD - FOOT) / max(tall, 1e-6))
    height = max(tall * scale + 2.0 * MARGIN + HEAD + FOOT, LOWEST)
    left = MARGIN + (room - wide * scale) / 2.0
    return _Frame(north + reach, west - reach, scale, left), height, scale


def _lines(t: Vector, way: Way, to_page: _Frame) -> Iterator[Line]:
    """Pieces between gaps, thinned."""
    known = way.known
    step = max(len(known) // POINTS, 1)
    for first, end in _runs(known):
        kept = np.unique([*range(first, end, step), end - 1])
        across, down = to_page(way.x[kept], way.y[kept])
        points = " ".join(f"{a:.2f},{d:.2f}" for a, d in zip(across, down, strict=True))
        yield Line(points, ",".join(f"{x:.7g}" for x in t[kept]))


def _runs(mask: Mask) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(int)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _instants(track: TrackSeries) -> list[int]:
    """Samples with a fix, evenly over the trial."""
    fixed = np.flatnonzero(track.measured.known)
    if not len(fixed):
        return []
    wanted = np.linspace(0, len(track.t) - 1, OUTLINES)
    return sorted({int(fixed[np.argmin(np.abs(fixed - k))]) for k in wanted})


def _outline(way: Way, k: int, hull: tuple[float, float], to_page: _Frame) -> str:
    """The ship at a sample; a line of her length where no beam is stated; none without heading."""
    length, beam = hull
    psi = float(way.psi[k])
    if not np.isfinite(psi) or length <= 0.0:
        return ""
    shape = HULL if beam > 0.0 else ((0.5, 0.0), (-0.5, 0.0))
    ahead, aside = np.array(shape).T * np.array([[length], [beam]])
    x = way.x[k] + ahead * np.cos(psi) - aside * np.sin(psi)
    y = way.y[k] + ahead * np.sin(psi) + aside * np.cos(psi)
    across, down = to_page(x, y)
    return " ".join(f"{a:.1f},{d:.1f}" for a, d in zip(across, down, strict=True))


def _mark(track: TrackSeries, k: int, to_page: _Frame) -> Mark:
    across, down = to_page(track.measured.x[k : k + 1], track.measured.y[k : k + 1])
    t = float(track.t[k])
    return Mark(t, float(across[0]), float(down[0]), f"{t:.0f} s")


def _round_length(most: float) -> float:
    """The longest of 1, 2, 5, 10 ... that is not longer.

    >>> _round_length(730.0), _round_length(0.3)
    (500.0, 0.2)
    """
    ten = 10.0 ** np.floor(np.log10(most))
    return float(max(m for m in (ten, 2.0 * ten, 5.0 * ten) if m <= most * (1.0 + 1e-9)))


def _arrow(current: Sequence[float] | None, least: float = SLOWEST) -> float | None:
    """Where water or air goes, clockwise from north [deg]; None where it is still or not known."""
    if current is None or float(np.hypot(current[0], current[1])) < least:
        return None
    return float(np.degrees(np.arctan2(current[1], current[0])) % 360.0)


def _current_words(current: Sequence[float] | None) -> str:
    if current is None:
        return "current not known"
    towards = _arrow(current)
    if towards is None:
        return "no current"
    speed = float(np.hypot(current[0], current[1]))
    return f"current {wording.number(speed, 2)} m/s to {towards:03.0f}°"


def _wind_words(wind: Sequence[float] | None) -> str:
    """Winds are called by where they come from."""
    towards = _arrow(wind, CALM)
    if wind is None or towards is None:
        return "wind not recorded" if wind is None else "no wind"
    speed = float(np.hypot(wind[0], wind[1]))
    return f"mean wind {wording.number(speed, 2)} m/s from {(towards + 180.0) % 360.0:03.0f}°"
