"""A boat on missions: an autopilot holds her on courses, or her rudder is put over in steps.

A stable motor boat whose drag is not in the model to begin with; gusts push her and turn her, and
her rudder may have a dead band.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.identification.ship_priors import ship_priors
from trialid.ship.estimate.all_numbers import ship_from_particulars
from trialid.ship.model import ShipModel
from trialid.trial import Trial

STEP, DURATION = 0.05, 260.0
LEG, HOLD = 50.0, 6.0
GYRO, FEEDBACK = np.deg2rad(0.25), np.deg2rad(0.15)
LIMIT, SERVO, QUICK = np.deg2rad(20.0), 0.3, np.deg2rad(15.0)
FREE: Final = ("Nv", "Nr", "Ndelta")
HULL: Final = {
    **{"m": 0.0133, "Yvdot": -0.0114, "I_zz": 0.00089, "Nrdot": -0.00048},
    **{"Yv": -0.020, "Yr": 0.0040, "Nv": -0.0040, "Nr": -0.0040},
    **{"Ydelta": -0.0050, "Ndelta": 0.0024, "Yvav": -0.037, "Nrar": -0.00036},
}
"""What is true of her, primed."""


@dataclass(frozen=True)
class Boat:
    """Length [m], speed [m/s], gusts and dead band as angles of the rudder [rad], and drag."""

    length: float = 8.0
    speed: float = 5.5
    gusts: float = np.deg2rad(1.0)
    dead: float = 0.0
    drag: float = 1.0


def begun_model(boat: Boat) -> ShipModel:
    """The model to begin with: a linear hull and rudder, by her particulars."""
    size = boat.length
    ship = ship_from_particulars(
        length=size, beam=0.32 * size, draught=0.0625 * size, block=0.33, speed=boat.speed
    )
    names = ("linear_hull", "linear_rudder")
    return ShipModel(ship, ("v", "r"), tuple(CATALOGUE[n] for n in names))


def mission_fit(boat: Boat, seed: int, *, kept: bool) -> Fit:
    """The linear model fitted to two missions, a third held out; `kept` by an autopilot."""
    model, rng = begun_model(boat), np.random.default_rng(seed)
    trials = [mission(boat, rng, f"mission {i}", kept=kept) for i in range(3)]
    held = Trial(**{**vars(trials[1]), "use": "check"})
    nuisance = ("initial_state", "bias", "rudder_offset", "delay")
    settings = Settings(FREE, ("r",), nuisance=nuisance, priors=dict(ship_priors(model, FREE)))
    return identify([trials[0], held, trials[2]], model, settings)


def mission(boat: Boat, rng: np.random.Generator, name: str, *, kept: bool) -> Trial:
    """One of four minutes: a new course every 50 s, or another rudder every 6 s."""
    own, count = boat.length / boat.speed, round(DURATION / STEP)
    if kept:
        turns = rng.uniform(85.0, 95.0, 1 + round(DURATION / LEG))
        orders = np.cumsum(np.deg2rad(turns) * rng.choice([-1, 1], len(turns)))
    else:
        orders = np.deg2rad(rng.uniform(-6.0, 6.0, 1 + round(DURATION / HOLD)))
    turned, delta = _sailed(boat, orders, _gusts(boat, own, rng, count), kept=kept)
    every = round(0.1 / STEP)
    signals = {"delta": delta[::every], "r": turned[::every]}
    noise = {"delta": FEEDBACK, "r": GYRO}
    signals = {n: x + noise[n] * rng.standard_normal(len(x)) for n, x in signals.items()}
    signals["u"] = np.full(len(signals["r"]), boat.speed)
    valid = {n: np.ones(len(x), dtype=bool) for n, x in signals.items()}
    return Trial(name, "fit", 0.1, signals, valid)


def _gusts(boat: Boat, own: float, rng: np.random.Generator, count: int) -> Vector:
    """What turns her beside the rudder, as an angle of it: slow against her own time; (N,)."""
    stay, made = np.exp(-STEP / (1.5 * own)), np.zeros(count)
    drawn = rng.standard_normal(count) * np.sqrt(1.0 - stay**2)
    for k in range(1, count):
        made[k] = stay * made[k - 1] + drawn[k]
    return made * boat.gusts


def _sailed(boat: Boat, orders: Vector, gusts: Vector, *, kept: bool) -> tuple[Vector, Vector]:
    """Rate of turn and rudder; (N,) each. Sway and yaw by Euler's steps, in her own time."""
    true, own = HULL, boat.length / boat.speed
    v = r = psi = delta = 0.0
    turned, moved = np.zeros(len(gusts)), np.zeros(len(gusts))
    for k, gust in enumerate(gusts):
        order = orders[int(k * STEP // (LEG if kept else HOLD))]
        wanted = 0.8 * (order - psi) - 0.4 * r if kept else order
        pull = (np.clip(wanted, -LIMIT, LIMIT) - delta) / SERVO
        delta += STEP * np.clip(pull, -QUICK, QUICK)
        acts = delta - np.clip(delta, -boat.dead, boat.dead) + gust
        Y = true["Yv"] * v + (true["Yr"] - true["m"]) * r + true["Ydelta"] * acts
        N = true["Nv"] * v + true["Nr"] * r + true["Ndelta"] * acts
        Y += boat.drag * true["Yvav"] * abs(v) * v
        N += boat.drag * true["Nrar"] * abs(r) * r
        v += STEP / own * Y / (true["m"] - true["Yvdot"])
        r += STEP / own * N / (true["I_zz"] - true["Nrdot"])
        psi += STEP / own * r
        turned[k], moved[k] = r / own, delta
    return turned, moved
