"""Measured, predicted and residual laid over one another in an MCAP file for plot tools."""

from collections.abc import Iterator, Mapping, Sequence
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from trialid.report import labels
from trialid.report.series import TrialSeries
from trialid.report.tracks import About, Track, stems, write_tracks
from trialid.trial import Vector

_ROLES = {
    "measured": attrgetter("observed"),
    "predicted": attrgetter("predicted"),
    "residual": attrgetter("residual"),
}


def write_mcap(path: str | Path, result: Mapping[str, Any], series: Sequence[TrialSeries]) -> None:
    """The series as protobuf messages, the run's manifest as metadata, its result attached.

    Log time is trial time from zero, so that the trials of a run lie over one another. A sample
    inside a gap is NaN.
    """
    topics = stems(trial.name for trial in series)
    tracks = [track for each in zip(series, topics, strict=True) for track in tracks_of(*each)]
    library = f"trialid {result.get('version') or ''}".strip()
    about = About(library, _manifest(result), "result.json", result)
    with Path(path).open("wb") as stream:
        write_tracks(stream, tracks, about)


def tracks_of(trial: TrialSeries, stem: str) -> Iterator[Track]:
    """Inputs, measured, predicted and residual of a trial, a topic each."""
    t = np.rint(trial.t * 1e9).astype(np.int64)
    if len(t) and t.min() < 0:
        # MCAP times are unsigned, and its writer loses the whole file over one negative time.
        raise ValueError(f"trial {trial.name!r} has samples before its time zero")
    topic = f"/trialid/{stem}/"
    yield Track(topic + "inputs", "trialid.Inputs", t, _inputs(trial))
    for role, take in _ROLES.items():
        fields = {labels.message_field(output.name): take(output) for output in trial.outputs}
        yield Track(topic + role, "trialid.Outputs", t, fields)


def _inputs(trial: TrialSeries) -> dict[str, Vector]:
    return {labels.message_field(name): values for name, values in trial.inputs.items()}


def _manifest(result: Mapping[str, Any]) -> dict[str, str]:
    """What the file was made from, as the text-to-text table MCAP has for it."""
    keys = ("schema", "version", "pipeline")
    manifest = {key: str(result[key]) for key in keys if result.get(key) is not None}
    for trial in result.get("trials") or ():
        for log in trial.get("logs") or ():
            manifest[f"sha256 {log['path']}"] = str(log.get("sha256") or "")
    return manifest
