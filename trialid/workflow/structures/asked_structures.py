"""Which structures a pipeline is asked to be compared in, each with its model and settings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from trialid.diagnosis.search.candidates import why_unusable
from trialid.effects.usual_structures import TELLING, speed_of, usual_structures
from trialid.errors import PipelineError, TrialidError, nearest
from trialid.identification.problem import Settings
from trialid.pipeline_file import Pipeline, where
from trialid.pipeline_file.complaints import dotted_key
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.trial import Trial
from trialid.workflow.build_model import (
    available,
    build_model,
    check_bounds,
    check_headway,
    settings_of,
)

Names = tuple[str, ...]
AS_WRITTEN = "as written"
"""The pipeline's own effects, beside the usual structures."""


@dataclass(frozen=True)
class Structure:
    """A named list of effects, ready to be fitted."""

    name: str
    model: ShipModel
    settings: Settings


def asked_structures(
    pipeline: Pipeline, trials: tuple[Trial, ...]
) -> tuple[tuple[Structure, ...], dict[str, str]]:
    """The structures of `[structures]`, or the usual ones and the pipeline as written.

    And why others are left out, by name.

    Raises
    ------
    TrialidError
        The pipeline's own model is wrong, a list names what is no effect, or fewer than two
        structures can be tried on this record.
    """
    catalogue = available(pipeline)
    written = build_model(pipeline, catalogue)
    check_bounds(pipeline, written, settings_of(pipeline, written))
    check_headway(pipeline, written, trials)
    lists, left_out = _lists(pipeline, trials, catalogue)
    found = []
    for name, effects in lists.items():
        try:
            _check_usable(pipeline, effects, trials, catalogue)
            found.append(_structure(pipeline, name, effects, catalogue))
        except TrialidError as error:
            left_out[name] = str(error)
    if len(found) < 2:
        why = "".join(f"; {name}: {reason}" for name, reason in left_out.items())
        raise PipelineError(
            f"{where(pipeline, 'structures')}: fewer than two can be tried on this record{why}"
        )
    return tuple(found), left_out


def written_structures(pipeline: Pipeline, catalogue: Mapping[str, Effect]) -> dict[str, Names]:
    """All effects of each structure of `[structures]`: what no list names stays in every one.

    Raises
    ------
    PipelineError
        A list names what is no effect.
    """
    own, given = pipeline.model.effects, pipeline.structures
    for name, effects in given.items():
        for i, effect in enumerate(effects):
            if effect not in catalogue:
                place = where(pipeline, dotted_key("structures", name, i))
                known = nearest(effect, catalogue)
                raise PipelineError(f"{place}: there is no effect {effect!r}; {known}")
    told = {n for effects in given.values() for n in effects}
    base = tuple(n for n in own if n not in told)
    return {name: (*base, *effects) for name, effects in given.items()}


def _lists(
    pipeline: Pipeline, trials: Sequence[Trial], catalogue: Mapping[str, Effect]
) -> tuple[dict[str, Names], dict[str, str]]:
    """All effects of each structure, and why usual ones are left out."""
    own = pipeline.model.effects
    if given := written_structures(pipeline, catalogue):
        return given, {}
    usual, left_out = usual_structures(
        pipeline.model.states, own, speed_of(pipeline.model.states, trials)
    )
    base = tuple(n for n in own if n not in TELLING)
    lists = {name: (*base, *effects) for name, effects in usual.items()}
    if {*own} not in map(set, lists.values()):
        lists[AS_WRITTEN] = own
    return lists, left_out


def _check_usable(
    pipeline: Pipeline, effects: Names, trials: Sequence[Trial], catalogue: Mapping[str, Effect]
) -> None:
    """Refuse effects that this record has no signals for, or the speed in another form."""
    new = [n for n in effects if n not in pipeline.model.effects]
    kept = tuple(n for n in effects if n not in new)
    model = _structure(pipeline, "", kept, catalogue).model
    for name in new:
        for trial in trials:
            if why := why_unusable(model, trial, catalogue[name]):
                raise PipelineError(f"{name} {why}")
        model = model + catalogue[name]


def _structure(
    pipeline: Pipeline, name: str, effects: Names, catalogue: Mapping[str, Effect]
) -> Structure:
    """The pipeline with these effects, ready to be fitted."""
    varied = with_effects(pipeline, effects, catalogue)
    model = build_model(varied, catalogue)
    return Structure(name, model, settings_of(varied, model))


def with_effects(pipeline: Pipeline, effects: Names, catalogue: Mapping[str, Effect]) -> Pipeline:
    """The pipeline with these effects: its own keep what is free in them, of others all is."""
    own, asked = pipeline.model, pipeline.identify
    new = [p for n in effects if n not in own.effects for p in catalogue[n].parameters]
    gone = {p for n in own.effects if n not in effects for p in catalogue[n].parameters}
    model = {"effects": effects, "values": {n: x for n, x in own.values.items() if n not in gone}}
    identify = {
        "free": (*(n for n in asked.free if n not in gone), *new),
        "priors": {n: x for n, x in asked.priors.items() if n not in gone},
        "bounds": {n: x for n, x in asked.bounds.items() if n not in gone},
    }
    return pipeline.model_copy(
        update={
            "model": own.model_copy(update=model),
            "identify": asked.model_copy(update=identify),
        }
    )
