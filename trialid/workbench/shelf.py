"""Aligned trials, kept while their logs and what the pipeline says of them stay the same."""

from collections.abc import Callable

from trialid import ingest
from trialid.ingest import LogFile
from trialid.pipeline_file import Pipeline, TrialSection
from trialid.progress import Progress
from trialid.trial import Trial
from trialid.workbench.watch import file_state
from trialid.workflow.read_trials import align_trial, stretches_to_fit


class Shelf:
    """One thread at a time."""

    def __init__(self) -> None:
        self._kept: dict[str, Trial] = {}

    def trials(
        self,
        pipeline: Pipeline,
        progress: Progress,
        so_far: Callable[[tuple[Trial, ...]], None] = lambda read: None,
    ) -> tuple[Trial, ...]:
        """The pipeline's trials; those that are kept are not read again.

        `so_far` is told those that are there before another is read.
        """
        done: dict[str, Trial] = {}
        for i, trial in enumerate(pipeline.trials):
            key = _key(pipeline, trial)
            if done:
                so_far(tuple(done.values()))
            progress(f"reading {trial.name}", 0.3 * i / len(pipeline.trials))
            done[key] = self._kept.get(key) or align_trial(pipeline, trial)
        self._kept = done
        return stretches_to_fit(pipeline, tuple(done.values()))


def _key(pipeline: Pipeline, trial: TrialSection) -> str:
    """All that the aligned signals rest on."""
    logs = [file for log in trial.logs for file in ingest.files_of(LogFile(log.path))]
    aids = [aid for log in trial.logs for aid in (log.template, log.dbc) if aid is not None]
    return repr((trial, pipeline.align, [(file, file_state(file)) for file in (*logs, *aids)]))
