"""Pictures of a missing force as SVG: over each trial with its band, and against each signal."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trialid.arrays import Vector
from trialid.names import labels
from trialid.result.finding_rows import ForceEquationRow
from trialid.result.force_series import ForceSeries
from trialid.result.schema import Result

WIDTH, HEIGHT = 1100.0, 110.0
SIDE = (250.0, 150.0)
POINTS = 500
"""Points of a line: more than a screen shows."""

BINS = 14
PREFIXES = {0: "", 1: "k", 2: "M", 3: "G"}
NAMES = {"X": "surge force", "Y": "sway force", "K": "roll moment", "N": "yaw moment"}


@dataclass(frozen=True)
class Course:
    """A force over one trial: paths in a box of `WIDTH` by `HEIGHT`, zero in the middle."""

    trial: str
    band: str
    force: str
    terms: str
    duration: float


@dataclass(frozen=True)
class Bin:
    """The force where a signal has about one value: mean and the middle two thirds."""

    x: float
    y: float
    low: float
    high: float


@dataclass(frozen=True)
class Against:
    """A force against one signal, in a box of `SIDE`; zero lines at `x0` and `y0`."""

    signal: str
    followed: bool
    bins: tuple[Bin, ...]
    terms: str
    x0: float | None
    low: str
    high: str


@dataclass(frozen=True)
class Picture:
    """One equation: what is said of it and its pictures; `top` is the force at the upper edge."""

    row: str
    name: str
    said: ForceEquationRow
    top: str
    courses: tuple[Course, ...]
    against: tuple[Against, ...]


def pictures(run: Result, series: Sequence[ForceSeries]) -> list[Picture]:
    """Pictures of every equation that a force may be missing in, the likeliest first."""
    if run.missing_force is None or not series:
        return []
    said = {e.equation: e for e in run.missing_force.equations}
    return [_picture(row, said[row], series) for row in run.missing_force.possible]


def _picture(row: str, said: ForceEquationRow, series: Sequence[ForceSeries]) -> Picture:
    top = max(float(np.max(np.abs(s.force[row]) + 2.0 * s.error[row])) for s in series) or 1.0
    return Picture(
        row, NAMES[row], said, _size(top, said.unit),
        tuple(_course(s, row, top) for s in series), _sides(row, said, series),
    )  # fmt: skip


def _size(force: float, unit: str) -> str:
    """A force with the prefix that leaves it between 1 and 1000.

    >>> _size(2.3e6, "N m")
    '2.3 MN m'
    """
    power = int(np.clip(np.log10(max(force, 1.0)) // 3, 0, 3))
    return f"{force / 1000.0**power:.3g} {PREFIXES[power]}{unit}"


def _course(s: ForceSeries, row: str, top: float) -> Course:
    keep = np.unique(np.linspace(0, len(s.t) - 1, POINTS).round().astype(int))
    x = WIDTH * s.t[keep] / max(float(s.t[-1]), 1e-9)
    force, error, terms = (part[row][keep] for part in (s.force, s.error, s.terms))

    def height(y: Vector) -> Vector:
        return np.asarray(0.5 * HEIGHT * (1.0 - y / top))

    band = _points(
        np.concatenate([x, x[::-1]]),
        np.concatenate([height(force + 2.0 * error), height(force - 2.0 * error)[::-1]]),
    )
    drawn = _points(x, height(np.clip(terms, -top, top))) if terms.any() else ""
    return Course(s.trial, band, _points(x, height(force)), drawn, float(s.t[-1]))


def _points(x: Vector, y: Vector) -> str:
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))


def _sides(row: str, said: ForceEquationRow, series: Sequence[ForceSeries]) -> tuple[Against, ...]:
    """The force against each signal that moves, on one scale; the one it follows best first."""
    force = np.concatenate([s.force[row] for s in series])
    terms = np.concatenate([s.terms[row] for s in series])
    signals = [n for n in series[0].signals if all(n in s.signals for s in series)]
    found = []
    for name in signals:
        x = np.concatenate([s.signals[name] for s in series]) * labels.shown_factor(name)
        if np.ptp(x) > 1e-9 * np.abs(x).max():
            found.append((name, x, _binned(x, force, terms)))
    found.sort(key=lambda each: -float(np.var([row[1] for row in each[2]])))
    top = max((abs(v) for _, _, rows in found for _, *ys in rows for v in ys), default=1.0) or 1.0
    return tuple(_against(n, x, rows, top, n in said.signals) for n, x, rows in found)


def _binned(x: Vector, force: Vector, terms: Vector) -> list[tuple[float, ...]]:
    """Per bin of equally many samples: signal, mean force, its middle two thirds, mean terms."""
    order = np.array_split(np.argsort(x, kind="stable"), BINS)
    rows = []
    for k in order:
        if len(k):
            low, high = np.quantile(force[k], [1.0 / 6.0, 5.0 / 6.0])
            values = (x[k].mean(), force[k].mean(), low, high, terms[k].mean())
            rows.append(tuple(float(v) for v in values))
    return rows


def _against(
    name: str, x: Vector, rows: Sequence[tuple[float, ...]], top: float, followed: bool
) -> Against:
    width, height = SIDE
    low, high = rows[0][0], rows[-1][0]
    room = (high - low) or 1.0

    def across(value: float) -> float:
        return 8.0 + (width - 16.0) * (value - low) / room

    def up(value: float) -> float:
        return 0.5 * height * (1.0 - 0.94 * value / top)

    bins = tuple(Bin(across(a), up(m), up(b), up(c)) for a, m, b, c, _ in rows)
    curve = " ".join(f"{across(a):.1f},{up(t):.1f}" for a, *_, t in rows)
    unit = labels.shown_unit(name)
    return Against(
        signal=labels.symbol(name),
        followed=followed,
        bins=bins,
        terms=curve if any(r[4] for r in rows) else "",
        x0=across(0.0) if low < 0.0 < high else None,
        low=f"{low:.3g}",
        high=f"{high:.3g} {unit}",
    )
