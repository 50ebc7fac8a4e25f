"""One effect added to a pipeline or dropped from it: the file edited, the model before and after.

Nothing is written before all is computed; then the run's folder, the pipeline file at one stroke,
and one line more in the history.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from trialid import user_files
from trialid.diagnosis.search.bias import Foreseen, foresee_adding, foresee_dropping
from trialid.errors import PipelineError, TrialidError
from trialid.identification.fit import Fit
from trialid.pipeline_file import Pipeline, read
from trialid.pipeline_file.edit import start_at
from trialid.pipeline_file.rewrite import rewriting
from trialid.progress import Progress
from trialid.result import json_file
from trialid.result.change_rows import StepRow
from trialid.result.schema import Result
from trialid.threads import one_thread
from trialid.trial import Trial
from trialid.version import VERSION
from trialid.workflow import history
from trialid.workflow.build_model import available
from trialid.workflow.compare import compare_models
from trialid.workflow.edit_pipeline import Edit
from trialid.workflow.fit_model import fit_of
from trialid.workflow.origin import sources_of
from trialid.workflow.outcome import Run
from trialid.workflow.read_trials import align_trials
from trialid.workflow.run import examine
from trialid.workflow.use.kept_run import KeptRun, kept_run
from trialid.workflow.write_run import write

AS_FORESEEN: Final = 1.01
"""An error above this many times the foreseen one is worth a second search."""

BETTER: Final = 0.999
"""An error must fall below this share for a start of one's own to be worth a line."""

AS_BEFORE: Final = 1e-9
"""Relative difference up to which an earlier run and the fit at hand are the same."""


@dataclass(frozen=True)
class Changed:
    """A changed model, examined; `steps` are what the history file lacks."""

    edit: Edit
    run: Run
    steps: tuple[StepRow, ...]


@one_thread
def carry_out(edit: Edit, folder: Path, progress: Progress) -> Changed:
    """Both models fitted and examined; nothing is written.

    What is known of the model before is taken from the run in `folder` where that is of the same
    pipeline, logs and version; with trials and fit, where it keeps them.

    Raises
    ------
    TrialidError
        The new model or the record does not allow it.
    """
    kept = kept_run(folder, edit.before)
    trials = align_trials(edit.before, progress) if kept is None else kept.trials
    known = _before(edit, trials, folder, progress, kept)
    before, foreseen = (None, known) if isinstance(known, str) else known
    edit, fit = fit_edit(edit, trials, foreseen, progress)
    run = examine(edit.after, trials, progress, fit, grown=edit.grows)
    result, steps = set_beside(edit, run.result, before, foreseen)
    return Changed(edit, replace(run, result=result), steps)


def set_beside(
    edit: Edit, after: Result, before: Result | None, foreseen: Foreseen | str
) -> tuple[Result, tuple[StepRow, ...]]:
    """The result of a changed model with the one before beside it, and the steps history lacks."""
    steps, _ = history.read(edit.before.path)
    name = edit.effect.name
    row = replace(
        after.present,
        step=edit.step,
        added=name if edit.step == "added" else None,
        dropped=name if edit.step == "dropped" else None,
    )
    base = steps if before is None else history.continue_steps(steps, before.present)
    result = replace(
        after,
        history=(*base, row, *proposed_steps(after)),
        change=compare_models(edit.step, edit.effect, before, after, foreseen, edit.taken_out),
    )
    return result, (*base, row)[len(steps) :]


def fit_edit(
    edit: Edit, trials: tuple[Trial, ...], foreseen: Foreseen | str, progress: Progress
) -> tuple[Edit, Fit]:
    """The fit of the new model, and the edit with better starts where it needs them.

    A new parameter starts at its typical value, which may be far off for this ship. If the search
    from there fails, ends nowhere, loses a held-out trial or ends above what linearisation foresaw,
    it begins again at the foreseen values; if that is better, they are written into the file, which
    is then worth as much as this fit.

    Raises
    ------
    TrialidError
        The new model cannot be fitted from either.
    """
    catalogue = available(edit.after)
    near = None if isinstance(foreseen, str) else started_at(edit, foreseen.values)
    try:
        fit = fit_of(edit.after, trials, catalogue, progress)
    except TrialidError:
        if near is None:
            raise
        return near, fit_of(near.after, trials, catalogue, progress)
    if near is None or isinstance(foreseen, str):
        return edit, fit
    if _sound(fit) and fit.eps_rmsn <= AS_FORESEEN * foreseen.eps_rmsn:
        return edit, fit
    with suppress(TrialidError):
        again = fit_of(near.after, trials, catalogue, progress)
        if _sound(again) and (not _sound(fit) or again.eps_rmsn < BETTER * fit.eps_rmsn):
            return near, again
    return edit, fit


def _sound(fit: Fit) -> bool:
    """Whether a search arrived, and at a model that stays with the held-out trials.

    In the wilds of parameter space an unstable ship may fit the trials she was fitted to.
    """
    return fit.converged and fit.eps_check != np.inf


def started_at(edit: Edit, values: Mapping[str, float]) -> Edit | None:
    """The edit with these values of the new effect as starts; None where some are stated."""
    if edit.step != "added":
        return None
    text = edit.after.text
    for name, p in edit.effect.parameters.items():
        if name in edit.after.model.values:
            return None
        value = float(np.clip(values[name], p.low, p.high))
        try:
            text = start_at(text, name, float(f"{value:.3g}"))
        except PipelineError:  # this file has no room for it; the typical start has to do
            return None
    return replace(edit, after=read(text.encode("utf-8"), edit.after.path))


def all_started_at(pipeline: Pipeline, values: Mapping[str, float]) -> Pipeline:
    """The pipeline with these values as starts of all that is free and has none stated."""
    text = pipeline.text
    for name in pipeline.identify.free:
        if name in pipeline.model.values or name not in values:
            continue
        with suppress(PipelineError):  # no room for it: the start that it has must do
            text = start_at(text, name, float(f"{values[name]:.4g}"))
    return read(text.encode("utf-8"), pipeline.path)


def _before(
    edit: Edit,
    trials: tuple[Trial, ...],
    folder: Path,
    progress: Progress,
    kept: KeptRun | None,
) -> tuple[Result, Foreseen | str] | str:
    """The present model's result and what linearisation foresees; words where it cannot be fitted.

    A model that cannot be fitted is a good reason to change it.
    """
    try:
        if kept is not None:
            return kept.result, foresee_edit(edit, kept.fit)
        fit = fit_of(edit.before, trials, available(edit.before), progress)
        foreseen = foresee_edit(edit, fit)
        found = earlier(folder, edit.before, fit)
        found = found or examine(edit.before, trials, progress, fit).result
    except TrialidError as error:
        return f"the model before cannot be fitted: {error}"
    return found, foreseen


def foresee_edit(edit: Edit, fit: Fit) -> Foreseen | str:
    """What linearisation about the model before foresees; words where it cannot."""
    if edit.step == "dropped":
        return foresee_dropping(fit, edit.effect)
    held = [n for n in edit.effect.parameters if n not in edit.after.identify.free]
    return f"{held[0]} is not free" if held else foresee_adding(fit, edit.effect)


def proposed_steps(result: Result) -> tuple[StepRow, ...]:
    """Steps that were only tried."""
    return tuple(row for row in result.history if row.step == "proposed")


def earlier(folder: Path, pipeline: Pipeline, fit: Fit) -> Result | None:
    """The result in a run's folder, if it is of this pipeline, these logs and this version."""
    try:
        if user_files.content(folder / "pipeline.toml") != pipeline.content:
            return None
        found = json_file.read(folder / "result.json")
    except (OSError, TrialidError):
        return None  # nobody's folder, or an older one: it is computed anew
    return found if _holds(found, pipeline, fit) else None


def _holds(found: Result, pipeline: Pipeline, fit: Fit) -> bool:
    logs = [log.sha256 for trial in found.trials for log in trial.logs]
    values = {row.name: row.value for row in found.accuracy.parameters}
    numbers = [x for x in (found.fit.eps_rmsn, *values.values()) if x is not None]
    return (
        found.version == VERSION
        and logs == [g.sha256 for s in fit.scores for g in s.trial.logs]
        and found.sources == sources_of(pipeline)
        and values.keys() == fit.estimates.keys()
        and len(numbers) == len(values) + 1
        and np.allclose(numbers, [fit.eps_rmsn, *fit.estimates.values()], rtol=AS_BEFORE, atol=0.0)
    )


def commit(
    before: Pipeline, after: Pipeline, run: Run, steps: Sequence[StepRow], folder: Path
) -> None:
    """Write the run's folder, the steps of the history and, at one stroke, the pipeline file.

    Whatever fails, the pipeline file is the old one.

    Raises
    ------
    PipelineError, OSError
        A place cannot be written, or the file was changed meanwhile.
    """
    with rewriting(before.path, before.content, after.content) as stroke:
        write(run, folder)
        with history.append_steps(before.path, steps):
            stroke()
