"""One output of every trial as a picture: measured, predicted, and what is between them."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.errors import TrialidError, nearest
from trialid.names import labels
from trialid.result.series import OutputSeries, TrialSeries

WIDTH: Final = 900.0
HEIGHT: Final = 120.0
RESIDUAL: Final = 46.0
LEFT: Final = 64.0
TOP: Final = 22.0
GAP: Final = 18.0
POINTS: Final = 1200
"""Points of a line: more than a screen shows."""

MEASURED, PREDICTED, LEFTOVER = "#8a8f98", "#c2410c", "#1d4ed8"


@dataclass(frozen=True)
class Plot:
    """A picture as SVG text; a notebook shows it by itself."""

    svg: str

    def _repr_html_(self) -> str:
        return self.svg

    def save(self, path: str | Path) -> Path:
        """Write the picture to a new `.svg` file.

        Raises
        ------
        TrialidError
            The file exists already.
        """
        place = Path(path)
        if place.exists():
            raise TrialidError(f"{place}: exists; name another file")
        place.write_text(self.svg, encoding="utf-8")
        return place


def plot(series: Sequence[TrialSeries], output: str) -> Plot:
    """Measured and predicted of an output, a panel each trial with the residual below.

    Raises
    ------
    TrialidError
        No trial compares this output.
    """
    found = [(s, o) for s in series for o in s.outputs if o.name == output]
    if not found:
        names = dict.fromkeys(o.name for s in series for o in s.outputs)
        raise TrialidError(f"no output {output!r} was compared; {nearest(output, names)}")
    step = TOP + HEIGHT + RESIDUAL + GAP
    panels = [_panel(s, o, k * step) for k, (s, o) in enumerate(found)]
    height = step * len(found) + 8.0
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:g} {height:g}" '
        f'width="100%" style="max-width:{WIDTH:g}px;background:#fff" role="img" '
        f'aria-label="{escape(labels.label(output))}: measured and predicted" '
        'font-family="sans-serif" font-size="11">'
    )
    return Plot("\n".join([head, *panels, "</svg>"]))


def _panel(trial: TrialSeries, output: OutputSeries, top: float) -> str:
    """A trial: its name and legend, the two curves, and the residual on its own scale."""
    factor = labels.shown_factor(output.name)
    measured, predicted = output.observed * factor, output.predicted * factor
    left, shown, curves = measured - predicted, output.compared, top + TOP
    ends = _range(np.concatenate([measured[shown], predicted]))
    rest = _range(left[shown])
    upper, lower = _Box(curves, HEIGHT, ends), _Box(curves + HEIGHT, RESIDUAL, rest)
    return "\n".join(
        [
            _heading(trial, output.name, top),
            _frame(upper),
            _line(trial.t, measured, shown, upper, MEASURED),
            _line(trial.t, predicted, None, upper, PREDICTED),
            _frame(lower, trial.t),
            _line(trial.t, left, shown, lower, LEFTOVER),
        ]
    )


@dataclass(frozen=True)
class _Box:
    """A box of the picture and the ends of its scale."""

    top: float
    height: float
    ends: tuple[float, float]


def _heading(trial: TrialSeries, output: str, top: float) -> str:
    use = "fitted" if trial.use == "fit" else "held out"
    title = f"{escape(trial.name)} ({use}), {escape(labels.label(output))} "
    title += f"[{escape(labels.shown_unit(output))}]"
    colours = {"measured": MEASURED, "predicted": PREDICTED, "residual": LEFTOVER}
    legend = "".join(f'<tspan dx="14" fill="{c}">{word}</tspan>' for word, c in colours.items())
    return f'<text x="{LEFT:g}" y="{top + 14:g}" fill="#111">{title}{legend}</text>'


def _range(y: Vector) -> tuple[float, float]:
    finite = y[np.isfinite(y)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    room = 0.05 * (high - low) or 1.0
    return low - room, high + room


def _frame(box: _Box, t: Vector | None = None) -> str:
    """A box with its ends of the scale, and of time where it is the lowest."""
    right = WIDTH - 8.0
    low, high = box.ends
    made = [
        f'<rect x="{LEFT:g}" y="{box.top:.1f}" width="{right - LEFT:g}" height="{box.height:g}" '
        'fill="none" stroke="#d4d4d8"/>'
    ]
    for y, value in ((box.top + 10.0, high), (box.top + box.height - 3.0, low)):
        made.append(f'<text x="{LEFT - 6:g}" y="{y:.1f}" text-anchor="end">{value:.3g}</text>')
    if t is not None:
        below = box.top + box.height + 12.0
        made.append(f'<text x="{LEFT:g}" y="{below:.1f}">{t[0]:g} s</text>')
        made.append(f'<text x="{right:g}" y="{below:.1f}" text-anchor="end">{t[-1]:g} s</text>')
    return "".join(made)


def _line(t: Vector, y: Vector, shown: Mask | None, box: _Box, colour: str) -> str:
    """A curve in its box, broken where nothing was compared."""
    keep = np.unique(np.linspace(0, len(t) - 1, POINTS).round().astype(int))
    low, high = box.ends
    x = LEFT + (WIDTH - 8.0 - LEFT) * (t[keep] - t[0]) / max(float(t[-1] - t[0]), 1e-9)
    v = box.top + box.height * (high - y[keep]) / (high - low)
    there = np.isfinite(v) & (True if shown is None else shown[keep])
    path, pen = [], "M"
    for a, b, on in zip(x, v, there, strict=True):
        if on:
            path.append(f"{pen}{a:.1f},{b:.1f}")
        pen = "L" if on else "M"
    return f'<path d="{"".join(path)}" fill="none" stroke="{colour}" stroke-width="1"/>'
