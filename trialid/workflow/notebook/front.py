"""The workflow in a notebook or a script: from a pipeline file, or from arrays without any file."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.effects import CATALOGUE
from trialid.errors import NotIdentifiable, nearest
from trialid.identification import fit as search
from trialid.identification.fit import Fit
from trialid.identification.nuisance.of_each_trial import Nuisance
from trialid.identification.trial_score import of_trial
from trialid.pipeline_file import load
from trialid.pipeline_file.form import IdentifySection
from trialid.progress import Progress, silent
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial
from trialid.user_files import path_of
from trialid.workflow.notebook.asked_settings import asked_diagnosis, asked_settings, checked_trials
from trialid.workflow.notebook.fit_run import FitRun, diagnosed_run
from trialid.workflow.notebook.pipeline_run import PipelineRun, pipeline_run
from trialid.workflow.run import run as run_pipeline

if TYPE_CHECKING:
    import pandas as pd

NOTHING: Final[Mapping[str, tuple[float, float]]] = MappingProxyType({})


def run(pipeline: str | Path, progress: Progress = silent) -> PipelineRun:
    """Fit the model of a pipeline file to its logs and say what it is worth; nothing is written.

    The numbers are those of `trialid run`, digit for digit.

    Raises
    ------
    TrialidError
        The input is wrong; one line says what, where and what to do.
    """
    return pipeline_run(run_pipeline(load(path_of(pipeline, "ti.run")), progress))


def identify(
    trials: Sequence[Trial],
    model: ShipModel,
    *,
    free: Sequence[str],
    outputs: Sequence[str],
    nuisance: Sequence[Nuisance] = ("initial_state", "bias", "rudder_offset"),
    priors: Mapping[str, tuple[float, float]] | str = NOTHING,
    **settings: Any,
) -> Fit:
    """Fit the free parameters to every trial marked `fit`, with all safeguards.

    Parameters
    ----------
    free
        Parameters of the model's effects to fit.
    outputs
        Signals to compare: `r`, `phi`, ...
    nuisance
        What each trial has for itself.
    priors
        What is known beforehand: mean and standard deviation by name, or `"ship"`: of each that the
        ship's file states with its scatter, what it says.
    settings
        The rest of a pipeline's `[identify]`: `bounds` (name to a pair), `weights`, `loss`,
        `starts`, `seed`, `max_iterations`; what a file may not say, none of these may.

    Raises
    ------
    TrialidError
        The model or the record does not allow a fit; one line says why.
    """
    for name in settings:
        if name not in IdentifySection.model_fields:
            hint = nearest(name, IdentifySection.model_fields)
            raise NotIdentifiable(f"identify has no setting {name!r}; {hint}")
    if isinstance(priors, str) and priors != "ship":
        raise NotIdentifiable(f'priors = {priors!r} is not known; "ship", or a pair for each name')
    asked = {"free": free, "outputs": outputs, "nuisance": nuisance, "priors": priors, **settings}
    known = checked_trials(trials, model)
    return search.identify(known, model, asked_settings(known, model, asked))


def diagnose(
    fit: Fit,
    *,
    candidates: Mapping[str, Effect] | None = None,
    name: str = "fit",
    **settings: Any,
) -> FitRun:
    """What a fit's error is made of, how far its parameters can be trusted, and what is missing.

    Parameters
    ----------
    candidates
        Effects to try, by name; the catalogue where nothing is said.
    name
        What the run is called in tables and reports.
    settings
        The rest of a pipeline's `[diagnose]`: `level`, `refit`, `family_cos`, `noise` [SI].

    Raises
    ------
    TrialidError
        A setting is none, or no number that it may be; one line says which.
    """
    if not isinstance(fit, Fit):
        raise NotIdentifiable(f"ti.diagnose: fit: expected what ti.identify gives, got {fit!r}")
    tried = CATALOGUE if candidates is None else candidates
    asked = DiagnoseSettings(candidates=tried, **asked_diagnosis(settings))
    return diagnosed_run(fit, asked, name)


def simulate(
    model: ShipModel | Fit,
    trial: Trial,
    outputs: Sequence[str] | None = None,
    start: Mapping[str, float] | None = None,
) -> "pd.DataFrame":
    """The motion a model makes of a trial's inputs.

    Parameters
    ----------
    model
        A ship model, or a fit: then with the trial's own nuisances, and the outputs of the fit.
    outputs
        States or what sensors make of them; where none is said the rate of turn and the heel, as
        far as she has them.
    start
        Initial states that are not to be taken from the record [SI].

    Returns
    -------
    DataFrame
        Index `t` [s], a column for each output [SI].

    Raises
    ------
    TrialidError
        An output or a start the model has not, a signal the trial lacks, or the model leaves its
        domain.
    """
    import pandas as pd

    _check_simulated(model, trial)
    values: Mapping[str, float] = {}
    begun = dict(start or {})
    if isinstance(model, Fit):
        simulator, outputs = model.problem.simulator, model.problem.outputs
        values, own = of_trial(model, trial)
        begun = {**own, **begun}
    else:
        outputs = [n for n in ("r", "phi") if n in model.states] if outputs is None else outputs
        simulator = prepare(model, (), outputs)
    for state in (s for s in begun if s not in simulator.equations.states):
        known = nearest(state, simulator.equations.states)
        raise NotIdentifiable(f"ti.simulate: start: no state {state!r} is simulated; {known}")
    response = respond(simulator, trial, values, begun, sensitivities=False)
    if response.departure is not None:
        raise NotIdentifiable(f"the model leaves its domain: {response.departure}")
    index = pd.Index(trial.t, name="t")
    return pd.DataFrame(np.asarray(response.y), index=index, columns=list(outputs))


def _check_simulated(model: ShipModel | Fit, trial: Trial) -> None:
    """Refuse what is no model and no trial, and a trial of a fit that it did not see."""
    if not isinstance(model, ShipModel | Fit) or not isinstance(trial, Trial):
        raise NotIdentifiable(
            "ti.simulate: expected a ti.ShipModel or what ti.identify gives, and a ti.Trial, got a "
            f"{type(model).__name__} and a {type(trial).__name__}"
        )
    fitted = [one.name for one in model.problem.trials] if isinstance(model, Fit) else [trial.name]
    if trial.use == "fit" and trial.name not in fitted:
        raise NotIdentifiable(
            f"ti.simulate: trial {trial.name!r} has use='fit' and was not fitted "
            f"({nearest(trial.name, fitted)}); make it with use='check'"
        )
