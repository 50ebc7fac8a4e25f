"""Where a heading is compared, a trial held out has its own zero of the rudder.

Rudders of three zig-zags lie 0.1, -0.1 and 0.4 deg off; the last is held out. The S175Q turns by
some degrees for that within ten minutes, which her model can tell nothing of.
"""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.identification.check.own_start import columns_of_its_own
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.identification.trial_score import of_trial
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

STATES = (*s175q.MODEL.states, "psi")
TRUTH = replace(s175q.MODEL, states=STATES)
LACKING = TRUTH - "yaw_drag_rar"
COMPASS = np.deg2rad(0.1)


def sailed(amplitude: int, off: float, use: str) -> Trial:
    """The zig-zag with a rudder so far off [deg], which its record does not show."""
    plain = s175q.zigzag(amplitude, use=use)
    n, rng = plain.samples, np.random.default_rng([53, amplitude])
    delta = plain.signals["delta"]
    signals = {**plain.signals, "delta": delta + np.deg2rad(off), "psi": np.zeros(n)}
    known = {name: np.ones(n, dtype=bool) for name in signals}
    outputs = ("psi", "r", "phi")
    bare = Trial(plain.name, use, plain.period, signals, known)
    y = respond(prepare(TRUTH, (), outputs), bare, {}, {"u": 7.33}, sensitivities=False).y
    y = y + rng.standard_normal(y.shape) * [COMPASS, s175q.GYRO, s175q.INCLINOMETER]
    seen = dict(zip(outputs, y.T.copy(), strict=True))
    return Trial(plain.name, use, plain.period, {**signals, "delta": delta, **seen}, known)


TRIALS = (sailed(5, 0.1, "fit"), sailed(20, -0.1, "fit"), sailed(10, 0.4, "check"))


def fitted(outputs: tuple[str, ...], model=TRUTH) -> Fit:
    free = tuple(n for n in ("Nr", "Nv", "Ndelta", "Nrar") if n != "Nrar" or model is TRUTH)
    settings = Settings(free, outputs, nuisance=("initial_state", "rudder_offset"))
    return identify(TRIALS, model, settings)


def test_a_heading_is_foretold_with_the_trials_own_zero() -> None:
    fit = fitted(("psi", "phi"))
    assert fit.eps_check_by_output["psi"] < 1.2 * COMPASS / fit.problem.y_rms[0]
    (held,) = (s for s in fit.scores if s.trial.use == "check")
    assert of_trial(fit, held.trial)[0]["delta_0"] == pytest.approx(
        np.deg2rad(0.4), abs=np.deg2rad(0.05)
    )


def test_and_what_the_model_lacks_still_shows_there() -> None:
    """The zero does not take it up: the damping that is missing leaves far more than noise."""
    whole, less = fitted(("psi", "phi")), fitted(("psi", "phi"), LACKING)
    assert less.eps_check_by_output["psi"] > 3.0 * whole.eps_check_by_output["psi"]


def test_of_a_rate_the_zero_is_the_mean_of_the_others() -> None:
    fit = fitted(("r", "phi"))
    assert "delta_0" not in columns_of_its_own(fit.problem)
    assert abs(fit.common["delta_0"]) < np.deg2rad(0.1)
