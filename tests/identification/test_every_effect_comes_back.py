"""Closing the loop over the catalogue: each effect's numbers come back from its own record."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SHAFT

from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.names.quantities import POSITION
from trialid.ship.effect import Effect, Steered
from trialid.ship.model import STATES, ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

PERIOD, SAMPLES = 0.5, 900

KNOWN_SHIP = {e.name for e in MODEL.effects}
HIDDEN = {
    "propeller_rudder": "21 numbers of one rudder: no record tells them apart",
    "bias_psi": "the heading that the trial begins with says the same",
}


def disturbed() -> dict[str, np.ndarray]:
    """Rudder steps over waves, and everything else a record may hold, none of it at rest."""
    t = PERIOD * np.arange(SAMPLES)
    order = 0.35 * np.tanh(8.0 * np.sin(0.05 * t)) + 0.15 * np.sin(0.31 * t)
    return {
        "delta": order, "delta_order": order, "u": 7.33 + 0.5 * np.sin(0.01 * t),
        "n": SHAFT * (1.0 + 0.1 * np.sin(0.05 * t)), "n_p": SHAFT * (1.0 + 0.1 * np.sin(0.03 * t)),
        "n_s": SHAFT * (1.0 + 0.1 * np.sin(0.041 * t)), "h": 15.0 + 5.0 * np.sin(0.02 * t),
        "V_aw": 10.0 + 3.0 * np.sin(0.07 * t), "gamma_aw": np.sin(0.015 * t),
        "alpha_w": 0.03 * np.sin(0.5 * t), "r_ref": 0.01 * np.sin(0.2 * t),
        "X_ext": 1e5 * np.sin(0.1 * t), "Y_ext": 1e5 * np.sin(0.12 * t),
        "K_ext": 1e6 * np.sin(0.2 * t), "N_ext": 1e6 * np.sin(0.14 * t),
    }  # fmt: skip


def ship_with(effect: Effect) -> ShipModel:
    """The reference ship with this effect, less what has the same numbers or does the same."""
    instead = ("rudder_race", "rudder_race_shaft")
    same = "linear_rudder" if effect.name in instead else None
    kept = tuple(
        e for e in MODEL.effects if e.name != same and not {*e.parameters} & {*effect.parameters}
    )
    steered = effect.acts_on(Steered)
    states = tuple(s for s in STATES if s not in {*steered, *POSITION})
    return replace(MODEL, states=states, effects=kept) + effect


def record(model: ShipModel, effect: Effect) -> Trial:
    """All motions of the true ship; speed and rudder angle only where the effect leaves them."""
    signals = disturbed()
    if "delta" in effect.states:
        del signals["delta"]
    if effect.name.startswith("propeller_astern"):
        signals["n"] = SHAFT * (0.6 + 0.9 * np.sin(0.05 * PERIOD * np.arange(SAMPLES)))
    if effect.name == "surge_loss":
        signals["u"] = np.full(SAMPLES, 7.33)
    outputs = model.states
    signals |= {s: np.zeros(SAMPLES) for s in outputs}
    valid = {n: np.ones(SAMPLES, dtype=bool) for n in signals}
    blank = Trial("made", "fit", PERIOD, signals, valid)
    begin = {"u": 7.33} if "u" in outputs else {}
    y = respond(prepare(model, (), outputs), blank, {}, begin, sensitivities=False).y
    return replace(blank, signals=signals | {s: y[:, i] for i, s in enumerate(outputs)})


def start(effect: Effect) -> dict[str, float]:
    """Absent where it can be, else 20 % below the truth."""
    found = {}
    for n, p in effect.parameters.items():
        beside = 0.8 * p.start
        found[n] = beside if p.null is None or p.scan else p.null
        found[n] = float(np.clip(found[n], p.low, p.high))
    return found


NAMES = [n for n in CATALOGUE if n not in KNOWN_SHIP | {*HIDDEN}]
IN_TURN = [pytest.param(n, marks=pytest.mark.study(turn="each")) for n in NAMES]


@pytest.mark.parametrize("name", [n if i % 4 == 0 else IN_TURN[i] for i, n in enumerate(NAMES)])
def test_an_effect_comes_back(name: str) -> None:
    effect = CATALOGUE[name]
    truth = {n: p.start for n, p in effect.parameters.items()}
    model = ship_with(effect)
    trial = record(model.with_values(truth), effect)
    # simulated by these steps without noise: finer ones would be another truth
    settings = Settings(tuple(truth), model.states, nuisance=("initial_state",), most_substeps=1)
    fit = identify([trial], model.with_values(start(effect)), settings)
    for parameter, x in truth.items():
        assert fit.estimates[parameter] == pytest.approx(x, rel=1e-3), parameter
    assert fit.eps_rmsn < 1e-4


def test_two_gyros_are_compared_without_a_ship() -> None:
    """Nothing is simulated: gain, offset, delay and low-pass of one sensor against another."""
    truth = {"k_ref": 1.03, "b_r": 0.0008, "tau_r": 0.4, "T_r": 0.9}
    effects = tuple(CATALOGUE[n] for n in ("reference_rate", "bias_r", "delay_r", "lag_r"))
    model = ShipModel(MODEL.ship, (), effects)
    t = PERIOD * np.arange(SAMPLES)
    signals = {"r_ref": 0.01 * np.sin(0.2 * t) + 0.005 * np.sin(0.7 * t + 0.3), "r": 0.0 * t}
    valid = {n: np.ones(SAMPLES, dtype=bool) for n in signals}
    trial = Trial("two gyros", "fit", PERIOD, signals, valid)
    made = prepare(model.with_values(truth), (), ("r",))
    r = respond(made, trial, {}, {}, sensitivities=False).y[:, 0]
    noise = 1e-4 * np.random.default_rng(0).standard_normal(SAMPLES)
    trial = replace(trial, signals=signals | {"r": r + noise})
    begin = {"k_ref": 1.0, "b_r": 0.0, "tau_r": 0.1, "T_r": 0.3}
    fit = identify(
        [trial],
        model.with_values(begin),
        Settings(tuple(truth), ("r",), nuisance=(), most_substeps=1),
    )
    assert fit.estimates == pytest.approx(truth, abs=0.03)
    assert fit.estimates["b_r"] == pytest.approx(0.0008, abs=2e-5)
    assert fit.estimates["k_ref"] == pytest.approx(1.03, abs=0.005)
