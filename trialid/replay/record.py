"""A replay as an MCAP file for plot tools, with a layout for each beside it."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from trialid import temporary
from trialid.export.lines import INFO, WARNING, Line
from trialid.export.tracks import About, Track, stems, write_tracks
from trialid.names import labels
from trialid.replay.closing_words import band_words
from trialid.replay.playback import Playback
from trialid.report.files.overlay import BAND, tracks_of
from trialid.result.series import OutputSeries, TrialSeries

if TYPE_CHECKING:
    import jinja2

LAYOUTS = {".foxglove.json": "foxglove.json.j2", ".plotjuggler.xml": "plotjuggler.xml.j2"}
"""What is put in place of a recording's suffix, and the layout that goes there."""


@dataclass(frozen=True)
class Curve:
    """Topic and field of one curve."""

    topic: str
    field: str


@dataclass(frozen=True)
class Panel:
    """One output's curves, each by what it is of it; `unit` is SI."""

    title: str
    unit: str
    signals: tuple[tuple[str, Curve], ...]
    residual: tuple[tuple[str, Curve], ...]
    score: Curve


def series(playback: Playback, start: int = 0) -> TrialSeries:
    """What was played from sample `start` on, measured and predicted."""
    trial, fit = playback.trial, playback.fit
    played = slice(start, playback.furthest)
    names = fit.problem.simulator.equations.inputs
    return TrialSeries(
        name=trial.name,
        use=trial.use,
        t=trial.t[played].copy(),
        inputs={n: trial.signals[n][played] for n in names if n in trial.signals},
        outputs=tuple(
            OutputSeries(
                c,
                playback.measured[played, i].copy(),
                playback.stream.y[played, i].copy(),
                playback.compared[played, i].copy(),
            )
            for i, c in enumerate(fit.problem.outputs)
        ),
        units=fit.model.own_units,
    )


def layout_paths(path: Path) -> list[Path]:
    """Where the layouts of a recording go."""
    return [path.with_suffix(suffix) for suffix in LAYOUTS]


def write(path: Path, playback: Playback, version: str, start: float = 0.0) -> list[Path]:
    """The recording of what was played from a time [s] on, and its layouts; the files.

    Log time is trial time, as in a run's `predicted.mcap`: both lie over one another.
    """
    first = round(start / playback.trial.period)
    topic = f"/trialid/{_stem(playback)}/"
    made = series(playback, first)
    shown = tracks_of(made, _stem(playback), playback.prediction_band)
    tracks = [*shown, *_watched(playback, topic, first)]
    lines = {topic + "events": list(_lines(playback, start))}
    about = About(f"trialid {version}", _manifest(playback, version), "replay.json",
                  {"band": playback.bands.source,
                   "sigma": {b.output: b.sigma for b in playback.bands.of},
                   "prediction_band": dict(playback.prediction_band)})  # fmt: skip
    with temporary.replace_whole(path) as ready, ready.open("wb") as stream:
        write_tracks(stream, tracks, about, lines)
    layouts = layout_paths(path)
    for place, template in zip(layouts, LAYOUTS.values(), strict=True):
        text = (
            _environment()
            .get_template(template)
            .render(panels=panels(playback), events=topic + "events")
        )
        with temporary.replace_whole(place) as ready:
            ready.write_text(text, encoding="utf-8")
    return [path, *layouts]


def panels(playback: Playback) -> list[Panel]:
    """What the layouts show."""
    topic, made = f"/trialid/{_stem(playback)}/", []
    for band in playback.bands.of:
        field = labels.message_field(band.output)
        edges, about = (
            [(w, Curve(topic + which, f"{field}_{w}")) for w in ("upper", "lower")]
            for which in ("band", BAND)
        )
        signals = tuple((w, Curve(topic + w, field)) for w in ("measured", "predicted"))
        made.append(
            Panel(
                labels.label(band.output),
                labels.quantity(band.output).unit,
                (*signals, *(about if band.output in playback.prediction_band else ())),
                (("residual", Curve(topic + "residual", field)), *edges),
                Curve(topic + "alarm", f"{field}_score"),
            )
        )
    return made


def _stem(playback: Playback) -> str:
    return stems([playback.trial.name])[0]


def _watched(playback: Playback, topic: str, first: int) -> Iterator[Track]:
    """Two deviations of noise either way, and how near each output is to an alarm: 1 is one."""
    t = np.rint(playback.trial.t[first : playback.furthest] * 1e9).astype(np.int64)
    edges, scores = {}, {}
    for c, band in enumerate(playback.bands.of):
        field = labels.message_field(band.output)
        edges[f"{field}_upper"] = np.full(len(t), 2.0 * band.sigma)
        edges[f"{field}_lower"] = -edges[f"{field}_upper"]
        scores[f"{field}_score"] = playback.monitor.score[first : playback.furthest, c]
    yield Track(topic + "band", "trialid.Band", t, edges)
    yield Track(topic + "alarm", "trialid.Alarm", t, scores)


def _lines(playback: Playback, start: float) -> Iterator[Line]:
    yield Line(_ns(start), INFO, f"from here on; band: {playback.bands.source}")
    if said := band_words(playback.prediction_band):
        yield Line(_ns(start), INFO, said)
    for event in playback.events(start):
        level = WARNING if event.warning else INFO
        yield Line(_ns(max(event.t, start)), level, event.words)


def _ns(t: float) -> int:
    return round(t * 1e9)


def _manifest(playback: Playback, version: str) -> dict[str, str]:
    logs = {f"sha256 {log.path}": log.sha256 for log in playback.trial.logs}
    return {"version": version, "trial": playback.trial.name, **logs}


@cache
def _environment() -> "jinja2.Environment":
    from trialid.report import templates

    return templates.environment("trialid", "replay/layouts")
