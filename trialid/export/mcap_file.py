"""Aligned trials as an MCAP file: one topic a trial."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from trialid.alignment.clocks import CALENDAR_NS
from trialid.export.csv_file import masked_signals, units
from trialid.export.tracks import About, Track, stems, write_tracks
from trialid.names import labels
from trialid.trial import Trial


def write_mcap(path: Path, trials: Sequence[Trial], provenance: Mapping[str, Any]) -> None:
    """Protobuf messages with their descriptor, NaN where nothing was measured.

    Stamps are those of the logs where all of them are dated, so that the file lies over the logs in
    a plot; else each trial begins at zero.
    """
    dated = all(trial.start > CALENDAR_NS for trial in trials)
    starts = [trial.start if dated else 0 for trial in trials]
    topics = stems(trial.name for trial in trials)
    known = units(provenance)
    tracks = [_track(*each, known) for each in zip(trials, topics, starts, strict=True)]
    manifest = {key: str(provenance[key]) for key in ("schema", "version", "pipeline")}
    for trial in trials:
        manifest |= {f"sha256 {log.path}": log.sha256 for log in trial.logs}
    about = About(f"trialid {provenance['version']}", manifest, "provenance.json", provenance)
    with path.open("wb") as stream:
        write_tracks(stream, tracks, about)


def _track(trial: Trial, stem: str, start: int, known: Mapping[str, str]) -> Track:
    t = start + np.rint(trial.t * 1e9).astype(np.int64)
    measured = masked_signals(trial).items()
    fields = {labels.message_field(name, known.get(name)): values for name, values in measured}
    return Track(f"/trialid/{stem}/aligned", "trialid.Aligned", t, fields)
