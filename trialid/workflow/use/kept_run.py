"""The fit of a pipeline as the folder of its run keeps it: nothing is read or searched again."""

from dataclasses import dataclass
from pathlib import Path

from trialid.errors import TrialidError
from trialid.identification.fit import Fit
from trialid.pipeline_file import Pipeline
from trialid.result.schema import Result
from trialid.trial import Trial
from trialid.workflow.build_model import available
from trialid.workflow.repeat import earlier
from trialid.workflow.use.finished_model import revived_fit
from trialid.workflow.use.kept_standing import standing_of


@dataclass(frozen=True)
class KeptRun:
    """A run's trials as the pipeline orders them, the fit to them, its search over, and result."""

    trials: tuple[Trial, ...]
    fit: Fit
    result: Result


def kept_run(folder: Path, asked: Pipeline) -> KeptRun | None:
    """The run of a pipeline.

    None where the folder keeps no run of this very pipeline by this very version, or a log, the
    ship or an effect is another since.
    """
    try:
        run = earlier(folder)
        if (run.pipeline.path, run.pipeline.content) != (asked.path.resolve(), asked.content):
            return None
        kept = standing_of(folder, available(asked))
        if kept is None:
            return None
        named = {trial.name: trial for trial in kept.trials}
        trials = tuple(named[section.name] for section in asked.trials)
        return KeptRun(trials, revived_fit(asked, trials, run.result, str(folder)), run.result)
    except (TrialidError, KeyError):
        return None
