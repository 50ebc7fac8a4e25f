"""Measured, predicted and residual laid over one another in an MCAP file for plot tools."""

from collections.abc import Iterator, Mapping, Sequence
from operator import attrgetter
from pathlib import Path

import numpy as np

from trialid.arrays import Vector
from trialid.export.tracks import About, Track, stems, write_tracks
from trialid.names import labels
from trialid.result.json_file import plain
from trialid.result.schema import Result
from trialid.result.series import TrialSeries

BAND = "predicted_band"
"""Topic of the band about the prediction."""

_ROLES = {
    "measured": attrgetter("observed"),
    "predicted": attrgetter("predicted"),
    "residual": attrgetter("residual"),
}


def write_mcap(path: str | Path, result: Result, series: Sequence[TrialSeries]) -> None:
    """The series as protobuf messages, the run's manifest as metadata, its result attached.

    Log time is trial time from zero, so that the trials of a run lie over one another. A sample
    inside a gap is NaN.
    """
    topics = stems(trial.name for trial in series)
    band = result.fit.band
    pairs = zip(series, topics, strict=True)
    tracks = [track for trial, stem in pairs for track in tracks_of(trial, stem, band)]
    library = f"trialid {result.version}".strip()
    about = About(library, _manifest(result), "result.json", plain(result))
    with Path(path).open("wb") as stream:
        write_tracks(stream, tracks, about)


def tracks_of(trial: TrialSeries, stem: str, band: Mapping[str, float]) -> Iterator[Track]:
    """Inputs, measured, predicted and residual of a trial, a topic each.

    Beside them, where it is known, the 95 % band about the prediction: `band` is half of it.
    """
    t = np.rint(trial.t * 1e9).astype(np.int64)
    if len(t) and t.min() < 0:
        # MCAP times are unsigned, and its writer loses the whole file over one negative time.
        raise ValueError(f"trial {trial.name!r} has samples before its time zero")
    topic = f"/trialid/{stem}/"
    yield Track(topic + "inputs", "trialid.Inputs", t, _inputs(trial))
    for role, take in _ROLES.items():
        fields = {labels.message_field(output.name): take(output) for output in trial.outputs}
        yield Track(topic + role, "trialid.Outputs", t, fields)
    if edges := dict(_edges(trial, band)):
        yield Track(f"{topic}{BAND}", "trialid.Band", t, edges)


def _edges(trial: TrialSeries, band: Mapping[str, float]) -> Iterator[tuple[str, Vector]]:
    """Upper and lower edge of the band about each prediction."""
    for output in (o for o in trial.outputs if o.name in band):
        field = labels.message_field(output.name)
        yield f"{field}_upper", output.predicted + band[output.name]
        yield f"{field}_lower", output.predicted - band[output.name]


def _inputs(trial: TrialSeries) -> dict[str, Vector]:
    return {
        labels.message_field(name, trial.quantity(name).unit): values
        for name, values in trial.inputs.items()
    }


def _manifest(result: Result) -> dict[str, str]:
    """What the file was made from, as the text-to-text table MCAP has for it."""
    manifest = {"schema": result.schema, "version": result.version, "pipeline": result.pipeline}
    for trial in result.trials:
        for log in trial.logs:
            manifest[f"sha256 {log.path}"] = log.sha256
    return {key: value for key, value in manifest.items() if value or key.startswith("sha256")}
