"""Decays at rest in a model whose damping grows with speed: damping is missing, and no tank."""

from dataclasses import replace

import numpy as np
import pytest
from decays import Roller

from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.ship.model import ShipModel
from trialid.workflow.notebook.front import diagnose

SHIPS = (
    {"GM": 0.03, "ratio": 0.04, "square": 0.05, "arm": 0.15},
    {"GM": 0.04, "ratio": 0.05},
    {"GM": 0.05, "ratio": 0.03, "square": 0.3, "arm": 0.05},
)


def verdict(seed, **how):
    """Two decays fitted and one held out, a log of speed that holds its noise alone."""
    her = Roller(length=5.0, **how)
    rng = np.random.default_rng(seed)
    trials = []
    for heel, use in ((8, "fit"), (-15, "fit"), (12, "check")):
        trial = her.decay(heel, seed + abs(heel), use=use)
        speed = np.abs(rng.normal(0.0, 0.006, trial.samples))
        trials.append(replace(trial, signals={**trial.signals, "u": speed}))
    model = ShipModel(her.ship, ("p", "phi"), (CATALOGUE["linear_roll"],))
    known = {"Kp": (-7.5e-6, 4e-6)}
    settings = Settings(("Kp", "GM"), ("phi",), nuisance=("initial_state", "bias"), priors=known)
    return diagnose(identify(trials, model.with_values({"GM": 0.75 * her.GM}), settings)).verdict


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    "how", [SHIPS[0], *(pytest.param(s, marks=pytest.mark.study(turn="each")) for s in SHIPS[1:])]
)
def test_damping_at_rest_is_missing_and_no_tank(how):
    found = verdict(41, **how)
    assert found.kind == "missing"
    assert found.effect == "still_water_roll_damping"
