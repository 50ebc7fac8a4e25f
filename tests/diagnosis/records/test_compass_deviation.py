"""A magnetic compass that nobody corrected is told as one that deviates."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, zigzag

from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.objections import objection
from trialid.diagnosis.search.refit import refit
from trialid.diagnosis.search.score import rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.simulation.integrate import prepare, respond

DEG = np.pi / 180.0
HEADED = replace(MODEL, states=("v", "p", "r", "phi", "psi"))
ASKED = replace(SETTINGS, free=("Nv", "Nr", "Ndelta"), outputs=("r", "psi"))


def circle(angle, deviation, seed):
    """A circle by a compass that deviates so much [deg], its noise a fiftieth of a degree."""
    trial = zigzag(10)
    trial = replace(trial, name=f"circle {angle}")
    delta = np.full(trial.samples, angle * DEG)
    delta[:60] = 0.0
    trial = replace(trial, signals={**trial.signals, "delta": delta})
    made = respond(prepare(HEADED, (), ("r", "psi")), trial, {}, {"psi": 0.4}, sensitivities=False)
    r, psi = made.y.T.copy()
    rng = np.random.default_rng(seed)
    r += 0.002 * DEG * rng.standard_normal(len(r))
    psi += deviation * DEG * np.sin(psi + 0.7) + 0.02 * DEG * rng.standard_normal(len(psi))
    signals = {**trial.signals, "r": r, "psi": psi}
    return replace(trial, signals=signals, valid={n: np.ones(len(r), bool) for n in signals})


@pytest.mark.parametrize("deviation", [0.0, 4.0])
def test_a_compass_that_deviates_is_found_and_one_that_does_not_is_not(deviation):
    trials = [circle(15, deviation, 71), circle(-20, deviation, 72)]
    fit = identify(trials, HEADED, ASKED)
    name = "compass_deviation"
    [found] = refit(fit, rank(fit, {name: CATALOGUE[name]})[0], lambda words: None)
    level = DiagnoseSettings().level
    assert (objection(fit, found, level) == "") is (deviation > 0.0)
    if deviation:
        B, C = (found.fit.value(n) / DEG for n in ("B_dev", "C_dev"))
        assert (np.hypot(B, C), np.arctan2(C, B)) == pytest.approx((4.0, 0.7), abs=0.1)
