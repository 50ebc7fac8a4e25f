"""How one trial came out at the end of a search: what it was simulated with, and its error."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from trialid.accuracy.equations import normed_rms
from trialid.arrays import Mask, Vector
from trialid.identification.check.own_start import own_start
from trialid.identification.check.own_taken_out import OwnTakenOut, own_taken_out
from trialid.identification.check.start_error import StartError, start_error
from trialid.identification.output_error import (
    Problem,
    compared_mask,
    output_error,
    output_matrix,
)
from trialid.names.quantities import POSITION
from trialid.simulation.integrate import Response, initial, respond, starts_of
from trialid.trial import Trial

if TYPE_CHECKING:
    from trialid.identification.fit import Fit


@dataclass(frozen=True)
class Score:
    """How one trial came out: eps_RMSn of each output, and the simulated response."""

    trial: Trial
    response: Response
    compared: Mask
    eps_rmsn: Mapping[str, float]
    counts: Mapping[str, int]


def pool_errors(scored: Sequence[Score]) -> dict[str, float]:
    """Root mean square of each output over all compared samples of these trials."""
    squares, counts = dict[str, float](), dict[str, int]()
    for score in scored:
        for c, eps in score.eps_rmsn.items():
            squares[c] = squares.get(c, 0.0) + eps**2 * max(score.counts[c], 1)
            counts[c] = counts.get(c, 0) + max(score.counts[c], 1)
    return {c: float(np.sqrt(squares[c] / counts[c])) for c in squares}


def of_own_motion(score: Score, problem: Problem) -> float:
    """Error of one trial as a share of what moved in it alone, all outputs together.

    The heading of a long turn makes what is wrong with a zig-zag look small.
    """
    shares = []
    for c, eps in score.eps_rmsn.items():
        i = problem.outputs.index(c)
        moved = float(np.std(score.trial.signals[c][score.compared[:, i]])) / problem.y_rms[i]
        shares.append(eps if c in POSITION else eps / moved if moved > 0.0 else np.inf)
    return float(np.sqrt(np.mean(np.square(shares)))) if shares else 0.0


def of_trial(
    fit: "Fit", trial: Trial, shared: Mapping[str, float] | None = None
) -> tuple[dict[str, float], dict[str, float]]:
    """Parameters and initial states with which a fit simulates one trial.

    A trial to check has nothing of its own but its start and its current, if the fit leaves them
    free too: for its sensors see `common_values`, in whose place `shared` may stand.
    """
    problem = fit.problem
    if trial.use == "fit":
        place = [t.name for t in problem.trials].index(trial.name)
        values = problem.values(fit.theta, place)
        return values, starts_of(values)
    values = dict(fit.common if shared is None else shared)
    own = own_start(problem, trial, compared_mask(trial, problem.simulator), values, fit.level)
    return values | {n: own[n] for n in own if n in values}, starts_of(own)


def own_start_error(fit: "Fit", trial: Trial) -> StartError | None:
    """How sure the start of a trial to check is; None where the fit itself says so, or none is."""
    if trial.use == "fit":
        return None
    compared = compared_mask(trial, fit.problem.simulator)
    return start_error(fit.problem, trial, compared, _with_start(fit, trial), fit.level)


def check_rows(
    fit: "Fit", trial: Trial, shared: Mapping[str, float] | None = None
) -> OwnTakenOut | None:
    """The rows of a trial to check less what is its own: see `own_taken_out`."""
    compared = compared_mask(trial, fit.problem.simulator)
    return own_taken_out(fit.problem, trial, compared, _with_start(fit, trial, shared), fit.level)


def _with_start(
    fit: "Fit", trial: Trial, shared: Mapping[str, float] | None = None
) -> dict[str, float]:
    """All a trial to check is simulated with, its start by the name of the column."""
    values, start = of_trial(fit, trial, shared)
    return values | {initial(n): x for n, x in start.items()}


def score_trial(fit: "Fit", trial: Trial, shared: Mapping[str, float] | None = None) -> Score:
    """Simulate one trial with the fitted parameters, or a trial to check with `shared`."""
    problem = fit.problem
    compared = compared_mask(trial, problem.simulator)
    values, start = of_trial(fit, trial, shared)
    response = respond(problem.simulator, trial, values, start, sensitivities=False)
    if response.departure is None:
        eps = _errors(trial, response, compared, problem.outputs, problem.y_rms)
    else:  # what was lost has no error, however good its beginning
        compared = compared & np.isfinite(response.y)
        eps = dict.fromkeys(problem.outputs, np.inf)
    counts = dict(zip(problem.outputs, map(int, compared.sum(axis=0)), strict=True))
    return Score(trial, response, compared, eps, counts)


def _errors(
    trial: Trial, response: Response, compared: Mask, outputs: Sequence[str], y_rms: Vector
) -> Mapping[str, float]:
    """eps_RMSn of each output in one trial, by the norm of the fit."""
    eps = output_error(output_matrix(trial, outputs), response.y)
    return {
        c: normed_rms(eps[compared[:, i], i], y_rms[i])
        for i, c in enumerate(outputs)
        if compared[:, i].any()
    }
