"""One effect added to a pipeline or dropped from it: the file edited, the model before and after.

Nothing is written before all is computed; then the run's folder, the pipeline file at one stroke,
and one line more in the history.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

import trialid
from trialid import history
from trialid.comparison import compared
from trialid.diagnosis.bias import Foreseen, foresee_adding, foresee_dropping
from trialid.errors import RecipeError, TrialidError, nearest
from trialid.history import Step
from trialid.identification.fit import Fit
from trialid.pipeline import (
    Progress,
    Run,
    align_trials,
    available,
    examine,
    fit_of,
    sources_of,
    write,
)
from trialid.recipe import Recipe, read, where
from trialid.recipe.edit import add_effect, drop_effect
from trialid.recipe.rewrite import rewriting
from trialid.result import SCHEMA, Plain
from trialid.ship.effect import Effect
from trialid.threads import one_thread
from trialid.trial import Trial

AS_BEFORE: Final = 1e-9
"""Relative difference up to which an earlier run and the fit at hand are the same."""


@dataclass(frozen=True)
class Edit:
    """A pipeline before and after an effect was added or dropped, not yet written.

    `step` is `added` or `dropped`; `taken_out` says in words what the user had written for the
    effect's parameters.
    """

    step: str
    effect: Effect
    before: Recipe
    after: Recipe
    taken_out: tuple[str, ...] = ()


@dataclass(frozen=True)
class Changed:
    """A changed model, examined; `steps` are what the history file lacks."""

    edit: Edit
    run: Run
    steps: tuple[Step, ...]


def adding(recipe: Recipe, name: str) -> Edit:
    """The pipeline with an effect more, its parameters free.

    An effect that the model had before gets back those parameters that were free then.

    Raises
    ------
    RecipeError
        It is there already, there is no such effect, or the file would not be a pipeline.
    """
    if name in recipe.model.effects:
        raise RecipeError(f"{where(recipe, 'model.effects')}: {name!r} is there already")
    catalogue = available(recipe)
    if name not in catalogue:
        hint = nearest(name, catalogue)
        hint = hint if hint.startswith("did") else "`trialid effects` lists what there is"
        raise RecipeError(f"{where(recipe, 'model.effects')}: there is no effect {name!r}; {hint}")
    effect = catalogue[name]
    steps, _ = history.read(recipe.path)
    free = history.free_before(steps, name, tuple(effect.parameters))
    new = [n for n in free if n not in recipe.identify.free]
    after, _ = _edited(recipe, lambda text: (add_effect(text, name, new), ()))
    return Edit("added", effect, recipe, after)


def dropping(recipe: Recipe, name: str) -> Edit:
    """The pipeline with an effect less, and without what it says of the effect's parameters.

    Raises
    ------
    RecipeError
        It is not there, or the file would not be a pipeline.
    """
    if name not in recipe.model.effects:
        raise RecipeError(
            f"{where(recipe, 'model.effects')}: {name!r} is not there; "
            f"{nearest(name, recipe.model.effects)}"
        )
    catalogue = available(recipe)
    if name not in catalogue:
        raise RecipeError(
            f"{where(recipe, 'model.effects')}: there is no effect {name!r}; "
            f"{nearest(name, catalogue)}"
        )
    own = tuple(catalogue[name].parameters)
    after, said = _edited(recipe, lambda text: drop_effect(text, name, own))
    return Edit("dropped", catalogue[name], recipe, after, said)


def _edited(
    recipe: Recipe, change: Callable[[str], tuple[str, tuple[str, ...]]]
) -> tuple[Recipe, tuple[str, ...]]:
    try:
        text, said = change(recipe.text)
    except RecipeError as error:
        raise RecipeError(f"{recipe.path}: {error}") from error
    return read(text.encode("utf-8"), recipe.path), said


@one_thread
def carry_out(edit: Edit, folder: Path, progress: Progress) -> Changed:
    """Both models fitted and examined; nothing is written.

    What is known of the model before is taken from the run in `folder` where that is of the same
    pipeline, logs and version.

    Raises
    ------
    TrialidError
        The new model or the record does not allow it.
    """
    trials = align_trials(edit.before, progress)
    known = _before(edit, trials, folder, progress)
    run = examine(edit.after, trials, progress)
    before, foreseen = (None, known) if isinstance(known, str) else known
    steps, _ = history.read(edit.before.path)
    own = {key: edit.effect.name if key == edit.step else None for key in ("added", "dropped")}
    row = present(run.result) | {"step": edit.step} | own
    base = steps if before is None else history.continued(steps, present(before))
    result = {
        **run.result,
        "history": [*base, row, *proposed(run.result)],
        "change": compared(edit.step, edit.effect, before, run.result, foreseen, edit.taken_out),
    }
    return Changed(edit, replace(run, result=result), (*base, row)[len(steps) :])


def _before(
    edit: Edit, trials: tuple[Trial, ...], folder: Path, progress: Progress
) -> tuple[Plain, Foreseen | str] | str:
    """The present model's result and what linearisation foresees; words where it cannot be fitted.

    A model that cannot be fitted is a good reason to change it.
    """
    try:
        fit = fit_of(edit.before, trials, available(edit.before), progress)
        foresee = foresee_adding if edit.step == "added" else foresee_dropping
        foreseen = foresee(fit, edit.effect)
        found = earlier(folder, edit.before, fit)
        found = found or dict(examine(edit.before, trials, progress, fit).result)
    except TrialidError as error:
        return f"the model before cannot be fitted: {error}"
    return found, foreseen


def present(result: Mapping[str, Any]) -> Plain:
    """The step of the history that is the result's own model."""
    return dict([row for row in result["history"] if row["step"] != "proposed"][-1])


def proposed(result: Mapping[str, Any]) -> list[Plain]:
    """Steps that were only tried."""
    return [row for row in result["history"] if row["step"] == "proposed"]


def earlier(folder: Path, recipe: Recipe, fit: Fit) -> Plain | None:
    """The result in a run's folder, if it is of this pipeline, these logs and this version."""
    try:
        if (folder / "pipeline.toml").read_bytes() != recipe.content:
            return None
        found = json.loads((folder / "result.json").read_text(encoding="utf-8"))
        return found if _holds(found, recipe, fit) else None
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None  # nobody's folder, or an older one: it is computed anew


def _holds(found: Plain, recipe: Recipe, fit: Fit) -> bool:
    logs = [g["sha256"] for trial in found["trials"] for g in trial["logs"]]
    values = {row["name"]: row["value"] for row in found["accuracy"]["parameters"]}
    numbers = [found["fit"]["eps_rmsn"], *values.values()]
    return (
        (found["schema"], found["version"]) == (SCHEMA, trialid.__version__)
        and logs == [g.sha256 for s in fit.scores for g in s.trial.logs]
        and found["sources"] == sources_of(recipe)
        and values.keys() == fit.estimates.keys()
        and np.allclose(numbers, [fit.eps_rmsn, *fit.estimates.values()], rtol=AS_BEFORE, atol=0.0)
    )


def commit(before: Recipe, after: Recipe, run: Run, steps: Sequence[Step], folder: Path) -> None:
    """Write the run's folder, the steps of the history and, at one stroke, the pipeline file.

    Whatever fails, the pipeline file is the old one.

    Raises
    ------
    RecipeError, OSError
        A place cannot be written, or the file was changed meanwhile.
    """
    with rewriting(before.path, before.content, after.content) as stroke:
        write(run, folder)
        with history.appended(before.path, steps):
            stroke()
