"""Small pictures of what was found, as geometry for inline SVG; units are px of the view box.

Bars: the mean square of each bin over the average, with its interval, and below it the mean of
measured less predicted. Spectra: the residual's, and in it what follows the rudder. Anything that a
result does not hold is left out; a picture without numbers is no picture.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from trialid.diagnosis.where.finding import Bars, Spectrum
from trialid.names import wording

WIDTH = 340.0
LEFT, RIGHT = 72.0, 16.0
TOP, FLOOR = 8.0, 84.0
"""Where the squares stand."""

MEAN_TOP, MEAN_FLOOR = 94.0, 134.0
"""Where the means stand."""

TALLEST = 0.92
"""Share of the height that what is tallest takes, a bar or a whisker, ..."""
REACH = 2.0
"""... which may be so many times as tall as the tallest bar; a longer one leaves the picture."""

CERTAIN = 1.96


@dataclass(frozen=True)
class Box:
    """A rectangle, with the words that appear over it."""

    x: float
    y: float
    width: float
    height: float
    standing: bool
    title: str


@dataclass(frozen=True)
class Line:
    """A straight line."""

    x1: float
    y1: float
    x2: float
    y2: float


@dataclass(frozen=True)
class Tick:
    """A word at a place on the axis below."""

    x: float
    word: str
    anchor: str = "middle"


@dataclass(frozen=True)
class Picture:
    """What the template draws; `average` is the height of the mean over everything."""

    label: str
    height: float
    boxes: tuple[Box, ...]
    whiskers: tuple[Line, ...]
    ticks: tuple[Tick, ...]
    average: float | None
    zero: float | None
    left: tuple[tuple[float, str], ...]
    below: str
    density: str = ""
    coherent: str = ""


def picture(given: Bars | Spectrum | None) -> Picture | None:
    """A finding's picture, None where it has none or holds nothing to draw."""
    try:
        match given:
            case Bars():
                return _bars(given)
            case Spectrum():
                return _spectrum(given)
    except (LookupError, ValueError, ZeroDivisionError):  # lists of other lengths: it was edited
        return None
    return None


def _bars(given: Bars) -> Picture:
    by, unit = given.by, given.unit
    places = _places(given.edges)
    tallest = max(*given.mean_square, 1.0)
    top = max(tallest, min(max(given.high), REACH * tallest))
    scale = TALLEST * (FLOOR - TOP) / top
    names = given.names or _ranges(given.edges, unit)
    boxes, whiskers = [], []
    for k, (a, b) in enumerate(places):
        height = scale * given.mean_square[k]
        boxes.append(
            Box(a + 1.0, FLOOR - height, b - a - 2.0, height, given.standing[k],
                _title(given, names[k], k))
        )  # fmt: skip
        ends = [max(FLOOR - scale * getattr(given, end)[k], 1.0) for end in ("low", "high")]
        whiskers.append(Line(0.5 * (a + b), ends[0], 0.5 * (a + b), ends[1]))
    left = [(FLOOR - scale + 3.5, "average"), (FLOOR + 3.5, "0")]
    below, zero, bottom = f"{by} [{unit}]" if unit else "", None, FLOOR
    if given.mean is not None:
        zero, bottom = 0.5 * (MEAN_TOP + MEAN_FLOOR), MEAN_FLOOR
        more, lines = _means(given, places, names)
        boxes, whiskers = boxes + more, whiskers + lines
        reach = f"{wording.number(_reach(given), 2)} {given.mean_unit}"
        left += [(MEAN_TOP + 4.0, reach), (zero + 3.5, "mean")]
        left += [(MEAN_FLOOR + 2.0, f"{wording.MINUS}{reach}")]
    return Picture(
        label=f"Error by {by}",
        height=bottom + (30.0 if below else 18.0),
        boxes=tuple(boxes),
        whiskers=tuple(whiskers),
        ticks=tuple(_ticks(given, places)),
        average=FLOOR - scale,
        zero=zero,
        left=tuple(left),
        below=below,
    )


def _places(edges: Sequence[float]) -> list[tuple[float, float]]:
    """Left and right end of each bin."""
    first, last = edges[0], edges[-1]
    scale = (WIDTH - LEFT - RIGHT) / (last - first)
    at = [LEFT + scale * (edge - first) for edge in edges]
    return list(itertools.pairwise(at))


def _ranges(edges: Sequence[float], unit: str) -> list[str]:
    return [f"{_edge(a)} to {_edge(b)} {unit}"
            for a, b in itertools.pairwise(edges)]  # fmt: skip


def _title(given: Bars, name: str, k: int) -> str:
    samples, share = (wording.percent(getattr(given, key)[k], 2) for key in ("samples", "share"))
    times = wording.number(given.mean_square[k], 2)
    return f"{name}: {samples} of the samples, {share} of the squared error, {times} times average"


def _means(
    given: Bars, places: Sequence[tuple[float, float]], names: Sequence[str]
) -> tuple[list[Box], list[Line]]:
    """Signed bars about a zero line, each with 95 % either way."""
    mean, error, unit = given.mean or (), given.error or (), given.mean_unit
    reach = _reach(given)
    zero, scale = 0.5 * (MEAN_TOP + MEAN_FLOOR), 0.5 * (MEAN_FLOOR - MEAN_TOP) / (reach or 1.0)
    boxes, lines = [], []
    for (a, b), m, e, name, standing in zip(
        places, mean, error, names, given.standing, strict=True
    ):
        y = zero - scale * m
        said = f"{name}: measured less predicted {wording.number(m, 2)} {unit} on average"
        said += f", standard error {wording.number(e, 2)}"
        boxes.append(Box(a + 1.0, min(y, zero), b - a - 2.0, abs(y - zero), standing, said))
        middle, half = 0.5 * (a + b), scale * CERTAIN * e
        lines.append(Line(middle, y - half, middle, y + half))
    return boxes, lines


def _reach(given: Bars) -> float:
    """How far the means go, their errors included."""
    both = zip(given.mean or (), given.error or (), strict=True)
    return max((abs(m) + CERTAIN * e for m, e in both), default=0.0)


def _ticks(given: Bars, places: Sequence[tuple[float, float]]) -> list[Tick]:
    """Names under their bins, or edges where they do not crowd."""
    if given.names:
        room = int((places[0][1] - places[0][0]) / 5.6)
        return [Tick(0.5 * (a + b), _shortened(name, room))
                for (a, b), name in zip(places, given.names, strict=True)]  # fmt: skip
    at = [places[0][0], *(b for _, b in places)]
    ticks: list[Tick] = []
    for x, edge in zip(at, given.edges, strict=True):
        if not ticks or x - ticks[-1].x > 34.0:
            ticks.append(Tick(x, _edge(edge)))
    return ticks


def _edge(value: float) -> str:
    words = f"{value:.0f}" if abs(value) >= 100.0 else f"{value:.6g}"
    return words.replace("-", wording.MINUS)


def _shortened(name: str, room: int) -> str:
    """A name cut to its room; points of the compass by their initials."""
    if len(name) <= room:
        return name
    words = name.split("-")
    if set(words) <= {"north", "east", "south", "west"}:
        return "".join(word[0] for word in words).upper()
    return name[: max(room - 1, 1)] + "\N{HORIZONTAL ELLIPSIS}"


def _spectrum(given: Spectrum) -> Picture:
    frequency, density = given.frequency, given.density
    last = _last(density)
    reach, top = frequency[last], max(density[: last + 1])
    across = (WIDTH - LEFT - RIGHT) / reach
    up = TALLEST * (FLOOR - TOP) / top

    def path(values: Sequence[float]) -> str:
        points = [
            f"{LEFT + across * w:.1f},{FLOOR - up * v:.1f}"
            for w, v in zip(frequency[: last + 1], values[: last + 1], strict=True)
        ]
        return (
            f"M{LEFT:.1f},{FLOOR:.1f} L"
            + " L".join(points)
            + f" L{WIDTH - RIGHT:.1f},{FLOOR:.1f} Z"
        )

    step = _round_step(reach / 5.0)
    ticks = [
        Tick(LEFT + across * k * step, f"{k * step:g}")
        for k in range(int(reach / step * 1.0001) + 1)
    ]
    return Picture(
        label="Spectrum of the residual",
        height=FLOOR + 30.0,
        boxes=(),
        whiskers=(),
        ticks=tuple(ticks),
        average=None,
        zero=None,
        left=((FLOOR + 3.5, "0"),),
        below="frequency [rad/s]",
        density=path(density),
        coherent=path(given.coherent),
    )


def _last(density: Sequence[float]) -> int:
    """Half as far again as where 95 % of the squared error has been met."""
    total, held = sum(density), 0.0
    for k, part in enumerate(density):
        held += part
        if held >= 0.95 * total and k > 4:
            return min(k + k // 2, len(density) - 1)
    return len(density) - 1


def _round_step(least: float) -> float:
    power = 10.0 ** math.floor(math.log10(least))
    return next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= least)
