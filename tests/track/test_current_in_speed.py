"""A current that only a speed over ground tells, taken off the circles of its trials."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL
from sailed_tracks import NOISE, SHIP, accuracy, noisy, sailed
from test_measured_turns import STILL, truth, without_order

from trialid.design.imo.trial_measures import measure_trials
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.trial import Trial

WATER = (0.5, -0.3)
AHEAD = {"propeller_thrust", "surge_resistance", "surge_turning", "surge_rudder"}
KEPT = tuple(e for e in MODEL.effects if e.name not in AHEAD)
READ = replace(SHIP, states=("v", "p", "r", "phi"), effects=KEPT)
READ = READ + CATALOGUE["drift_in_speed_record"]
SETTINGS = Settings(("Nv", "Nr", "Ndelta"), ("r",), nuisance=("initial_state", "current"))


def over_ground(name: str, course: float, seed: int) -> Trial:
    """A trial whose log has the speed of a satellite receiver, and none through the water."""
    true = without_order(sailed(name, WATER, course=course))
    speed = np.hypot(*(np.gradient(true.signals[n], true.period) for n in ("x", "y")))
    sizes = {**NOISE, "u": 0.05}
    trial = replace(true, signals={**true.signals, "u": speed}, valid={**true.valid})
    trial.valid["u"] = np.ones(trial.samples, dtype=bool)
    return noisy(trial, np.random.default_rng([17, seed]), sizes)


def fitted(seed: int) -> Fit:
    names = ("circle", "zigzag", "small zigzag")
    return identify([over_ground(n, 0.7 + i, seed) for i, n in enumerate(names)], READ, SETTINGS)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_circle_in_still_water_is_told_by_a_speed_over_ground(seed: int) -> None:
    fit = fitted(seed)
    errors = {p.name: p.standard_error for p in accuracy(fit).parameters}
    for name, there in zip(("Uc_N", "Uc_E"), WATER, strict=True):
        assert fit.estimates[name] == pytest.approx(there, abs=3.0 * errors[name])
        assert errors[name] < 0.1
    done = measure_trials(fit, errors)
    for one in done.manoeuvres:
        assert one.speed_by == "log less the current"
        assert one.speed == pytest.approx(SHIP.ship.particulars["U0"], abs=0.15)
    found = {m.name: m for m in done.turns}
    still = truth(STILL)
    diameter = found["tactical diameter"]
    assert not diameter.interval[0] < still["tactical diameter"] < diameter.interval[1]
    for name in ("advance", "transfer", "tactical diameter"):
        row = found[name]
        assert row.corrected_for == "current"
        assert row.corrected is not None
        assert row.corrected_interval is not None
        low, high = row.corrected_interval
        reach = 1.5 * (high - low) / 2.0  # three standard errors
        assert row.corrected == pytest.approx(still[name], abs=reach)
