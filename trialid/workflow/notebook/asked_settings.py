"""What a notebook asks of a fit, held against the form and the rules of a pipeline file."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from pydantic import ValidationError

from trialid.alignment.agreement import checks, slopes
from trialid.alignment.held_roll import held_roll
from trialid.errors import NotIdentifiable, nearest
from trialid.identification.problem import Settings
from trialid.pipeline_file import Pipeline, check_form
from trialid.pipeline_file.complaints import own_mistakes, problem, refusal
from trialid.pipeline_file.contradictions import contradictions
from trialid.pipeline_file.form import (
    Described,
    DiagnoseSection,
    LogSection,
    SignalSource,
    TrialSection,
)
from trialid.pipeline_file.named_file import Origin
from trialid.pipeline_file.prior_section import Prior
from trialid.ship.model import ShipModel
from trialid.trial import Trial
from trialid.workflow.build_model import check_bounds, check_headway, settings_of
from trialid.workflow.steering_gaps import known_throughout

CALL: Final = Origin(Path("ti.identify"), b"")
"""Where errors say that it stands: a call has no file."""
OUTPUTS: Final = "identify.outputs["
"""Key of one output."""


def asked_settings(trials: Sequence[Trial], model: ShipModel, asked: Mapping[str, Any]) -> Settings:
    """The settings of a fit in memory, refused where a pipeline file would be.

    Parameters
    ----------
    asked
        Keys of a pipeline's `[identify]`; a prior may be a pair, mean and standard deviation.

    Raises
    ------
    TrialidError
        In one line: the key, what is wrong, the nearest valid names.
    """
    pipeline = _as_written(trials, model, asked)
    # Which outputs there are, the fit says: only it knows a ship that lies in memory.
    found = [(key, said) for key, said in contradictions(pipeline) if not key.startswith(OUTPUTS)]
    if found:
        raise refusal(CALL.path, found)
    settings = settings_of(pipeline, model)
    check_bounds(pipeline, model, settings)
    check_headway(pipeline, model, tuple(trials))
    return settings


def checked_trials(trials: Sequence[Trial], model: ShipModel) -> tuple[Trial, ...]:
    """The trials of a fit; NotIdentifiable where they, or the model, are something else.

    And where what steers her is not recorded for long in the middle of one.
    """
    if not isinstance(model, ShipModel):
        raise NotIdentifiable(f"ti.identify: model: expected a ti.ShipModel, got {model!r}")
    found = tuple(trials) if isinstance(trials, Iterable) else ()
    wrong = [each for each in found if not isinstance(each, Trial)]
    if wrong or not isinstance(trials, Iterable):
        kind = type(trials).__name__ + (f" with a {type(wrong[0]).__name__}" if wrong else "")
        raise NotIdentifiable(
            "ti.identify: trials: expected a list of ti.Trial, as ti.Trial.from_frame and ti.align "
            f"make them, got a {kind}"
        )
    for trial in found:
        _check_gaps(trial, model)
    return tuple(_agreeing(trial) for trial in found)


def _agreeing(trial: Trial) -> Trial:
    """A trial made in memory with rates that are not the slopes of their angles, as `align` has it.

    Refused where a unit is wrong.
    """
    if trial.logs:
        return trial
    findings = checks.of_trial(trial)
    wrong = next((one.sentence for one in findings if one.severity == "error"), None)
    if wrong is not None:
        said = wrong.partition("; write gain")[0]
        raise NotIdentifiable(f"trial {trial.name!r}: {said}; state it right under units")
    apart = tuple(c for one in findings if (c := slopes.contradiction(one)) is not None)
    return replace(trial, contradictions=apart)


def _check_gaps(trial: Trial, model: ShipModel) -> None:
    """Refuse a trial of which a pipeline would use a part.

    With a long gap in what steers her, or a heel that is held and let go.
    """
    if (held := held_roll(trial)) is not None:
        raise NotIdentifiable(f"trial {trial.name!r}: {held.words(trial)}")
    part = known_throughout(trial, model.ship.particulars, model.effects)
    if part.samples < trial.samples:
        said = part.remarks[-1].partition(": only")[0]
        raise NotIdentifiable(
            f"trial {trial.name!r}: {said}: a simulation comes out of that with another state than "
            "she did; make a trial of each stretch beside it"
        )


def asked_diagnosis(asked: Mapping[str, Any]) -> dict[str, Any]:
    """Settings of a diagnosis in memory, with a pipeline's own where nothing is said.

    Parameters
    ----------
    asked
        `level`, `refit`, `family_cos`; `noise` by output [SI]; `quiet`, windows [s] by trial.

    Raises
    ------
    TrialidError
        In one line: the key, and what is wrong.
    """
    for name in (n for n in asked if n not in (*_AS_IN_A_FILE, "quiet")):
        hint = nearest(name, (*_AS_IN_A_FILE, "quiet"))
        raise NotIdentifiable(f"diagnose has no setting {name!r}; {hint}")
    table = {key: _plain(asked[key]) for key in asked if key in _AS_IN_A_FILE}
    try:
        section = DiagnoseSection.model_validate(table)
    except ValidationError as error:
        found = [problem(one, DiagnoseSection) for one in own_mistakes(error)]
        raise refusal(Path("ti.diagnose"), found) from error
    return {**asked, **{key: getattr(section, key) for key in _AS_IN_A_FILE}}


_AS_IN_A_FILE: Final = ("level", "refit", "family_cos", "noise")
"""Keys of a pipeline's `[diagnose]` that mean the same here, the unit of noise apart."""


def _as_written(trials: Sequence[Trial], model: ShipModel, asked: Mapping[str, Any]) -> Pipeline:
    """The pipeline that would ask the same, its ship apart; PipelineError where none could."""
    table = {key: _plain(value) for key, value in asked.items()}
    if isinstance(known := table.get("priors"), dict):
        table |= {"priors": {name: _prior(pair) for name, pair in known.items()}}
    described = check_form(Described, {"model": _NO_SHIP, "identify": table}, CALL)
    written = [
        TrialSection.model_construct(
            name=trial.name,
            use=trial.use,
            logs=(LogSection.model_construct(path=CALL.path),),
            signals={n: SignalSource(channel=n) for n in ("u",) if n in trial.signals},
        )
        for trial in trials
    ]
    made = Pipeline.model_construct(**dict(described), trials=tuple(written))
    made.model_post_init(CALL)
    return made


_NO_SHIP: Final[Mapping[str, list[str]]] = {"states": [], "effects": []}
"""The model's part of a pipeline of sensors alone: what a `ShipModel` holds it has checked."""


def _prior(known: Any) -> Any:
    """A pair as the table that a pipeline has."""
    pair = isinstance(known, list) and len(known) == 2
    return dict(zip(Prior.model_fields, known, strict=True)) if pair else known


def _plain(given: Any) -> Any:
    """Numbers and lists as a file would hold them, whatever of Python or NumPy they are."""
    if isinstance(given, np.generic):
        return given.item()
    if isinstance(given, Mapping):
        return {name: _plain(value) for name, value in given.items()}
    if isinstance(given, Iterable) and not isinstance(given, str | bytes):
        return [_plain(value) for value in given]
    return given
