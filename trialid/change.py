"""One effect added to a pipeline or dropped from it: the file edited, the model before and after.

Nothing is written before all is computed; then the run's folder, the pipeline file at one stroke,
and one line more in the history.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

import trialid
from trialid import history
from trialid.assembly import available
from trialid.comparison import compared
from trialid.diagnosis.bias import Foreseen, foresee_adding, foresee_dropping
from trialid.errors import RecipeError, TrialidError, nearest
from trialid.history import Step
from trialid.identification.fit import Fit
from trialid.pipeline import (
    Progress,
    Run,
    align_trials,
    examine,
    fit_of,
    sources_of,
    write,
)
from trialid.recipe import Recipe, read, where
from trialid.recipe.edit import add_effect, drop_effect, start_at
from trialid.recipe.rewrite import rewriting
from trialid.result import SCHEMA, Plain
from trialid.ship.effect import Effect
from trialid.threads import one_thread
from trialid.trial import Trial

AS_FORESEEN: Final = 1.01
"""An error above this many times the foreseen one is worth a second search."""

BETTER: Final = 0.999
"""An error must fall below this share for a start of one's own to be worth a line."""

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


def written(edit: Edit) -> str:
    """What is different in the file, in words: `effects + static_list, free + a_0`."""
    old, new = edit.before, edit.after
    sign = "+" if edit.step == "added" else "-"
    free = set(old.identify.free) ^ set(new.identify.free)
    words = [f"effects {sign} {edit.effect.name}"]
    words += [f"free {sign} {n}" for n in edit.effect.parameters if n in free]
    fresh = [n for n in new.model.values if n not in old.model.values]
    words += [f"values.{n} = {new.model.values[n].value:g} (start)" for n in fresh]
    return ", ".join(words)


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
    before, foreseen = (None, known) if isinstance(known, str) else known
    edit, fit = fitted_after(edit, trials, foreseen, progress)
    run = examine(edit.after, trials, progress, fit)
    result, steps = beside(edit, run.result, before, foreseen)
    return Changed(edit, replace(run, result=result), steps)


def beside(
    edit: Edit, after: Mapping[str, Any], before: Mapping[str, Any] | None, foreseen: Foreseen | str
) -> tuple[Plain, tuple[Step, ...]]:
    """The result of a changed model with the one before beside it, and the steps history lacks."""
    steps, _ = history.read(edit.before.path)
    own = {key: edit.effect.name if key == edit.step else None for key in ("added", "dropped")}
    row = present(after) | {"step": edit.step} | own
    base = steps if before is None else history.continued(steps, present(before))
    result = {
        **after,
        "history": [*base, row, *proposed(after)],
        "change": compared(edit.step, edit.effect, before, after, foreseen, edit.taken_out),
    }
    return result, (*base, row)[len(steps) :]


def fitted_after(
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
    near = _started(edit, foreseen)
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


def _started(edit: Edit, foreseen: Foreseen | str) -> Edit | None:
    """The edit with foreseen values as starts; None where none is foreseen or some are stated."""
    if edit.step != "added" or isinstance(foreseen, str):
        return None
    text = edit.after.text
    for name, p in edit.effect.parameters.items():
        if name in edit.after.model.values:
            return None
        value = float(np.clip(foreseen.values[name], p.low, p.high))
        try:
            text = start_at(text, name, float(f"{value:.3g}"))
        except RecipeError:  # this file has no room for it; the typical start has to do
            return None
    return replace(edit, after=read(text.encode("utf-8"), edit.after.path))


def _before(
    edit: Edit, trials: tuple[Trial, ...], folder: Path, progress: Progress
) -> tuple[Plain, Foreseen | str] | str:
    """The present model's result and what linearisation foresees; words where it cannot be fitted.

    A model that cannot be fitted is a good reason to change it.
    """
    try:
        fit = fit_of(edit.before, trials, available(edit.before), progress)
        foreseen = foreseen_by(edit, fit)
        found = earlier(folder, edit.before, fit)
        found = found or dict(examine(edit.before, trials, progress, fit).result)
    except TrialidError as error:
        return f"the model before cannot be fitted: {error}"
    return found, foreseen


def foreseen_by(edit: Edit, fit: Fit) -> Foreseen | str:
    """What linearisation about the model before foresees; words where it cannot."""
    if edit.step == "dropped":
        return foresee_dropping(fit, edit.effect)
    held = [n for n in edit.effect.parameters if n not in edit.after.identify.free]
    return f"{held[0]} is not free" if held else foresee_adding(fit, edit.effect)


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
