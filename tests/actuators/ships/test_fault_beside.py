"""An actuator's fault beside what else is missing is chosen with that in the model."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trialid.diagnosis.search.carry_over import carried_between
from trialid.diagnosis.search.gross_fault import with_other_fault
from trialid.diagnosis.search.refit import settings_with
from trialid.diagnosis.search.together import Together, fit_together
from trialid.effects.actuators import actuator_effects
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.progress import silent
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

sys.path.append(str(Path(__file__).parents[1]))

import otter
from otter_model import CANDIDATES, SHIP

KNOWN = {**CANDIDATES, **actuator_effects(SHIP)}
PUSHED = ("thrusters", "still_water_surge", "still_water_yaw_quadratic")
TRUE = {"k_ahead": 0.01, "k_astern": 0.006, "Xu0": -80.0, "Nrar0": -400.0}
SWAY = {"X_sway": 120.0, "N_sway": -60.0, "T_sway": 1.5}
WEAK = 0.4


def sailed(left: str, seed: int) -> Trial:
    """A record of the boat with sway that is not logged and this fault of `left`."""
    effects = tuple(KNOWN[n] for n in (*PUSHED, "sway_in_turns", left))
    [fault] = KNOWN[left].parameters
    made = ShipModel(SHIP, ("u", "r"), effects).with_values(TRUE | SWAY | {fault: WEAK})
    t = np.arange(0.0, 120.0, 0.2)
    orders = otter.some_orders(t, seed)
    signals = {"left": orders[:, 0], "right": orders[:, 1]}
    blank = Trial("a", "fit", 0.2, signals, {n: np.ones(len(t), np.bool_) for n in signals})
    y = respond(prepare(made, (), ("u", "r")), blank, {}, {"u": 0.0, "r": 0.0}).y
    rng = np.random.default_rng(seed)
    signals |= {
        "u": y[:, 0] + 0.01 * rng.standard_normal(len(t)),
        "r": y[:, 1] + 0.002 * rng.standard_normal(len(t)),
    }
    return replace(blank, signals=signals, valid={n: np.ones(len(t), np.bool_) for n in signals})


def begun(seed: int) -> Fit:
    model = ShipModel(SHIP, ("u", "r"), tuple(KNOWN[n] for n in PUSHED))
    free = ("k_ahead", "k_astern", "Xu0", "Nrar0")
    settings = Settings(free=free, outputs=("u", "r"), nuisance=("initial_state",))
    return identify([sailed("left_weak", seed)], model.with_values(TRUE), settings)


def test_a_weak_thruster_is_not_a_misaligned_one_where_sway_is_missing_too() -> None:
    fit = begun(9400)
    effects = (KNOWN["sway_in_turns"], KNOWN["right_misaligned"])
    wrong = fit_together(fit, effects, settings_with(fit, effects))
    found = Together(effects, wrong, carried_between(fit, wrong))
    better = with_other_fault(fit, found, KNOWN, silent)
    assert better.names == ("sway_in_turns", "left_weak")
    assert better.fit.eps_rmsn < 0.5 * wrong.eps_rmsn
    assert better.fit.value("weak_left") == pytest.approx(WEAK, abs=0.02)


def test_what_is_no_fault_of_an_actuator_is_left_as_it_was_found() -> None:
    fit = begun(9401)
    effects = (KNOWN["sway_in_turns"], KNOWN["still_water_yaw"])
    both = fit_together(fit, effects, settings_with(fit, effects))
    found = Together(effects, both, carried_between(fit, both))
    assert with_other_fault(fit, found, KNOWN, silent) is found
