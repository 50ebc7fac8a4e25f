"""One model worked out, and shown as far as it is known after each step of the way."""

import ctypes
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from operator import is_
from typing import Protocol

import numpy as np

from trialid.diagnosis.search.bias import Foreseen
from trialid.errors import TrialidError
from trialid.identification.fit import Fit
from trialid.names.quantities import SIGNALS
from trialid.pipeline_file import Pipeline
from trialid.result.change_rows import StepRow
from trialid.result.schema import Result
from trialid.result.series import OutputSeries, TrialSeries
from trialid.ship.model import ShipModel
from trialid.threads import one_thread
from trialid.trial import Trial
from trialid.workbench.document import Step
from trialid.workbench.shelf import Shelf
from trialid.workbench.shown import Shown
from trialid.workbench.steps import step_names
from trialid.workbench.watch import Files
from trialid.workflow import history
from trialid.workflow.build_model import available, build_model
from trialid.workflow.edit_model import fit_edit, foresee_edit, proposed_steps, set_beside
from trialid.workflow.edit_pipeline import Edit
from trialid.workflow.fit_model import fit_of, time_series
from trialid.workflow.outcome import Outcome
from trialid.workflow.quantities_read import quantities_of
from trialid.workflow.run import examine

UNKNOWN = "the model before was not fitted"


@dataclass(frozen=True)
class Task:
    """A model to work out.

    Attributes
    ----------
    pipeline
        The pipeline as its file has it.
    why
        What began it, in words.
    edit
        The effect added or dropped; None for every other reason.
    before
        The model before, as far as it is known; None on opening.
    kept
        What was found for this very model earlier.
    recorded
        Whether it is a step of the history: an edit of a person here.
    """

    pipeline: Pipeline
    why: str
    edit: Edit | None = None
    before: Shown | None = None
    kept: Outcome | None = None
    recorded: bool = False


class Seat(Protocol):
    """Where the work is shown. Each call raises when nobody wants the work any more."""

    def progress(self, words: str, share: float | None) -> None:
        """Say what is being done."""

    def show(self, shown: Shown) -> None:
        """Show what is known by now."""

    def amend(self, edit: Edit) -> None:
        """Write better starts of an added effect into the pipeline."""

    def record(self, steps: tuple[StepRow, ...]) -> None:
        """Write steps of the history."""


class LetGo(Exception):
    """The computation is not wanted any more."""


@dataclass
class Job:
    """A computation under way, the edit that began it, and whether it is still wanted.

    `files` are those it rests on, as they were when it began.
    """

    task: Task
    step: Step | None
    files: Files
    wanted: bool = True


@one_thread
def work_out(task: Task, shelf: Shelf, seat: Seat) -> None:
    """Read, fit and examine; every stage is shown when it is reached.

    Raises
    ------
    TrialidError
        The model or the record does not allow it.
    """
    catalogue = available(task.pipeline)
    model = build_model(task.pipeline, catalogue)
    named = {} if task.before is None else task.before.named
    shown = Shown(task.pipeline, catalogue, model, before=_last(task), named=named)
    if task.before is None:
        seat.show(shown)

    def so_far(read: tuple[Trial, ...]) -> None:
        """The first long trial can be looked at while the others are read."""
        if task.before is None:
            seat.show(replace(shown, trials=read, series=_measured(task.pipeline, read)))

    trials = shelf.trials(task.pipeline, seat.progress, so_far)
    shown = replace(shown, trials=trials, series=_so_far(task, trials))
    if task.kept is not None:
        _restored(task, task.kept, model, shown, seat)
        return
    seat.show(shown)
    edit, foreseen, fit = _fit(task, trials, seat)
    pipeline = task.pipeline if edit is None else edit.after
    shown = replace(shown, pipeline=pipeline, model=fit.model, fit=fit, series=time_series(fit))
    seat.show(shown)
    grown = bool(_came(task)) if edit is None else edit.grows
    run = examine(pipeline, trials, seat.progress, fit, grown=grown)
    outcome = _concluded(replace(task, edit=edit), run.outcome, foreseen, seat)
    seat.show(replace(shown, run=outcome, named=_named(shown, outcome)))


def _fit(
    task: Task, trials: tuple[Trial, ...], seat: Seat
) -> tuple[Edit | None, Foreseen | str, Fit]:
    """The fit, as the command line makes it: by the pipeline, or from the foreseen values."""
    if task.edit is None:
        catalogue = available(task.pipeline)
        return None, UNKNOWN, fit_of(task.pipeline, trials, catalogue, seat.progress)
    foreseen = _foreseen(task.edit, task.before, trials, seat)
    edit, fit = fit_edit(task.edit, trials, foreseen, seat.progress)
    if edit is not task.edit:
        seat.amend(edit)
    return edit, foreseen, fit


def _foreseen(
    edit: Edit, before: Shown | None, trials: tuple[Trial, ...], seat: Seat
) -> Foreseen | str:
    """What linearisation foresees; the model before is fitted again where its fit was not kept."""
    if before is None or before.run is None:
        return UNKNOWN
    try:
        fit = before.fit or fit_of(edit.before, trials, available(edit.before), seat.progress)
    except TrialidError as error:
        return f"the model before cannot be fitted: {error}"
    return foresee_edit(edit, fit)


def _concluded(task: Task, outcome: Outcome, foreseen: Foreseen | str, seat: Seat) -> Outcome:
    """The outcome with the model before beside it; the step is in the history."""
    before = _result(task.before)
    if task.edit is not None and before is not None:
        result, steps = set_beside(task.edit, outcome.result, before, foreseen)
        outcome = replace(outcome, result=result)
    else:
        so_far, _ = history.read(task.pipeline.path)
        every = history.continue_steps(*_began_with(task, so_far, outcome.result.present))
        steps = every[len(so_far) :]
        every = (*every, *proposed_steps(outcome.result))
        outcome = replace(outcome, result=replace(outcome.result, history=every, change=None))
    if task.recorded:
        seat.record(steps)
    return outcome


def _began_with(
    task: Task, steps: tuple[StepRow, ...], present: StepRow
) -> tuple[tuple[StepRow, ...], StepRow]:
    """The history with the last model that was worked out, and the present one as it came of that.

    The present one may have come otherwise when it was worked out. Where effects came one upon the
    other, none in between was worked out.
    """
    present = replace(present, step="as written", added=None, dropped=None)
    last = _last(task)
    if last is None or not task.recorded:
        return steps, present
    steps = history.continue_steps(steps, last.result.present)
    if came := _came(task):
        present = replace(present, step="added", added=", ".join(came))
    return steps, present


def _came(task: Task) -> list[str]:
    """Effects that joined the last model that was worked out, where none of its own went."""
    last = _last(task)
    if last is None or not task.recorded:
        return []
    had, has = last.pipeline.model.effects, task.pipeline.model.effects
    return [] if {*had} - {*has} else [n for n in has if n not in had]


def _last(task: Task) -> Outcome | None:
    """The last model that was worked out."""
    return None if task.before is None else task.before.run or task.before.before


def _named(shown: Shown, outcome: Outcome) -> Mapping[int, str]:
    """The names of the steps made here, with that of the present one where it is a step more."""
    before, present = shown.before, outcome.result.present
    if before is None or history.same(before.result.present, present):
        return shown.named
    place = sum(row.step != "proposed" for row in outcome.result.history) - 1
    return {
        **shown.named,
        place: step_names.change_words(before.pipeline, outcome.pipeline, shown.catalogue),
    }


def _result(before: Shown | None) -> Result | None:
    return None if before is None or before.run is None else before.run.result


def _restored(task: Task, kept: Outcome, model: ShipModel, shown: Shown, seat: Seat) -> None:
    """A model that was worked out earlier, shown again without a fit."""
    values = {row.name: row.value for row in kept.result.accuracy.parameters}
    fitted = model.with_values(
        {n: x for n, x in values.items() if x is not None and n in model.parameters}
    )
    outcome = _concluded(task, kept, "it was fitted before", seat)
    seat.show(
        replace(shown, model=fitted, series=kept.series, run=outcome, named=_named(shown, outcome))
    )


def _so_far(task: Task, trials: tuple[Trial, ...]) -> tuple[TrialSeries, ...]:
    """The series until there is a fit, predicted by the model before where the trials are those."""
    before = task.before
    if before is not None and _alike(before.trials, trials):
        return before.series
    return _measured(task.pipeline, trials)


def _alike(one: tuple[Trial, ...], other: tuple[Trial, ...]) -> bool:
    return len(one) == len(other) and all(map(is_, one, other))


def _measured(pipeline: Pipeline, trials: tuple[Trial, ...]) -> tuple[TrialSeries, ...]:
    """The series before there is a prediction."""
    outputs = pipeline.identify.outputs
    units = {name: q.unit for name, q in quantities_of(pipeline).items() if name not in SIGNALS}
    return tuple(
        TrialSeries(
            name=trial.name,
            use=trial.use,
            t=trial.t,
            inputs={n: x for n, x in trial.signals.items() if n not in outputs},
            outputs=tuple(
                OutputSeries(c, trial.signals[c], np.full(trial.samples, np.nan), trial.valid[c])
                for c in outputs
                if c in trial.signals
            ),
            units=units,
        )
        for trial in trials
    )


def give_back_memory() -> None:
    """Give the system back what nothing holds any more.

    The C library of Linux keeps it for later: of five trials of 100 000 samples 380 MB of 810, on
    top of which the next model would be worked out. Other systems give it back by themselves.
    """
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if os.name == "posix" else None
    if trim is not None:
        trim(0)
