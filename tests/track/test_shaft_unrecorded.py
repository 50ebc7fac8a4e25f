"""Surge in hard turns where nobody recorded the revolutions: kept, or the torque, or the power."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from s175q import MODEL, SHAFT
from sailed_tracks import SHIP, noisy, sailed

from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.identification.trial_score import of_trial
from trialid.ship.effect import Force, Parameter, effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

J, NO_THRUST, NO_TORQUE = 0.785, 1.158, 1.25
"""Of the S-175 on her course, and where thrust and torque of her screw end."""
OUTPUTS = ("u", "r", "psi", "x", "y")
LOST = "propeller_unrecorded"
TRUTH = {"revolutions": 2.1, "power": 0.62, "torque": 0.22}


def thrust_left(kept: str, slower: float) -> float:
    """Thrust over that on the course at a share of its speed, from J on both lines."""
    power = {"revolutions": 0.0, "torque": 2.0, "power": 3.0}[kept]
    low, high = 0.3, 1.0
    for _ in range(60):
        n = 0.5 * (low + high)
        load = n ** (power - 1.0) * (NO_TORQUE * n - J * slower) / (NO_TORQUE - J)
        low, high = (n, high) if load < 1.0 else (low, n)
    n = n if power else 1.0
    return n * (NO_THRUST * n - J * slower) / (NO_THRUST - J)


@pytest.mark.parametrize("kept", TRUTH)
def test_the_line_is_the_screw_s_down_to_half_the_speed(kept: str) -> None:
    for slower in (1.0, 0.9, 0.7, 0.5):
        assert 1.0 + TRUTH[kept] * (1.0 - slower) == pytest.approx(
            thrust_left(kept, slower), rel=0.02
        )


def curved(kept: str) -> ShipModel:
    """The ship with the thrust of its two lines, quadratic through what they come to."""
    half, most = thrust_left(kept, 0.5) - 1.0, thrust_left(kept, 0.0 + 0.75) - 1.0
    bend = (half - 2.0 * most) / (0.5**2 - 2.0 * 0.25**2)
    slope = (most - bend * 0.25**2) / 0.25

    @effect(source="test")
    def screw(u, U0, *, X_s=Parameter(0.0004)):
        """X = X_s U0^2 (1 + slope lost + bend lost^2)."""
        lost = (U0 - u) / U0
        return Force(X=X_s * U0 * U0 * (1.0 + slope * lost + bend * lost * lost))

    resistance = -MODEL.value("Xuu")
    return ((SHIP - "propeller_thrust") + screw).with_values({"X_s": resistance})


@cache
def fitted(kept: str) -> tuple[Fit, Trial]:
    """Of two zig-zags with the speed logged, no revolutions; the hard turn is held out."""
    logs = []
    for seed, name in enumerate(("zigzag", "small zigzag", "circle")):
        told = sailed(name, (0.0, 0.0))
        blank = Trial(name, "fit", 2.0, {"delta": told.signals["delta"]}, {})
        y = respond(
            prepare(curved(kept), (), OUTPUTS), blank, {}, {"psi": 0.7}, sensitivities=False
        ).y
        signals = {"delta": told.signals["delta"]}
        signals |= {c: y[:, i].copy() for i, c in enumerate(OUTPUTS)}
        valid = {n: np.ones(len(y), dtype=bool) for n in signals}
        use = "check" if name == "circle" else "fit"
        trial = noisy(Trial(name, use, 2.0, signals, valid), np.random.default_rng([61, seed]))
        log = trial.signals["u"] + 0.05 * np.random.default_rng(seed).standard_normal(len(y))
        logs.append(replace(trial, signals={**trial.signals, "u": log}))
    model = (SHIP - "propeller_thrust") + CATALOGUE[LOST]
    settings = Settings(("Xvr", "X_P0", "k_P"), OUTPUTS, nuisance=("initial_state",))
    return identify(logs, model, settings), logs[-1]


@pytest.mark.parametrize("kept", TRUTH)
def test_a_hard_turn_is_foretold_from_zigzags_without_revolutions(kept: str) -> None:
    fit, turn = fitted(kept)
    assert "n" not in turn.signals
    values, start = of_trial(fit, turn)
    y = respond(prepare(fit.model, (), ("u",)), turn, values, start, sensitivities=False).y
    u, left = turn.signals["u"], float(np.mean(y[-50:, 0]))
    assert float(np.mean(u[-50:])) < 0.7 * u[0]
    print(
        f"{kept}: {left:.2f} m/s foretold, {np.mean(u[-50:]):.2f} true; k_P {fit.value('k_P'):.2f}"
    )
    assert left == pytest.approx(float(np.mean(u[-50:])), rel=0.05)


def test_the_revolutions_of_the_reference_ship_are_these() -> None:
    particulars = MODEL.ship.particulars
    speed = (1.0 - MODEL.value("w_P")) * particulars["U0"]
    assert speed / (SHAFT / (2.0 * np.pi) * MODEL.value("D_P")) == pytest.approx(J, rel=0.01)
    assert -MODEL.value("KT0") / MODEL.value("KT1") == pytest.approx(NO_THRUST, rel=0.01)
