"""A speed that is one in all trials is read without its log's noise; one that changes as it is."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import SETTINGS, SHIP, zigzag

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.records.one_speed import without_noise_of_speed
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond

LENGTH = 24.0
"""Time in which the S-175 goes her own length [s]."""
MODEL = ShipModel(SHIP, ("v", "r"), (CATALOGUE["linear_hull"], CATALOGUE["linear_rudder"]))


def logged(angle, use="fit", lost=0.0, noise=0.01):
    """A zig-zag of a linear ship at 7.33 m/s, her speed logged with noise; lost as she turns."""
    trial = zigzag(angle, use=use)
    rng = np.random.default_rng([angle, 71])
    still = replace(trial, signals=trial.signals | {"u": np.full(trial.samples, 7.33)})
    r = respond(prepare(MODEL, (), ("r",)), still, {}, {}, sensitivities=False).y[:, 0]
    turning = np.abs(r) / np.max(np.abs(r))
    u = 7.33 * (1.0 - lost * turning + noise * rng.standard_normal(len(r)))
    valid = dict.fromkeys(("delta", "r", "u"), np.ones(len(r), dtype=bool))
    signals = {"delta": trial.signals["delta"], "r": r, "u": u}
    made = replace(trial, signals=signals, valid=valid)
    return replace(made, signals=signals | {"r": r + 2e-5 * rng.standard_normal(len(r))})


def test_a_speed_that_is_one_is_read_as_its_mean_and_told():
    trials = without_noise_of_speed([logged(10), logged(20)], LENGTH)
    for trial in trials:
        assert np.ptp(trial.signals["u"]) == 0.0
        assert trial.signals["u"][0] == pytest.approx(7.33, rel=1e-3)
        assert trial.remarks[-1].startswith("u: she goes at one speed, to 0.")


@pytest.mark.parametrize("made", [{"lost": 0.05}, {"noise": 0.0}])
def test_a_speed_that_changes_or_is_stated_stays(made):
    trials = [logged(angle, **made) for angle in (10, 20)]
    for trial, left in zip(trials, without_noise_of_speed(trials, LENGTH), strict=True):
        assert left is trial


def test_trials_at_different_speeds_stay():
    one, other = logged(10), logged(20)
    slower = replace(other, signals=other.signals | {"u": 0.9 * other.signals["u"]})
    assert without_noise_of_speed([one, slower], LENGTH) == (one, slower)


def test_nothing_is_missing_of_a_linear_ship_whose_log_of_speed_is_noisy():
    """Her forces had the noise of her log, and the rudder's race took it out again."""
    asked = replace(SETTINGS, free=("Nv", "Nr", "Ndelta"), outputs=("r",))
    trials = [logged(10), logged(20), logged(5, "check")]
    noisy, steady = (
        identify(some, MODEL, asked) for some in (trials, without_noise_of_speed(trials, LENGTH))
    )
    assert steady.eps_rmsn < 0.8 * noisy.eps_rmsn
    assert diagnose(steady, DiagnoseSettings()).verdict.kind == "nothing missing"
