"""A stall below its typical angle, and an inflow that differs by drift alone, have their names.

At 25.8 deg a stall has no trace where the rudder is put over by 20 at most. Of the inflow this ship
shows enough at its typical lever too; of a tanker's record, where it did not, nothing is kept here.
"""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag

from trialid.diagnosis.diagnose import diagnose
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify

FIT = replace(SETTINGS, free=("Nv", "Nr", "Ndelta", "Yv", "Kdelta", "Kp", "GM"))


def record(truth, seed):
    """Zig-zags of 5, 10 and 20 deg to fit, one of 20 held out."""
    rng = np.random.default_rng(seed)
    made = []
    for k, amplitude in enumerate((5, 10, 20, 20)):
        trial = zigzag(amplitude, truth, use="check" if k == 3 else "fit")
        noisy = with_noise(trial, *white(rng, trial.samples))
        made.append(replace(noisy, name=f"{trial.name} {k}"))
    return made


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("stall", [12.0, 15.0])
def test_a_stall_that_no_rudder_at_its_typical_angle_shows_is_named(stall):
    values = {"N_stall": -0.0006, "delta_stall": np.deg2rad(stall)}
    truth = (MODEL + CATALOGUE["rudder_stall"]).with_values(values)
    found = diagnose(identify(record(truth, 31), MODEL, FIT))
    assert found.verdict.effect == "rudder_stall"
    [refit] = [r for r in found.refits if r.candidate.effect.name == "rudder_stall"]
    assert np.rad2deg(refit.fit.value("delta_stall")) == pytest.approx(stall, abs=1.0)


@pytest.mark.study(turn="each")
def test_an_inflow_that_differs_by_drift_alone_is_named():
    values = {"N_flow": -0.0008, "l_flow": 0.0}
    truth = (MODEL + CATALOGUE["rudder_flow_asymmetry"]).with_values(values)
    found = diagnose(identify(record(truth, 32), MODEL, FIT))
    assert found.verdict.effect == "rudder_flow_asymmetry"


@pytest.mark.study(turn="each")
def test_the_same_ship_without_either_has_neither():
    assert diagnose(identify(record(MODEL, 33), MODEL, FIT)).verdict.effect is None
