"""Where aligned trials come from, as plain data: enough to make them again."""

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any, Final

from trialid.alignment.clocks import CALENDAR_NS, moment
from trialid.names.quantities import Quantity
from trialid.pipeline_file import Pipeline, TrialSection
from trialid.trial import Trial
from trialid.version import VERSION

SCHEMA: Final = "trialid-aligned/1"


def provenance(
    pipeline: Pipeline, trials: Sequence[Trial], known: Mapping[str, Quantity]
) -> dict[str, Any]:
    """Logs with their hashes, channels, remarks and masked samples of every trial.

    `known` are the signals that are read, by name: a command of a thruster has its ship's unit.
    """
    written = {one.name: one for one in pipeline.trials}
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "pipeline": pipeline.path.name,
        "pipeline_sha256": hashlib.sha256(pipeline.content).hexdigest(),
        "trials": [_trial(trial, written[trial.name], known) for trial in trials],
    }


def _trial(trial: Trial, written: TrialSection, known: Mapping[str, Quantity]) -> dict[str, Any]:
    return {
        "name": trial.name,
        "use": trial.use,
        "period": trial.period,
        "samples": trial.samples,
        "start_ns": trial.start,
        "start": f"{moment(trial.start)}Z" if trial.start > CALENDAR_NS else None,
        "signals": {
            name: {"unit": known[name].unit, **_signal(trial, name, written)}
            for name in trial.signals
        },
        "logs": [{"path": o.path, "sha256": o.sha256, "adapter": o.adapter} for o in trial.logs],
        "remarks": [*trial.remarks],
    }


def _signal(trial: Trial, name: str, written: TrialSection) -> Mapping[str, Any]:
    """The samples that were not measured, and the pipeline's own words for it."""
    source = written.signals.get(name)
    stated = source.model_dump(by_alias=True, exclude_defaults=True) if source else None
    return {
        "masked": int((~trial.valid[name]).sum()),
        "source": stated,
    }
