"""What a step of the model changed, in few words: from the pipelines before and after, or the rows.

The history file knows effects and free parameters alone; what else was edited is known for as long
as the workbench is open.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from trialid.names.wording import MINUS
from trialid.pipeline_file import Pipeline
from trialid.report.pictures.error_history import step_words
from trialid.result.change_rows import StepRow
from trialid.ship.effect import Effect

AS_EDITED = "as edited"


def change_words(old: Pipeline, new: Pipeline, catalogue: Mapping[str, Effect]) -> str:
    """What sets a pipeline apart from the one before: effects, free parameters, trials, numbers.

    What is said of the parameters of an effect that came or went goes with it.
    """
    had, has = old.model.effects, new.model.effects
    moved = {*had} ^ {*has}
    with_it = {p for name in moved if name in catalogue for p in catalogue[name].parameters}
    free = (_less(each.identify.free, with_it) for each in (old, new))
    words = [*_effects(had, has), *_free(*free), *_trials(old, new), *_numbers(old, new, with_it)]
    return ", ".join(words) or AS_EDITED


def of_rows(rows: Sequence[StepRow]) -> list[str]:
    """Each step in words, as far as the history tells what was done to come to it."""
    return [_of_row(row, rows[i - 1] if i else None) for i, row in enumerate(rows)]


def _of_row(row: StepRow, before: StepRow | None) -> str:
    if before is None or row.step != "as written":
        return step_words(row)
    words = [*_effects(before.effects, row.effects)] or [*_free(before.free, row.free)]
    return ", ".join(words) or step_words(row)


def _less(names: Iterable[str], without: Iterable[str]) -> list[str]:
    return [name for name in names if name not in without]


def _effects(had: Iterable[str], has: Iterable[str]) -> list[str]:
    return [
        *(f"+ {name}" for name in _less(has, had)),
        *(f"{MINUS} {name}" for name in _less(had, has)),
    ]


def _free(had: Iterable[str], has: Iterable[str]) -> list[str]:
    return [
        *(f"free {name}" for name in _less(has, had)),
        *(f"fix {name}" for name in _less(had, has)),
    ]


def _trials(old: Pipeline, new: Pipeline) -> list[str]:
    """Trials held out or fitted again; any other change of them in one word."""
    used = {trial.name: trial.use for trial in old.trials}
    turned = [t for t in new.trials if used.get(t.name, t.use) != t.use]
    words = [f"{t.name} {'held out' if t.use == 'check' else 'fitted'}" for t in turned]
    alike = [t.model_copy(update={"use": used.get(t.name, t.use)}) for t in new.trials]
    return words if alike == [*old.trials] else [*words, "other trials"]


def _numbers(old: Pipeline, new: Pipeline, without: set[str]) -> list[str]:
    """Values and bounds; those of a parameter that was fixed went with that."""
    fixed = {*old.identify.free} - {*new.identify.free}
    values = _differing(old.model.values, new.model.values, without)
    bounds = _differing(old.identify.bounds, new.identify.bounds, without | fixed)
    return [
        *(f"no value of {n}" if x is None else f"{n} = {x.value:g}" for n, x in values.items()),
        *(f"{'no ' if x is None else ''}bounds of {n}" for n, x in bounds.items()),
    ]


def _differing(old: Mapping[str, Any], new: Mapping[str, Any], without: set[str]) -> dict[str, Any]:
    """What is said now of the names of which something else was said before; None for nothing."""
    names = _less(dict.fromkeys([*old, *new]), without)
    return {name: new.get(name) for name in names if old.get(name) != new.get(name)}
