"""Aligned trials, kept while their logs and what the pipeline says of them stay the same."""

from trialid import ingest
from trialid.ingest import LogFile
from trialid.pipeline import Progress, align_trial
from trialid.recipe import Recipe, TrialRecipe
from trialid.trial import Trial
from trialid.workbench.watch import seen


class Shelf:
    """One thread at a time."""

    def __init__(self) -> None:
        self._kept: dict[str, Trial] = {}

    def trials(self, recipe: Recipe, progress: Progress) -> tuple[Trial, ...]:
        """The pipeline's trials; those that are kept are not read again."""
        done = {}
        for i, trial in enumerate(recipe.trials):
            key = _key(recipe, trial)
            progress(f"reading {trial.name}", 0.3 * i / len(recipe.trials))
            done[key] = self._kept.get(key) or align_trial(recipe, trial)
        self._kept = done
        return tuple(done.values())


def _key(recipe: Recipe, trial: TrialRecipe) -> str:
    """All that the aligned signals rest on."""
    logs = [file for log in trial.logs for file in ingest.files_of(LogFile(log.path))]
    aids = [aid for log in trial.logs for aid in (log.template, log.dbc) if aid is not None]
    return repr((trial, recipe.align, [(file, seen(file)) for file in (*logs, *aids)]))
