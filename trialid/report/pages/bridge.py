"""What the crew is handed: a page for the bridge, the orders as CSV, a pipeline for the log."""

import csv
import io
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any, Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage
from trialid.design.limits import Limits
from trialid.report.pages import bridge_orders, drive_orders
from trialid.report.pages.bridge_orders import clock

WIDTH, HEIGHT, MARGIN = 640.0, 170.0, 42.0
"""px of a picture's view box; the margin holds the labels."""
TRACK: Final = 300.0
POINTS: Final = 1200
"""Points a line is drawn with at most."""


@dataclass(frozen=True)
class Line:
    """A signal over time as an SVG path, with the labels of its axes and its limit."""

    title: str
    path: str
    ticks: tuple[tuple[float, str], ...]
    times: tuple[tuple[float, str], ...]
    limit: tuple[float, ...]


@dataclass(frozen=True)
class Track:
    """The track from above, ahead upwards, as an SVG path; marks every few minutes."""

    path: str
    width: float
    height: float
    marks: tuple[tuple[float, float, str], ...]
    scale: float
    scale_words: str


@dataclass(frozen=True)
class Sheet:
    """One test of the page."""

    name: str
    what: str
    orders: tuple[tuple[str, str, str], ...]
    left_out: int
    sentences: tuple[str, ...]
    driven: bool
    expect: tuple[tuple[str, str], ...]
    lines: tuple[Line, ...]
    track: Track
    approach: float
    duration: str


def page(design: Mapping[str, Any], sheets: Sequence[Sheet], aborts: Sequence[str]) -> str:
    """The page for the bridge: one HTML file, black on white, made to be printed."""
    from trialid.report import templates

    files = resources.files("trialid.report")
    style = files.joinpath("bridge.css").read_text(encoding="utf-8")
    template = templates.environment("trialid", "report").get_template("bridge.html.j2")
    return template.render(design=design, sheets=sheets, aborts=aborts, style=style)


def sheet(test: Mapping[str, Any], passage: Passage, limits: Limits) -> Sheet:
    """One test, in words and pictures."""
    rows = tuple((clock(t), words, f"{np.rad2deg(psi):+.0f}") for t, words, psi in _told(passage))
    kept = rows[: bridge_orders.MOST]
    return Sheet(
        name=test["name"] or test["what"],
        what=test["what"],
        orders=kept,
        left_out=len(rows) - len(kept),
        sentences=tuple(bridge_orders.sentences(test["kind"], test["numbers"])),
        driven=bool(passage.driven),
        expect=tuple(_expected(passage)),
        lines=tuple(_lines(passage, limits)),
        track=_track(passage),
        approach=test["approach"],
        duration=clock(test["duration"]),
    )


def _told(passage: Passage) -> Iterator[tuple[float, str, float]]:
    """When what is ordered, and the heading expected then [rad]."""
    if passage.driven:
        yield from ((o.t, o.words, o.heading) for o in drive_orders.orders(passage))
        return
    signals = passage.trial.signals
    for o in bridge_orders.orders(passage.trial.t, signals["delta_order"], signals["psi"]):
        yield o.t, bridge_orders.order_words(o.angle), o.heading


def aborts(limits: Limits) -> list[str]:
    """When to break off, in sentences."""
    said = []
    if limits.heel is not None:
        said.append(f"heel beyond {np.rad2deg(limits.heel):.3g} deg")
    if limits.speed_loss is not None:
        said.append(f"more than {100 * limits.speed_loss:.3g} % of the approach speed lost")
    if limits.room is not None:
        ahead, side, astern = limits.room
        said.append(
            f"more than {ahead:.0f} m ahead, {side:.0f} m to either side or {astern:.0f} m astern "
            "of where the test began"
        )
    return said


def order_csv(passage: Passage) -> str:
    """The orders by time: seconds from the start, degrees to starboard, or drives in SI."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    trial = passage.trial
    if passage.driven:
        units_of = [f"{one.name}_order[{one.unit}]" for one in passage.driven]
        writer.writerow(["t[s]", *units_of, "order"])
        for told in drive_orders.orders(passage):
            values = (f"{x:.4f}" for x in told.drives.values())
            writer.writerow([f"{told.t:.3f}", *values, told.words])
        return text.getvalue()
    writer.writerow(["t[s]", "rudder_order[deg]", "order"])
    ordered = trial.signals["delta_order"]
    places = np.concatenate([[0], np.flatnonzero(np.diff(ordered)) + 1])
    for k in places:
        angle = float(ordered[k])
        row = [f"{trial.t[k]:.3f}", f"{np.rad2deg(angle):.4f}", bridge_orders.order_words(angle)]
        writer.writerow(row)
    return text.getvalue()


def file_name(name: str, taken: set[str]) -> str:
    """A name for files, of letters every system takes; each once.

    >>> file_name("zig-zag 10/10", set()), file_name("zig-zag 10 10", {"zig-zag-10-10"})
    ('zig-zag-10-10', 'zig-zag-10-10-2')
    """
    stem = re.sub(r"[^a-z0-9]+", "-", name.lower(), flags=re.ASCII).strip("-") or "test"
    chosen, count = stem, 1
    while chosen in taken:
        count += 1
        chosen = f"{stem}-{count}"
    taken.add(chosen)
    return chosen


def _expected(passage: Passage) -> Iterator[tuple[str, str]]:
    signals = passage.trial.signals
    if "phi" in signals:
        yield "largest heel", f"{np.rad2deg(np.abs(signals['phi']).max()):.1f} deg"
    yield "fastest turn", f"{np.rad2deg(np.abs(signals['r']).max()) * 60:.0f} deg/min"
    if "u" in signals:
        knots = signals["u"] * 3600.0 / 1852.0
        yield "speed", f"{knots[0]:.1f} kn, down to {knots.min():.1f} kn"
    yield "ahead", f"{passage.x.max():.0f} m"
    yield "to starboard and port", f"{passage.y.max():.0f} m and {-passage.y.min():.0f} m"


def _lines(passage: Passage, limits: Limits) -> Iterator[Line]:
    trial, signals = passage.trial, passage.trial.signals
    degrees = float(np.rad2deg(1.0))
    for title, values in drive_orders.courses(passage):
        yield _line(title, trial.t, values, None)
    if not passage.driven:
        order = signals["delta_order"] * degrees
        yield _line("rudder order [deg, starboard up]", trial.t, order, None)
    yield _line("heading from the course [deg]", trial.t, signals["psi"] * degrees, None)
    if "phi" in signals:
        limit = None if limits.heel is None else limits.heel * degrees
        yield _line("heel [deg, starboard down up]", trial.t, signals["phi"] * degrees, limit)


def _line(title: str, t: Vector, y: Vector, limit: float | None) -> Line:
    low, high = float(min(y.min(), 0.0)), float(max(y.max(), 0.0))
    room = max(high - low, 1e-9) * 0.06
    low, high = low - room, high + room

    def across(time: float) -> float:
        return MARGIN + (WIDTH - MARGIN - 8.0) * time / max(float(t[-1]), 1e-9)

    def down(value: float) -> float:
        return 8.0 + (HEIGHT - 30.0) * (high - value) / (high - low)

    places = np.unique(np.linspace(0, len(t) - 1, min(len(t), POINTS)).round().astype(int))
    points = [f"{across(float(t[k])):.1f},{down(float(y[k])):.1f}" for k in places]
    ticks = tuple((down(v), f"{v + 0.0:g}") for v in _round_values(low, high, 4))
    times = tuple((across(s), clock(s)) for s in _round_values(0.0, float(t[-1]), 6, _MINUTES))
    shown = [] if limit is None else [x for x in (limit, -limit) if low < x < high]
    return Line(title, "M" + " L".join(points), ticks, times, tuple(down(x) for x in shown))


_MINUTES: Final = (10, 30, 60, 120, 300, 600, 1200, 3600)
_STEPS: Final = tuple(m * 10.0**p for p in range(-3, 5) for m in (1, 2, 5))


def _round_values(
    low: float, high: float, most: int, steps: Sequence[float] = _STEPS
) -> list[float]:
    """Round numbers between two, no more than so many."""
    step = next((s for s in steps if (high - low) / s <= most), steps[-1])
    first = np.ceil(low / step)
    return [float(k * step) for k in np.arange(first, np.floor(high / step) + 1)]


def _track(passage: Passage) -> Track:
    x, y, t = passage.x, passage.y, passage.trial.t
    span = max(float(np.ptp(x)), float(np.ptp(y)), 1.0)
    factor = TRACK / span
    across = 20.0 + (y - y.min()) * factor
    down = 20.0 + (x.max() - x) * factor
    places = np.unique(np.linspace(0, len(t) - 1, min(len(t), POINTS)).round().astype(int))
    path = "M" + " L".join(f"{across[k]:.1f},{down[k]:.1f}" for k in places)
    marks = []
    for s in _round_values(0.0, float(t[-1]), 8, _MINUTES):
        k = min(int(np.searchsorted(t, s)), len(t) - 1)
        marks.append((float(across[k]), float(down[k]), clock(s)))
    length = max(m for m in _STEPS if m <= span / 2.0)
    return Track(
        path, float(np.ptp(y)) * factor + 100.0, float(np.ptp(x)) * factor + 60.0, tuple(marks),
        length * factor, f"{length:g} m",
    )  # fmt: skip
