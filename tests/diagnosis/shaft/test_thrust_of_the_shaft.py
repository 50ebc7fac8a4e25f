"""Orders to the engine in a turn: the thrust goes with the shaft, and a constant one does not."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SHAFT

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings, Diagnosis
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.sample import rudder_orders as helm
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

OUTPUTS = ("u", "r")
FREE = ("Xuu", "Yv", "Ydelta", "Nv", "Nr", "Ndelta")
UNRECORDED = (MODEL - "propeller_thrust" + CATALOGUE["propeller_unrecorded"]).with_values(
    {"X_P0": 0.0004226, "k_P": 2.1}
)
"""The ship, with a thrust that holds her on her course and knows no orders."""
EVERY = round(0.5 / helm.PERIOD)


def ordered(truth: ShipModel, seed: int, use: str) -> Trial:
    """Two minutes at two thirds of the revolutions and two above them in turn."""
    delta = helm.multi_frequency_binary(15.0, seed)[::EVERY]
    n = np.where(np.arange(len(delta)) // 240 % 2, 1.15, 0.67) * SHAFT
    signals = {"delta": delta, "n": n}
    valid = {name: np.ones(len(delta), dtype=bool) for name in (*signals, *OUTPUTS)}
    blank = Trial(use, use, 0.5, signals, valid)
    y = respond(prepare(truth, (), OUTPUTS), blank, {}, {"u": 7.33}, sensitivities=False).y
    u, r = y.T + np.random.default_rng(seed).standard_normal(y.T.shape) * [[0.02], [5e-4]]
    return replace(blank, signals={**signals, "u": u, "r": r})


def found(truth: ShipModel, seed: int) -> Diagnosis:
    fitted, check = (ordered(truth, seed + k, use) for k, use in enumerate(("fit", "check")))
    settings = Settings(FREE, OUTPUTS, nuisance=("initial_state",))
    fit = identify((fitted, check), UNRECORDED, settings)
    done = diagnose(fit, DiagnoseSettings(candidates=CATALOGUE))
    print(done.verdict.sentence)
    return done


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [71, 72])
def test_it_is_named_where_orders_change_the_shaft(seed: int) -> None:
    done = found(MODEL, seed)
    assert done.verdict.family[0] == "shaft_thrust"
    assert done.after is not None
    print(done.before.fit.eps_rmsn, done.after.fit.eps_rmsn)
    assert done.after.fit.eps_rmsn < 0.5 * done.before.fit.eps_rmsn


@pytest.mark.parametrize("seed", [71, pytest.param(72, marks=pytest.mark.study(turn="each"))])
def test_it_is_not_where_the_thrust_knows_no_orders(seed: int) -> None:
    assert found(UNRECORDED, seed).verdict.kind == "nothing missing"
