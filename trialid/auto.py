"""The loop that adds what is missing until nothing is: fit, diagnose, decide, add, and again.

It stops where the evidence ends: when the verdict is not `missing`, or when the effect named does
not lower the error once it is in the model. Nothing is written here.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from trialid import history
from trialid.change import Edit, adding, fitted_after, present, proposed
from trialid.diagnosis.bias import foresee_adding
from trialid.diagnosis.likelihood import objection
from trialid.errors import TrialidError
from trialid.pipeline import Progress, Run, align_trials, examine
from trialid.recipe import Recipe

MOST: Final = 12
"""Effects it adds on its own; who needs more has another trouble."""


@dataclass(frozen=True)
class Stage:
    """One step of the loop.

    `run` is the model with `added` in it (None: the model as written), unless it was not `kept`;
    then it is the model before. `end` says why the loop ends here, empty where it goes on.
    """

    recipe: Recipe
    run: Run
    added: str | None
    kept: bool
    end: str


def stages(recipe: Recipe, progress: Progress) -> Iterator[Stage]:
    """The model as written, then one stage for each effect that the verdict names.

    Raises
    ------
    TrialidError
        The model as written cannot be fitted.
    """
    trials = align_trials(recipe, progress)
    run = examine(recipe, trials, progress)
    stage = Stage(recipe, run, None, True, _end(run, ()))
    yield stage
    added: list[str] = []
    while not stage.end:
        name = str(stage.run.findings.verdict.effect)
        added.append(name)
        try:
            edit = adding(stage.recipe, name)
            foreseen = foresee_adding(stage.run.findings.before.fit, edit.effect)
            edit, fit = fitted_after(edit, trials, foreseen, progress)
            run = examine(edit.after, trials, progress, fit)
        except TrialidError as error:
            stage = replace(stage, added=name, kept=False, end=f"with {name}: {error}")
        else:
            stage = judged(stage, edit, run, added)
        yield stage


def judged(stage: Stage, edit: Edit, run: Run, added: Sequence[str]) -> Stage:
    """The stage that follows: the new model if it is the better one, else the old one kept."""
    name = edit.effect.name
    trouble = _no_better(stage.run, run, name)
    if trouble:
        return replace(stage, added=name, kept=False, end=f"{trouble} with {name}")
    return Stage(edit.after, run, name, True, _end(run, added))


def _end(run: Run, added: Sequence[str]) -> str:
    """Why nothing more is to be added, empty where something is."""
    verdict = run.findings.verdict
    if verdict.effect is None:
        return f"the verdict is `{verdict.kind}`"
    if verdict.effect in added:
        return f"{verdict.effect} was added already"
    if len(added) >= MOST:
        return f"{MOST} effects were added, the most it adds on its own"
    return ""


def _no_better(before: Run, after: Run, name: str) -> str:
    """What speaks against an effect once it is in the model, empty where nothing does."""
    old, new = before.findings.before.fit, after.findings.before.fit
    inflation = next(c.inflation for c in before.findings.ranking if c.effect.name == name)
    return objection(old, new, len(new.settings.free) - len(old.settings.free), inflation)


def concluded(done: Sequence[Stage]) -> tuple[Run, tuple[history.Step, ...]]:
    """The last model's run with the history of all stages, and the steps the file lacks.

    A model that is as written leaves no step behind.
    """
    first, last = done[0], done[-1]
    before, _ = history.read(first.recipe.path)
    rows = [
        present(s.run.result) | {"step": "added", "added": s.added, "dropped": None}
        for s in done[1:]
        if s.kept
    ]
    told = [*history.continued(before, present(first.run.result)), *rows]
    result = {**last.run.result, "history": [*told, *proposed(last.run.result)]}
    return replace(last.run, result=result), tuple(told[len(before) :]) if rows else ()
