"""A structure fitted to all trials, and to all but one or two and scored on those."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace

import numpy as np

from trialid.errors import NotIdentifiable, TrialidError
from trialid.identification.adequacy import why_no_fit, worse_than_none
from trialid.identification.file_of_ship import most_are_unlike
from trialid.identification.fit import Fit, identify
from trialid.identification.trial_score import Score
from trialid.least_squares.gauss_newton import REASONS
from trialid.trial import Trial
from trialid.version import VERSION
from trialid.workflow.structures.asked_structures import Structure


@dataclass(frozen=True, kw_only=True)
class KeptFit:
    """What is needed of a structure's fit afterwards.

    Attributes
    ----------
    why_not
        Why it is worth nothing, and then nothing else is known; empty where it is sound.
    errors
        Error of each trial left out, normed as the fit of all trials norms them.
    unforetold
        Those of them that were foretold worse than by their own means.
    parameters
        How many free parameters that trials share move an output.
    estimates, y_rms, substeps
        Of the fit of all trials: where the others begin, what norms errors, how fine the steps are.
    """

    why_not: str = ""
    errors: Mapping[str, float] = field(default_factory=dict)
    unforetold: tuple[str, ...] = ()
    eps_rmsn: float | None = None
    eps_rmsn_check: float | None = None
    parameters: int = 0
    estimates: Mapping[str, float] = field(default_factory=dict)
    y_rms: tuple[float, ...] = ()
    substeps: int = 1


def fit_whole(structure: Structure, trials: Sequence[Trial]) -> KeptFit:
    """The fit of all trials; the pipeline's held-out ones are scored and have no say in it.

    It is worth nothing where a run of this structure would carry no verdict, or where it takes
    coefficients that are not hers to fit: other structures do without.
    """
    try:
        fit = identify(trials, structure.model, structure.settings)
    except TrialidError as error:
        return KeptFit(why_not=str(error))
    if unlike := most_are_unlike(fit):
        return KeptFit(why_not=unlike)
    own = replace(fit, scores=tuple(s for s in fit.scores if s.trial.use == "fit"))
    if trouble := why_no_fit(own):
        return KeptFit(why_not=trouble.reason)
    shared = [i for i, x in enumerate(fit.problem.unknowns) if x.trial is None]
    check = fit.eps_check
    return KeptFit(
        eps_rmsn=fit.eps_rmsn,
        eps_rmsn_check=check if check is not None and np.isfinite(check) else None,
        parameters=int(np.any(fit.psi[:, shared] != 0.0, axis=0).sum()),
        estimates=fit.estimates,
        y_rms=tuple(map(float, fit.problem.y_rms)),
        substeps=fit.settings.substeps,
    )


def fit_without(
    structure: Structure, trials: Sequence[Trial], names: Sequence[str], whole: KeptFit
) -> KeptFit:
    """The fit of the other trials, begun at that of all, and its error on those left out.

    Whether its coefficients can be believed is not asked: how it foretells is what is measured.
    """
    settings = replace(structure.settings, substeps=whole.substeps)
    left = [replace(t, use="check") if t.name in names else t for t in trials]
    try:
        fit = identify(left, structure.model, settings, near=whole.estimates)
        if not fit.converged:
            raise NotIdentifiable(f"the search does not arrive: {REASONS[fit.reason]}")
        scores = [s for s in fit.scores if s.trial.use == "check"]
        return KeptFit(
            errors={s.trial.name: _error(fit, s, whole.y_rms) for s in scores},
            unforetold=tuple(s.trial.name for s in scores if worse_than_none(fit, s)),
        )
    except TrialidError as error:
        return KeptFit(why_not=f"without {' and '.join(names)}: {error}")


def _error(fit: Fit, score: Score, y_rms: Sequence[float]) -> float:
    """Error of a trial over its outputs, weighed as in the fit, in norms that are always the same.

    Raises
    ------
    NotIdentifiable
        The ship is lost in it, or nothing can be compared.
    """
    if score.response.departure is not None:
        raise NotIdentifiable(f"{score.trial.name} diverges: {score.response.departure}")
    problem, eps = fit.problem, score.eps_rmsn
    seen = [c for c, name in enumerate(problem.outputs) if name in eps]
    if not seen:
        raise NotIdentifiable(f"{score.trial.name} holds nothing to compare")
    own = np.array([eps[problem.outputs[c]] for c in seen])
    squares = (own * problem.y_rms[seen] / np.array(y_rms)[seen]) ** 2
    return float(np.sqrt(np.average(squares, weights=problem.weights[seen] ** 2)))


def key_of(
    structure: Structure, trials: Sequence[str], sources: Sequence[str], left_out: Sequence[str]
) -> str:
    """A hash of all that goes into a fit: trials, ship, own effects, model, settings, version."""
    model = structure.model
    effects = [effect.name for effect in model.effects]
    asked = (VERSION, sources, trials, left_out, model.states, effects)
    parts = (*asked, dict(model.values), asdict(structure.settings))
    said = json.dumps(parts, sort_keys=True, default=str)
    return hashlib.sha256(said.encode()).hexdigest()


def digest(trial: Trial) -> str:
    """A hash of all that a fit takes from a trial."""
    made = hashlib.sha256(repr((trial.name, trial.use, trial.period)).encode())
    for name, part in (*sorted(trial.signals.items()), *sorted(trial.valid.items())):
        made.update(name.encode() + part.tobytes())
    return made.hexdigest()
