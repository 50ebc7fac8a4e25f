"""In which ways a voyage is done: trials left out, structures, seeds, bootstrap draws."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from trialid.errors import PipelineError
from trialid.fleet.pipeline_changes import Change, draw_trials, hold_out, put_model, put_seed
from trialid.pipeline_file import Pipeline
from trialid.pipeline_file.fleet_file import VarySection
from trialid.result.fleet_rows import RunLabel
from trialid.workflow.build_model import available
from trialid.workflow.structures.asked_structures import with_effects, written_structures

Way = tuple[RunLabel, list[Change]]


def variations(vary: VarySection, pipeline: Pipeline, label: RunLabel) -> Iterator[Way]:
    """Each way in which a pipeline is done: the label with what varies, and the changes for it.

    Raises
    ------
    PipelineError
        The pipeline has no structures to vary, or fewer than two trials to leave one out.
    """
    ways: list[Way] = [(label, [])]
    for kind in (_structures, _trials, _seeds, _draws):
        ways = [
            (further, [*changes, *more])
            for one, changes in ways
            for further, more in kind(vary, pipeline, one)
        ]
    yield from ways


def _structures(vary: VarySection, pipeline: Pipeline, label: RunLabel) -> Iterator[Way]:
    if vary.structure == "as written":
        yield label, []
        return
    catalogue = available(pipeline)
    lists = written_structures(pipeline, catalogue)
    if not lists:
        raise PipelineError("has no [structures] to vary; write them, or leave vary.structure out")
    for name, effects in lists.items():
        varied = with_effects(pipeline, effects, catalogue)
        yield replace(label, run=f"{label.run}-{name}", structure=name), [put_model(varied)]


def _trials(vary: VarySection, pipeline: Pipeline, label: RunLabel) -> Iterator[Way]:
    yield label, []
    if vary.trial == "as written":
        return
    names = _fitted(pipeline)
    if len(names) < 2:
        raise PipelineError("fits one trial; to leave one out it takes two or more")
    for name in names:
        yield replace(label, run=f"{label.run}-without-{name}", left_out=name), [hold_out(name)]


def _seeds(vary: VarySection, pipeline: Pipeline, label: RunLabel) -> Iterator[Way]:
    if not vary.seed:
        yield label, []
    for seed in vary.seed:
        yield replace(label, run=f"{label.run}-seed-{seed}", seed=seed), [put_seed(seed)]


def _draws(vary: VarySection, pipeline: Pipeline, label: RunLabel) -> Iterator[Way]:
    yield label, []
    names = [name for name in _fitted(pipeline) if name != label.left_out]
    for number in range(1, (vary.bootstrap or 0) + 1):
        draw = np.random.default_rng([vary.bootstrap_seed, number])
        drawn = [names[i] for i in sorted(draw.integers(len(names), size=len(names)))]
        yield replace(label, run=f"{label.run}-draw-{number}", draw=number), [draw_trials(drawn)]


def _fitted(pipeline: Pipeline) -> list[str]:
    return [trial.name for trial in pipeline.trials if trial.use == "fit"]
