"""A kick ahead in a turn: the rudder's force goes with the shaft, and a free-flow rudder's not."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, OUTPUTS, SHAFT, white, with_noise

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.sample import rudder_orders as helm
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FREE = ("Yv", "Ydelta", "Nv", "Nr", "Ndelta", "Kv", "Kdelta", "Kp", "GM")
IN_THE_RACE = (MODEL - "linear_rudder" + CATALOGUE["rudder_race_shaft"]).with_values(
    {"N_un": 4.15e-6, "N_nn": 2.39e-8, "z_race": 0.033}
)
EVERY = round(0.5 / helm.PERIOD)


def kicked(truth, orders, use, rng):
    """Half a minute slow and half a minute fast in turn, whatever the rudder does."""
    delta = orders[::EVERY]
    kicks = np.where(np.arange(len(delta)) // 60 % 2, 1.5, 0.6) * SHAFT
    signals = {"delta": delta, "n": kicks}
    valid = {n: np.ones(len(delta), dtype=bool) for n in (*signals, *OUTPUTS)}
    blank = Trial(use, use, 0.5, signals, valid)
    y = respond(prepare(truth, (), OUTPUTS), blank, {}, {"u": 7.33}, sensitivities=False).y
    moved = {**signals, **dict(zip(OUTPUTS, (c.copy() for c in y.T), strict=True))}
    return with_noise(replace(blank, signals=moved), *white(rng, len(y)))


def found(truth, seed, candidates=CATALOGUE):
    rng = np.random.default_rng(seed)
    trials = tuple(
        replace(kicked(truth, helm.multi_frequency_binary(a, s), use, rng), name=f"{a}")
        for a, s, use in ((10.0, seed, "fit"), (20.0, seed + 1, "fit"), (15.0, seed + 2, "check"))
    )
    fit = identify(trials, MODEL, Settings(FREE, OUTPUTS, nuisance=("initial_state",)))
    diagnosis = diagnose(fit, DiagnoseSettings(candidates=candidates))
    print(diagnosis.verdict.sentence)
    return diagnosis


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [61, 62])
def test_it_is_named_where_the_shaft_changes(seed):
    """Ours: 34.5 and 36.0 to 6.3 and 6.5 %."""
    done = found(IN_THE_RACE, seed)
    assert done.verdict.family == ("rudder_race_shaft",)
    assert done.after is not None
    assert done.after.fit.eps_rmsn < 0.25 * done.before.fit.eps_rmsn


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [61, pytest.param(62, marks=pytest.mark.study(turn="each"))])
def test_it_is_not_where_the_rudder_stands_in_free_flow(seed):
    assert found(MODEL, seed).verdict.kind == "nothing missing"


@pytest.mark.study(turn="each")
def test_what_no_propeller_can_be_has_no_name():
    """Without the race slopes put the thrust deduction first; freed it was -22, 32.6 to 22.0 %."""
    others = {name: e for name, e in CATALOGUE.items() if name != "rudder_race_shaft"}
    done = found(IN_THE_RACE, 42, others)
    [deduction] = [c for c in done.ranking if c.effect.name == "t_P"]
    assert deduction.expected["t_P"] < deduction.effect.parameters["t_P"].low
    assert not deduction.allowed
    assert "t_P" not in done.verdict.family
