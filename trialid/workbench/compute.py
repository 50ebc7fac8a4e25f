"""One model worked out, and shown as far as it is known after each step of the way."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from operator import is_
from typing import Any, Protocol

import numpy as np

from trialid import history
from trialid.assembly import available, build_model
from trialid.change import Edit, beside, fitted_after, foreseen_by, present, proposed
from trialid.diagnosis.bias import Foreseen
from trialid.errors import TrialidError
from trialid.history import Step
from trialid.identification.fit import Fit
from trialid.pipeline import Outcome, examine, fit_of, time_series
from trialid.recipe import Recipe
from trialid.report.series import OutputSeries, TrialSeries
from trialid.ship.model import ShipModel
from trialid.threads import one_thread
from trialid.trial import Trial
from trialid.workbench.shelf import Shelf
from trialid.workbench.shown import Shown

UNKNOWN = "the model before was not fitted"


@dataclass(frozen=True)
class Task:
    """A model to work out.

    Attributes
    ----------
    recipe
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

    recipe: Recipe
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

    def record(self, steps: tuple[Step, ...]) -> None:
        """Write steps of the history."""


@one_thread
def work_out(task: Task, shelf: Shelf, seat: Seat) -> None:
    """Read, fit and examine; every stage is shown when it is reached.

    Raises
    ------
    TrialidError
        The model or the record does not allow it.
    """
    outcome = None if task.before is None else task.before.run or task.before.before
    catalogue = available(task.recipe)
    model = build_model(task.recipe, catalogue)
    shown = Shown(task.recipe, catalogue, model, before=outcome)
    if task.before is None:
        seat.show(shown)
    trials = shelf.trials(task.recipe, seat.progress)
    shown = replace(shown, trials=trials, series=_so_far(task, trials))
    if task.kept is not None:
        _restored(task, task.kept, model, shown, seat)
        return
    seat.show(shown)
    edit, foreseen, fit = _fit(task, trials, seat)
    recipe = task.recipe if edit is None else edit.after
    shown = replace(shown, recipe=recipe, model=fit.model, fit=fit, series=time_series(fit))
    seat.show(shown)
    run = examine(recipe, trials, seat.progress, fit)
    outcome = _concluded(replace(task, edit=edit), run.outcome, foreseen, seat)
    seat.show(replace(shown, run=outcome))


def _fit(
    task: Task, trials: tuple[Trial, ...], seat: Seat
) -> tuple[Edit | None, Foreseen | str, Fit]:
    """The fit, as the command line makes it: by the pipeline, or from the foreseen values."""
    if task.edit is None:
        catalogue = available(task.recipe)
        return None, UNKNOWN, fit_of(task.recipe, trials, catalogue, seat.progress)
    foreseen = _foreseen(task.edit, task.before, trials, seat)
    edit, fit = fitted_after(task.edit, trials, foreseen, seat.progress)
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
    return foreseen_by(edit, fit)


def _concluded(task: Task, outcome: Outcome, foreseen: Foreseen | str, seat: Seat) -> Outcome:
    """The outcome with the model before beside it; the step is in the history."""
    before = _result(task.before)
    if task.edit is not None and before is not None:
        result, steps = beside(task.edit, outcome.result, before, foreseen)
        outcome = replace(outcome, result=result)
    else:
        so_far, _ = history.read(task.recipe.path)
        every = history.continued(so_far, present(outcome.result))
        steps = every[len(so_far) :]
        result = {**outcome.result, "history": [*every, *proposed(outcome.result)]}
        outcome = replace(outcome, result=result)
    if task.recorded:
        seat.record(steps)
    return outcome


def _result(before: Shown | None) -> Mapping[str, Any] | None:
    return None if before is None or before.run is None else before.run.result


def _restored(task: Task, kept: Outcome, model: ShipModel, shown: Shown, seat: Seat) -> None:
    """A model that was worked out earlier, shown again without a fit."""
    values = {row["name"]: row["value"] for row in kept.result["accuracy"]["parameters"]}
    fitted = model.with_values({n: x for n, x in values.items() if n in model.parameters})
    outcome = _concluded(task, kept, "it was fitted before", seat)
    seat.show(replace(shown, model=fitted, series=kept.series, run=outcome))


def _so_far(task: Task, trials: tuple[Trial, ...]) -> tuple[TrialSeries, ...]:
    """The series until there is a fit, predicted by the model before where the trials are those."""
    before = task.before
    if before is not None and _alike(before.trials, trials):
        return before.series
    return _measured(task.recipe, trials)


def _alike(one: tuple[Trial, ...], other: tuple[Trial, ...]) -> bool:
    return len(one) == len(other) and all(map(is_, one, other))


def _measured(recipe: Recipe, trials: tuple[Trial, ...]) -> tuple[TrialSeries, ...]:
    """The series before there is a prediction."""
    outputs = recipe.identify.outputs
    return tuple(
        TrialSeries(
            trial.name,
            trial.use,
            trial.t,
            {n: x for n, x in trial.signals.items() if n not in outputs},
            tuple(
                OutputSeries(c, trial.signals[c], np.full(trial.samples, np.nan), trial.valid[c])
                for c in outputs
                if c in trial.signals
            ),
        )
        for trial in trials
    )
