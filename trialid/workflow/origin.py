"""What a run rests on: files by their hash, channels by trial."""

import hashlib
import os
from pathlib import Path

from trialid.pipeline_file import Pipeline
from trialid.result.schema import SignalRow, SourceRow


def sources_of(pipeline: Pipeline) -> tuple[SourceRow, ...]:
    """What the result rests on besides the logs: ship, the user's own effects, how to read logs."""
    logs = [log for trial in pipeline.trials for log in trial.logs]
    aids = dict.fromkeys(aid for log in logs for aid in (log.template, log.dbc))
    return tuple(
        SourceRow(
            path=relative_path(pipeline, path).as_posix(),
            sha256=hashlib.sha256(path.read_bytes()).hexdigest(),
        )
        for path in (pipeline.ship, *pipeline.model.effects_from, *aids)
        if path is not None
    )


def signals_of(pipeline: Pipeline) -> tuple[SignalRow, ...]:
    """Which channel each signal of each trial was read from."""
    return tuple(
        SignalRow(trial=trial.name, signal=quantity, channel=channel)
        for trial in pipeline.trials
        for quantity, source in trial.signals.items()
        for channel in source.names
    )


def relative_path(pipeline: Pipeline, path: Path) -> Path:
    """A log's path from the pipeline's folder, so that a result holds no place of one machine."""
    folder = pipeline.path.parent.resolve()
    return Path(os.path.relpath(path.resolve(), folder))
