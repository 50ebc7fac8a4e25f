"""What a comparison of structures begins with, and the single fits that it takes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trialid.pipeline_file import Pipeline
from trialid.progress import Progress
from trialid.trial import Trial
from trialid.workflow.origin import sources_of
from trialid.workflow.read_trials import align_trials
from trialid.workflow.structures.asked_structures import Structure, asked_structures
from trialid.workflow.structures.leave_out import KeptFit, digest, fit_whole, fit_without, key_of

Out = tuple[str, ...]
"""Names of the trials that a fit leaves out, in the order of the pipeline."""


@dataclass(frozen=True, kw_only=True)
class FitTask:
    """One fit of a comparison, as it can be sent to whoever does it.

    Attributes
    ----------
    whole
        The fit of all trials, where it begins; None for that one itself.
    key
        A hash of all that goes into it.
    """

    structure: str
    left_out: Out
    whole: KeptFit | None
    key: str


class Comparison:
    """Structures and trials of a pipeline.

    Attributes
    ----------
    structures, trials
        The structures, and all trials, with outputs only where every structure has its inputs.
    not_tried
        Why others are left out, by name.
    fitted, names
        The trials that are fitted, and their names.
    """

    def __init__(self, pipeline: Pipeline, progress: Progress) -> None:
        trials = align_trials(pipeline, progress)
        self.structures, self.not_tried = asked_structures(pipeline, trials)
        self.trials = _on_common_samples(trials, self.structures)
        self.fitted = tuple(t for t in self.trials if t.use == "fit")
        self.names = tuple(t.name for t in self.fitted)
        self._sources = tuple(row.sha256 for row in sources_of(pipeline))
        self._digests: Mapping[str, str] = {t.name: digest(t) for t in self.trials}

    def task(self, structure: Structure, left_out: Out, whole: KeptFit | None) -> FitTask:
        """The fit of a structure without these trials; the pipeline's held-out ones have no say."""
        used = self._used(left_out)
        key = key_of(structure, [self._digests[t.name] for t in used], self._sources, left_out)
        return FitTask(structure=structure.name, left_out=left_out, whole=whole, key=key)

    def fit(self, task: FitTask) -> KeptFit:
        """Do it."""
        structure = next(s for s in self.structures if s.name == task.structure)
        used = self._used(task.left_out)
        if task.whole is None:
            return fit_whole(structure, used)
        return fit_without(structure, used, task.left_out, task.whole)

    def _used(self, left_out: Out) -> tuple[Trial, ...]:
        return self.fitted if left_out else self.trials


def _on_common_samples(
    trials: Sequence[Trial], structures: Sequence[Structure]
) -> tuple[Trial, ...]:
    """The trials with outputs only where every structure's inputs were measured."""
    wanted = {name for s in structures for name in s.model.recorded}
    outputs = structures[0].settings.outputs
    made = []
    for trial in trials:
        there = np.ones(trial.samples, dtype=bool)
        for valid in (trial.valid[n] for n in trial.valid if n in wanted):
            there &= valid
        shown = {c: trial.valid[c] & there for c in outputs if c in trial.valid}
        made.append(replace(trial, valid={**trial.valid, **shown}))
    return tuple(made)
