"""A play between the rudder that is logged and its blade: no order has to be on record for it."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.search.candidates import missing_signals
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.simulation.integrate import guess, prepare, respond
from trialid.trial import Trial

BACKLASH = CATALOGUE["rudder_backlash"]
PLAY = float(np.deg2rad(1.2))
TRIED = (
    *("rudder_backlash", "rudder_deadband", "rudder_cubic", "rudder_record_delay"),
    *("yaw_cubic_rrr", "delay_r"),
)


def behind(shown: np.ndarray) -> np.ndarray:
    """What a blade does whose linkage has a play: it stays until it is pushed or pulled."""
    blade = np.zeros(len(shown))
    blade[0] = shown[0]
    for k in range(1, len(shown)):
        blade[k] = np.clip(blade[k - 1], shown[k] - PLAY, shown[k] + PLAY)
    return blade


def sailed(amplitude: int, seed: int) -> Trial:
    """A zig-zag of the blade, whose indicator is logged, with noise."""
    trial = s175q.zigzag(amplitude)
    shown = trial.signals["delta"]
    simulator = prepare(s175q.MODEL, (), s175q.OUTPUTS)
    bladed = replace(trial, signals={**trial.signals, "delta": behind(shown)})
    y = respond(simulator, bladed, {}, {"u": 7.33}, sensitivities=False).y
    seen = {**trial.signals, "r": y[:, 0].copy(), "phi": y[:, 1].copy()}
    noise = s175q.white(np.random.default_rng(seed), trial.samples)
    return s175q.with_noise(replace(trial, signals=seen), *noise)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [2095, 2096, 2097])
def test_it_has_its_name_where_the_indicator_alone_is_logged(seed: int) -> None:
    """A dead band had it alone, with which ranges missed the truth of an outsider's ship.

    Where these do as well, and chance has the dead band first, both are told.
    """
    trials = [sailed(amplitude, seed + k) for k, amplitude in enumerate((5, 10, 20))]
    fit = identify(trials, s175q.MODEL, s175q.SETTINGS)
    found = diagnose(fit, DiagnoseSettings(candidates={n: CATALOGUE[n] for n in TRIED}))
    assert found.verdict.kind == "missing"
    assert "rudder_backlash" in found.verdict.family
    assert {*found.verdict.family} <= {"rudder_backlash", "rudder_deadband"}
    [refit] = [r for r in found.refits if r.candidate.effect.name == "rudder_backlash"]
    assert refit.fit.value("b_play") == pytest.approx(PLAY, rel=0.2)


@pytest.mark.parametrize("logged", ["delta", "delta_order"])
def test_its_blade_starts_where_the_rudder_or_its_order_does(logged: str) -> None:
    trial = s175q.zigzag(10)
    kept = {n: x for n, x in trial.signals.items() if n != "delta"}
    kept[logged] = trial.signals["delta"] + 0.05
    told = replace(trial, signals=kept, valid={n: np.ones(trial.samples, bool) for n in kept})
    model = s175q.MODEL + BACKLASH
    assert missing_signals(s175q.MODEL, told, BACKLASH) == []
    assert guess(model, told, "delta_blade") == pytest.approx(kept[logged][0])
    none = replace(trial, signals={n: x for n, x in kept.items() if n != logged})
    assert guess(model, none, "delta_blade") == 0.0
