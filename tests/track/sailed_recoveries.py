"""A Williamson turn and a stop of a ship whose truth is known, with a track and a current."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from s175q import MODEL, SHAFT
from sailed_tracks import OUTPUTS, PERIOD

from trialid.design.helm import Hold, Instructions, Motion, carry_out, vessel
from trialid.effects.track import current
from trialid.maths import Number
from trialid.ship.effect import Force, Parameter, effect
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

DEG = np.deg2rad(1.0)


@effect(source="a screw that pulls astern as it pushes ahead")
def screw(n: Number, *, X_n=Parameter(1e-8, low=0.0, high=1.0)) -> Force:
    """X = X_n n |n|."""
    return Force(X=X_n * n * abs(n))


BALANCED = 0.0004226 / (SHAFT * 175.0 / 7.33) ** 2
"""Her resistance at the approach speed, by the shaft's revolutions in lengths run."""
SCREWED = ((MODEL - "propeller_thrust") + screw).with_values({"X_n": BALANCED})
SHIP = replace(SCREWED, states=("u", "v", "p", "r", "phi", "psi", "x", "y"))


def beyond(side: float, heading: float) -> Callable[[Motion], np.ndarray]:
    return lambda motion: np.asarray(side * (motion["psi"] - heading) >= 0.0)


def williamson(angle: float, off: float = 0.0) -> Instructions:
    """Out by 60 deg, round until 40 deg before the last course, then steered on to it.

    That is the reciprocal one, less `off` [deg].
    """
    look = yield Hold(0.0, 0.0)
    course, side = float(look()["psi"][-1]), float(np.sign(angle))
    yield Hold(angle, 1000.0, beyond(side, course + side * 60 * DEG))
    yield Hold(-angle, 1000.0, beyond(-side, course - side * (140 - off) * DEG))
    goal = course - side * (180 - off) * DEG
    for _ in range(60):
        now = look()
        order = 1.5 * (goal - now["psi"][-1]) - 40.0 * now["r"][-1]
        look = yield Hold(float(np.clip(order, -35 * DEG, 35 * DEG)), 8.0)


def sailed_by(
    instructions: Instructions,
    shaft: Callable[[np.ndarray], np.ndarray],
    water: tuple[float, float],
    duration: float,
) -> Trial:
    """The motion under orders and a shaft by the clock, without noise, from a course of 40 deg."""
    ship = vessel(SCREWED, PERIOD, {"n": SHAFT}, 3.0 * DEG)
    run = carry_out(ship, instructions, 60.0, duration, "run").trial
    inputs = {"delta": run.signals["delta"], "n": shaft(run.t)}
    true = (SHIP + current).with_values({"V_cn": water[0], "V_ce": water[1]})
    names = (*OUTPUTS, "u")
    blank = Trial("run", "fit", PERIOD, inputs, {})
    y = respond(prepare(true, (), names), blank, {}, {"psi": 0.7}, sensitivities=False).y
    signals = {**inputs, **{c: y[:, i].copy() for i, c in enumerate(names)}}
    return Trial("run", "fit", PERIOD, signals, {c: np.ones(len(y), dtype=bool) for c in signals})


@cache
def sailed_williamson(water: tuple[float, float] = (0.0, 0.0), off: float = 0.0) -> Trial:
    orders = williamson(35.0 * DEG, off)
    return sailed_by(orders, lambda t: np.full(len(t), SHAFT), water, 1000.0)


@cache
def sailed_stop(water: tuple[float, float] = (0.0, 0.0)) -> Trial:
    """Full ahead to half astern at 90 s, by 2 rad/s in a second."""

    def shaft(t: np.ndarray) -> np.ndarray:
        return np.clip(SHAFT - 0.5 * (t - 90.0), -0.6 * SHAFT, SHAFT)

    def straight() -> Instructions:
        yield Hold(0.0, 10.0)

    return sailed_by(straight(), shaft, water, 900.0)
