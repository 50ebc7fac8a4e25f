"""The figures of a report as SVG files of their own: those drawn in the page, bars, and courses."""

import html
import re
from collections.abc import Iterator, Mapping, Sequence
from importlib import resources
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.export.tracks import stems
from trialid.names import labels, wording
from trialid.report.pictures import bars
from trialid.report.words import ranking
from trialid.result.schema import Result
from trialid.result.series import OutputSeries, TrialSeries

MOST: Final = 2000
"""Points of a line; a longer course keeps the least and the greatest value of each stretch."""

ROW: Final = 22.0
NAMES: Final = 200.0
BARS: Final = 420.0
NUMBERS: Final = 130.0

_SECTION = re.compile(r'<section id="([\w-]+)"')
_BOX = re.compile(r'viewBox="0 0 ([\d.]+) ([\d.]+)"')
_LABEL = re.compile(r'aria-label="([^"]*)"')
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")

Part = tuple[float, str]
"""Length of a part of a bar in % of the axis, and its kind, empty for room left free."""

Row = tuple[str, Sequence[Part], str]
"""Name, parts and number of one bar."""


def figures(page: str, run: Result, series: Sequence[TrialSeries]) -> dict[str, str]:
    """File stems and SVG texts: the pictures of the page, its bars, and each output's course."""
    return {**page_pictures(page), **_bar_charts(run), **courses(series)}


def page_pictures(page: str) -> dict[str, str]:
    """The pictures that a page holds as inline SVG, in its order, named by their section."""
    sections = [(m.start(), m[1]) for m in _SECTION.finditer(page)]
    found: dict[str, list[str]] = {}
    for at, head, body in _pictures(page):
        section = [name for start, name in sections if start < at][-1]
        found.setdefault(section, []).append(_alone(section, head, body))
    return {
        name if len(texts) == 1 else f"{name}-{place}": text
        for name, texts in found.items()
        for place, text in enumerate(texts, start=1)
    }


def _pictures(page: str) -> Iterator[tuple[int, str, str]]:
    """Where each picture with a frame of its own begins in a page, its head and its body."""
    at = page.find("<svg")
    while at >= 0:
        head, _, rest = page[at + 4 : page.find("</svg>", at)].partition(">")
        if "viewBox=" in head:
            yield at, head, rest
        at = page.find("<svg", at + 4)


def _alone(section: str, head: str, body: str) -> str:
    """A picture of the page as a file, its label as a line above it."""
    box, label = _BOX.search(head), _LABEL.search(head)
    width, height = (float(side) for side in box.groups()) if box else (0.0, 0.0)
    words = html.unescape(label[1]) if label else ""
    return svg(width, height, f'<g class="{section}">{body}</g>', words)


def svg(width: float, height: float, body: str, title: str = "") -> str:
    """A picture that stands alone, its title as a line above it."""
    room = 24.0 if title else 0.0
    head = f"<title>{_text(title)}</title>" if title else ""
    words = f'<text class="name" x="4" y="-8">{_text(title)}</text>' if title else ""
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height + room:g}" '
        f'viewBox="0 {-room:g} {width:g} {height + room:g}" role="img" style="background:#fff">'
        f"{head}"
        f"<style>{_style()}</style>{words}{body}</svg>\n"
    )
    return _CONTROL.sub(" ", text)


def _style() -> str:
    return resources.files("trialid.report").joinpath("figure.css").read_text(encoding="utf-8")


def _text(words: str) -> str:
    return html.escape(words, quote=True)


def _bar_charts(run: Result) -> dict[str, str]:
    """The bars that the page makes of boxes; charts without a bar are left out."""
    charts = {
        "accuracy": (
            "Likely ranges of the parameters, and what noise alone leaves",
            _accuracy(run),
        ),
        "error": ("The error and what it is made of: noise and model", _split(run)),
        "ranking": ("The error with each leading candidate", _ranking(run)),
        "change": ("The error before and after", _change(run)),
    }
    return {name: _chart(title, rows) for name, (title, rows) in charts.items() if rows}


def _accuracy(run: Result) -> list[Row]:
    rows = run.physical
    _, drawn = bars.range_bars(rows)
    return [
        (
            row.name,
            _range(bar) if bar else [],
            f"may be off by {wording.percent(row.may_be_off, 2)}",
        )
        for row, bar in zip(rows, drawn, strict=True)
    ]


def _range(bar: bars.RangeBar) -> list[Part]:
    """A likely range with what noise leaves in it, from the left end of the track."""
    (low, high), (first, last) = bar.likely, bar.noise
    first, last = max(first, low), min(last, high)
    return [(low, ""), (first - low, "model"), (last - first, "noise"), (high - last, "model"),
            (100.0 - high, "")]  # fmt: skip


def _split(run: Result) -> list[Row]:
    rows: list[Row] = []
    for bar in bars.split_bars(run):
        share = bar.noise_share
        parts = [(bar.length, "whole-part")]
        if share is not None:
            noise = bar.length * share / 100.0
            parts = [(noise, "noise"), (bar.length - noise, "model")]
        rows.append((bar.label, parts, wording.percent(bar.eps)))
    return rows


def _ranking(run: Result) -> list[Row]:
    return [
        (f"{leader.row.effect}: {bar.label}" if bar is leader.bars[0] else bar.label,
         [(bar.length, bar.kind)], wording.percent(bar.eps))
        for leader in ranking.ranking(run).leaders
        for bar in leader.bars
        if bar.eps is not None
    ]  # fmt: skip


def _change(run: Result) -> list[Row]:
    pair = run.change or run.before_after
    rows: list[Row] = []
    for each in bars.changes(pair) if pair else ():
        rows.append((each.label, [(each.before_length, "before")], wording.percent(each.before)))
        rows.append(
            ("with the change", [(each.after_length, "after")], wording.percent(each.after))
        )
    return rows


def _chart(title: str, rows: Sequence[Row]) -> str:
    # a letter of the names is about 6.6 px wide
    left = max(NAMES, 6.6 * max(len(name) for name, _, _ in rows) + 12.0)
    body = []
    for place, (name, parts, number) in enumerate(rows):
        y, x = ROW * place, left
        body.append(
            f'<text class="name" x="{left - 8:g}" y="{y + 15:g}" text-anchor="end">'
            f"{_text(name)}</text>"
        )
        for length, kind in parts:
            width = BARS * max(length, 0.0) / 100.0
            if kind:
                body.append(
                    f'<rect class="{kind}" x="{x:.1f}" y="{y + 4:g}" width="{width:.1f}" '
                    'height="14"/>'
                )
            x += width
        body.append(f'<text x="{x + 6:.1f}" y="{y + 15:g}">{_text(number)}</text>')
    return svg(left + BARS + NUMBERS, ROW * len(rows) + 6.0, "".join(body), title)


def courses(series: Sequence[TrialSeries]) -> dict[str, str]:
    """Measured, predicted and residual of every output of every trial."""
    made = {}
    for trial, stem in zip(series, stems(each.name for each in series), strict=True):
        ends = stems(output.name for output in trial.outputs)
        for output, end in zip(trial.outputs, ends, strict=True):
            made[f"trial-{stem}-{end}"] = _course(trial, output)
    return made


WIDE: Final = 900.0
LEFT: Final = 70.0
HIGH: Final = 220.0
LOW: Final = 90.0
GAP: Final = 18.0


def _course(trial: TrialSeries, output: OutputSeries) -> str:
    factor, unit = labels.shown_factor(output.name), labels.shown_unit(output.name)
    use = "held out" if trial.use == "check" else "fitted"
    title = f"{trial.name} ({use}): {labels.label(output.name)} [{unit}]"
    above = {"measured": output.observed * factor, "predicted": output.predicted * factor}
    panels = [(above, 0.0, HIGH), ({"residual": output.residual * factor}, HIGH + GAP, LOW)]
    body = "".join(panel(trial.t, lines, top, height) for lines, top, height in panels)
    floor = HIGH + GAP + LOW
    body += clock(trial.t, floor + 14.0) + _legend(floor + 32.0)
    return svg(LEFT + WIDE + 10.0, floor + 40.0, f'<g class="trial">{body}</g>', title)


def panel(t: Vector, lines: Mapping[str, Vector], top: float, height: float) -> str:
    """Lines on one scale, its ends written beside it."""
    known = np.concatenate([x[np.isfinite(x)] for x in lines.values()])
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    span = (high - low) or 1.0
    text = "".join(
        f'<line x1="{LEFT:g}" x2="{LEFT + WIDE:g}" y1="{y:g}" y2="{y:g}"/>'
        f'<text x="{LEFT - 6:g}" y="{y + 4:g}" text-anchor="end">{wording.number(value, 3)}</text>'
        for y, value in ((top, high), (top + height, low))
    )
    for kind, values in lines.items():
        for points in thin(t, values):
            at = np.column_stack((_across(t, points[:, 0]),
                                  top + height * (high - points[:, 1]) / span))  # fmt: skip
            drawn = " ".join(f"{x:.1f},{y:.1f}" for x, y in at)
            text += f'<polyline class="{kind}" points="{drawn}"/>'
    return text


def _across(t: Vector, at: Vector) -> Vector:
    return LEFT + WIDE * (at - t[0]) / (float(t[-1] - t[0]) or 1.0)


def clock(t: Vector, y: float) -> str:
    """The ends of the trial's clock."""
    if not len(t):
        return ""
    ends = ((LEFT, "start", t[0]), (LEFT + WIDE, "end", t[-1]))
    return "".join(
        f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}">{wording.number(float(s))} s</text>'
        for x, anchor, s in ends
    )


def _legend(y: float) -> str:
    text = ""
    for place, kind in enumerate(("measured", "predicted", "residual")):
        x = LEFT + 120.0 * place
        text += f'<polyline class="{kind}" points="{x:g},{y - 4:g} {x + 24:g},{y - 4:g}"/>'
        text += f'<text x="{x + 30:g}" y="{y:g}">{kind}</text>'
    return text


def thin(t: Vector, values: Vector, most: int = MOST) -> list[Vector]:
    """Pieces between gaps, (n, 2) each: t [s] and value, at most about `most` points in all.

    Of each stretch of equally many samples the least and the greatest value stay, in their order.

    >>> [p[:, 1].tolist() for p in thin(np.arange(6.0), np.array([0, 5, 1, -4, 2, 3.0]), 4)]
    [[0.0, 5.0, -4.0, 3.0]]
    """
    size = -(-2 * len(t) // most)
    pieces = []
    for start, stop in _runs(np.isfinite(values)):
        kept = np.arange(start, stop)
        if len(t) > most:
            kept = np.unique([k + f(values[k : min(k + size, stop)])
                              for k in range(start, stop, size)
                              for f in (np.argmin, np.argmax)])  # fmt: skip
        pieces.append(np.column_stack((t[kept], values[kept])))
    return pieces


def _runs(mask: Mask) -> list[tuple[int, int]]:
    """First and one past last of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(int)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
