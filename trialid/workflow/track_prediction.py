"""The track of a trial as the fitted model predicts it, beside the one that was measured."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.sailed_trial import sail_plainly
from trialid.effects.track import CURRENT
from trialid.identification.fit import Fit
from trialid.identification.trial_score import Score, of_trial
from trialid.result.track_series import PLACE, TrackSeries, Way
from trialid.trial import Trial

POSITION: Final = ("x", "y")
APPARENT: Final = ("V_aw", "gamma_aw", "psi")


def track_of(fit: Fit, score: Score) -> TrackSeries | None:
    """The track of a trial, None where no position was recorded.

    Over the ground where positions are outputs of the fit, which finds the current if it is asked
    to; else through the water from the first fix on, by the model's own heading.
    """
    trial = score.trial
    if not {*POSITION} <= {*trial.signals}:
        return None
    simulated = {*POSITION} <= {*fit.problem.outputs} and score.response.departure is None
    predicted = _compared(fit, score) if simulated else sail_plainly(fit, trial)
    values, _ = of_trial(fit, trial)
    known = [values.get(n) for n in CURRENT]
    lost = np.full(trial.samples, np.nan)
    return TrackSeries(
        trial=trial.name,
        t=trial.t,
        measured=Way(*(_seen(trial, n) for n in PLACE)),
        predicted=Way(*((predicted or {}).get(n, lost) for n in PLACE)),
        current=None if known[0] is None or known[1] is None else (known[0], known[1]),
        wind=true_wind(trial),
        over_ground=simulated,
    )


def true_wind(trial: Trial) -> tuple[float, float] | None:
    """Mean wind over the ground, to the north and to the east [m/s]; None where none was recorded.

    The wind on board, turned by the heading, with the ship's own speed over the ground added.
    """
    if not {*POSITION, *APPARENT} <= {*trial.signals}:
        return None
    seen = np.all([trial.valid[n] for n in (*POSITION, *APPARENT)], axis=0)
    speed, angle, psi = (trial.signals[n] for n in APPARENT)
    from_there = angle + psi
    relative = (-speed * np.cos(from_there), -speed * np.sin(from_there))
    own = (np.gradient(trial.signals[n], trial.period) for n in POSITION)
    whole = [(air + ship)[seen] for air, ship in zip(relative, own, strict=True)]
    if not seen.any() or not np.isfinite(whole).all():
        return None
    return float(np.mean(whole[0])), float(np.mean(whole[1]))


def _seen(trial: Trial, name: str) -> Vector:
    if name not in trial.signals:
        return np.full(trial.samples, np.nan)
    return np.where(trial.valid[name], trial.signals[name], np.nan)


def _compared(fit: Fit, score: Score) -> Mapping[str, Vector]:
    """Positions as simulated for the fit, and the heading simulated, or recorded."""
    outputs = dict(zip(fit.problem.outputs, score.response.y.T, strict=True))
    states = dict(zip(fit.problem.simulator.equations.states, score.response.states.T, strict=True))
    own = outputs.get("psi", states.get("psi"))
    heading = _seen(score.trial, "psi") if own is None else own
    return {**{n: outputs[n] for n in POSITION}, "psi": heading}
