"""A pipeline with one effect more or less, or with a coefficient freed or held; not yet written."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Literal

from trialid.diagnosis.search.freed import free_coefficient
from trialid.errors import PipelineError, nearest
from trialid.names.quantities import MASS_PARAMETERS
from trialid.pipeline_file import Pipeline, read, where
from trialid.pipeline_file.edit import add_effect, drop_effect, hold_parameter, set_free
from trialid.ship.effect import Effect
from trialid.ship.model import takes_place
from trialid.workflow import history
from trialid.workflow.build_model import available, build_model


@dataclass(frozen=True)
class Edit:
    """A pipeline before and after an effect was added or dropped, not yet written.

    `step` is `added` or `dropped`; `taken_out` says in words what the user had written for the
    effect's parameters.
    """

    step: Literal["added", "dropped"]
    effect: Effect
    before: Pipeline
    after: Pipeline
    taken_out: tuple[str, ...] = ()

    @property
    def grows(self) -> bool:
        """Whether an effect joins the model; a coefficient that it held and frees is none."""
        return self.step == "added" and self.effect.name in self.after.model.effects


def add_to_pipeline(pipeline: Pipeline, name: str) -> Edit:
    """The pipeline with an effect more, its parameters free; or with a held coefficient free.

    An effect that the model had before gets back those parameters that were free then.

    Raises
    ------
    PipelineError
        It is there already, there is no such effect, or the file would not be a pipeline.
    """
    if name in pipeline.model.effects:
        raise PipelineError(f"{where(pipeline, 'model.effects')}: {name!r} is there already")
    catalogue = available(pipeline)
    if (freed := _coefficient(pipeline, name, catalogue, free=False)) is not None:
        after, _ = _edited(pipeline, lambda text: (set_free(text, name), ()))
        return Edit("added", freed, pipeline, after)
    if name not in catalogue:
        hint = nearest(name, catalogue)
        hint = hint if hint.startswith("did") else "`trialid effects` lists what there is"
        raise PipelineError(
            f"{where(pipeline, 'model.effects')}: there is no effect {name!r}; {hint}"
        )
    effect = catalogue[name]
    steps, _ = history.read(pipeline.path)
    free = history.free_before(steps, name, tuple(effect.parameters))
    new = [n for n in free if n not in pipeline.identify.free]
    after, said = _edited(pipeline, lambda text: _in_its_place(pipeline, text, effect, new))
    return Edit("added", effect, pipeline, after, said)


def free_in_pipeline(pipeline: Pipeline, names: Sequence[str]) -> Pipeline:
    """The pipeline with numbers free that it holds.

    Raises
    ------
    PipelineError
        The file would not be a pipeline.
    """
    return _edited(pipeline, lambda text: (reduce(set_free, names, text), ()))[0]


def _in_its_place(
    pipeline: Pipeline, text: str, effect: Effect, free: Sequence[str]
) -> tuple[str, tuple[str, ...]]:
    """The text with an effect, without those that give the same state, and what it said of them."""
    catalogue, said = available(pipeline), list[str]()
    present = [catalogue[n] for n in pipeline.model.effects if n in catalogue]
    for other in (e for e in present if takes_place(effect, e)):
        text, words = drop_effect(text, other.name, tuple(other.parameters))
        said += words
    return add_effect(text, effect.name, free), tuple(said)


def drop_from_pipeline(pipeline: Pipeline, name: str) -> Edit:
    """The pipeline with an effect less, and without what it says of the effect's parameters.

    A coefficient that is free where the ship file gives a value is held at that again.

    Raises
    ------
    PipelineError
        It is not there, or the file would not be a pipeline.
    """
    catalogue = available(pipeline)
    if (freed := _coefficient(pipeline, name, catalogue, free=True)) is not None:
        after, said = _edited(pipeline, lambda text: hold_parameter(text, name))
        return Edit("dropped", freed, pipeline, after, said)
    if name not in pipeline.model.effects:
        raise PipelineError(
            f"{where(pipeline, 'model.effects')}: {name!r} is not there; "
            f"{nearest(name, pipeline.model.effects)}"
        )
    if name not in catalogue:
        raise PipelineError(
            f"{where(pipeline, 'model.effects')}: there is no effect {name!r}; "
            f"{nearest(name, catalogue)}"
        )
    own = tuple(catalogue[name].parameters)
    after, said = _edited(pipeline, lambda text: drop_effect(text, name, own))
    return Edit("dropped", catalogue[name], pipeline, after, said)


def _coefficient(
    pipeline: Pipeline, name: str, catalogue: Mapping[str, Effect], *, free: bool
) -> Effect | None:
    """What frees a coefficient of the model that is free, or is held; None where it is none."""
    if name in catalogue or (name in pipeline.identify.free) is not free:
        return None
    model = build_model(pipeline, catalogue)
    given = name in model.parameters and name not in MASS_PARAMETERS and model.stated(name)
    return free_coefficient(model, name) if given else None


def _edited(
    pipeline: Pipeline, change: Callable[[str], tuple[str, tuple[str, ...]]]
) -> tuple[Pipeline, tuple[str, ...]]:
    try:
        text, said = change(pipeline.text)
    except PipelineError as error:
        raise PipelineError(f"{pipeline.path}: {error}") from error
    return read(text.encode("utf-8"), pipeline.path), said


def difference_words(edit: Edit) -> str:
    """What is different in the file, in words: `effects + static_list, free + a_0`."""
    old, new = edit.before, edit.after
    sign = "+" if edit.step == "added" else "-"
    free = set(old.identify.free) ^ set(new.identify.free)
    words = [f"effects {sign} {edit.effect.name}"] if edit.effect.held is None else []
    words += [f"free {sign} {n}" for n in edit.effect.parameters if n in free]
    fresh = [n for n in new.model.values if n not in old.model.values]
    words += [f"values.{n} = {new.model.values[n].value:g} (start)" for n in fresh]
    return ", ".join(words)
