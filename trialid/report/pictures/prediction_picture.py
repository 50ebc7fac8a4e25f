"""A predicted manoeuvre as pictures: every motion over time in its range, and the track to scale.

Geometry in px of a view box, for whoever draws it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.prediction.ranged_motion import TRACK, PredictedMotion
from trialid.names import labels

WIDTH, HEIGHT = 340.0, 74.0
"""Of the panel of one signal."""
TALLEST: Final = 420.0
"""Of the track."""
MARGIN: Final = 22.0
POINTS: Final = 300
BOXES: Final = 8
"""Instants at which the track shows where she may be instead."""
NOTHING: Final = 0.005
"""Share of a scale that is no number worth writing."""
ORDERED: Final = ("delta", "delta_order")


@dataclass(frozen=True, kw_only=True)
class MotionPanel:
    """One signal: its line, and the outline of its range, empty for an order; ends of its scale."""

    title: str
    unit: str
    low: str
    high: str
    line: str
    band: str


@dataclass(frozen=True, kw_only=True)
class TrackPlan:
    """The track, ahead upwards, and boxes where she is likely to be; `scale` is a bar in px."""

    height: float
    line: str
    boxes: tuple[str, ...]
    times: tuple[str, ...]
    scale: float
    scale_words: str


@dataclass(frozen=True, kw_only=True)
class PredictionPicture:
    """All panels over the same time, and the track beside them."""

    width: float
    height: float
    seconds: str
    panels: tuple[MotionPanel, ...]
    track: TrackPlan | None


def prediction_picture(made: PredictedMotion) -> PredictionPicture:
    """The pictures of a manoeuvre."""
    kept = np.unique(np.linspace(0, len(made.t) - 1, POINTS).round().astype(int))
    steered = next((n for n in ORDERED if n in made.given), None)
    panels = [] if steered is None else [_panel(made, steered, kept)]
    panels += [_panel(made, n, kept) for n in made.motion if n not in TRACK and n != steered]
    return PredictionPicture(
        width=WIDTH,
        height=HEIGHT,
        seconds=f"{made.t[-1]:.0f} s",
        panels=tuple(panels),
        track=_track(made, kept),
    )


def _panel(made: PredictedMotion, name: str, kept: Vector) -> MotionPanel:
    factor, t = labels.shown_factor(name), made.t[kept]
    values = factor * ({**made.given, **made.motion}[name])[kept]
    ends = [factor * x[kept] for x in made.ranges.get(name, ())]
    everything = np.concatenate([values, *ends])
    low, high = float(np.nanmin(everything)), float(np.nanmax(everything))
    room = 0.05 * (high - low) or 1.0
    scale = HEIGHT / (high - low + 2.0 * room)

    def page(y: Vector) -> Iterator[tuple[float, float]]:
        across = WIDTH * (t - t[0]) / (t[-1] - t[0])
        return zip(across.tolist(), (scale * (high + room - y)).tolist(), strict=True)

    shown = np.isfinite(everything.reshape(-1, len(kept))).all(axis=0)
    band = ""
    if ends and shown.any():
        lower, upper = ([p for p, s in zip(page(x), shown, strict=True) if s] for x in ends)
        band = _points([*lower, *reversed(upper)])
    return MotionPanel(
        title=labels.label(name),
        unit=labels.shown_unit(name),
        low=_end(low, high - low),
        high=_end(high, high - low),
        line=_points([p for p, x in zip(page(values), values, strict=True) if np.isfinite(x)]),
        band=band,
    )


def _end(value: float, span: float) -> str:
    """An end of a scale; what is nothing beside its span is zero."""
    return "0" if abs(value) < NOTHING * span else f"{value:.3g}"


def _track(made: PredictedMotion, kept: Vector) -> TrackPlan | None:
    """To scale, x upwards and y to the right; None where she goes nowhere."""
    x, y = (made.motion[n] for n in TRACK)
    at = np.unique(np.linspace(0, len(x) - 1, BOXES + 1).round().astype(int))[1:]
    ends = np.array([[made.ranges[n][i] for i in (0, 1)] for n in TRACK])
    at = at[np.isfinite(ends[:, :, at]).all(axis=(0, 1))]
    north, east = np.append(x[kept], ends[0][:, at]), np.append(y[kept], ends[1][:, at])
    size = max(float(np.ptp(north)), float(np.ptp(east)))
    if not np.isfinite(size) or size <= 0.0:
        return None
    across, tall = WIDTH - 2.0 * MARGIN, TALLEST - 3.0 * MARGIN
    scale = min(across / max(np.ptp(east), 1e-6), tall / max(np.ptp(north), 1e-6))
    left = MARGIN + (across - scale * np.ptp(east)) / 2.0

    def page(ahead: Vector, aside: Vector) -> list[tuple[float, float]]:
        right = left + scale * (np.asarray(aside) - east.min())
        down = MARGIN + scale * (north.max() - np.asarray(ahead))
        return [*zip(right.tolist(), down.tolist(), strict=True)]

    boxes = [_points(page(ends[0][[0, 1, 1, 0], k], ends[1][[0, 0, 1, 1], k])) for k in at.tolist()]
    bar = _round_length(0.3 * WIDTH / scale)
    return TrackPlan(
        height=float(scale * np.ptp(north)) + 3.0 * MARGIN,
        line=_points(page(x[kept], y[kept])),
        boxes=tuple(boxes),
        times=tuple(f"{made.t[k]:.0f} s" for k in at),
        scale=float(bar * scale),
        scale_words=f"{bar:g} m",
    )


def _points(places: list[tuple[float, float]]) -> str:
    return " ".join(f"{a:.1f},{d:.1f}" for a, d in places)


def _round_length(most: float) -> float:
    """The longest of 1, 2, 5, 10 ... that is not longer."""
    ten = 10.0 ** np.floor(np.log10(most))
    return float(max(m for m in (ten, 2.0 * ten, 5.0 * ten) if m <= most * (1.0 + 1e-9)))
