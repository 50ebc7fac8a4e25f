"""A fast ferry with two waterjets, each with a nozzle and a bucket: her truth, and her model.

What her jets do is written from the equations alone, like `three_ships`.
"""

import math
from typing import Final

import numpy as np
import three_ships as truth
from three_models import SLOW_HULL, Case

from trialid.ship.actuators import Actuator

HULL: Final = truth.Hull(L=40.0, T=1.5, mass=1.6e5, Xu=-2e3, Xuu=-700.0, Yv=-2e4, Nr=-6e6, C_D=0.8)
SIDES: Final = {"jet_port": -4.0, "jet_stbd": 4.0}
AFT, JET, BUCKET = -18.0, 160.0, 256.0
"""Their place [m]; thrust of an open jet and what a closed bucket takes off it [N s^2]."""


def push(now: truth.Row, u: float, v: float, r: float) -> tuple[float, float, float]:
    """Two jets turned by their nozzles: to starboard of the stern turns the bow to port."""
    total = np.zeros(3)
    for name, y in SIDES.items():
        along = (JET - BUCKET * now[f"{name}_bucket"]) * now[name] ** 2
        angle = now[f"{name}_angle"]
        total += truth.at_place(along * math.cos(angle), -along * math.sin(angle), AFT, y)
    return tuple(total)


def signals(t: truth.Vector, seed: int) -> dict[str, truth.Vector]:
    """Revolutions, nozzles to 25 deg and buckets from open to closed, each side apart."""
    rng = np.random.default_rng([seed, 6])
    turns = {name: truth.moved(t, rng, 5.0, 15.0, 6.0) for name in SIDES}
    turns |= {f"{name}_angle": truth.moved(t, rng, -0.44, 0.44, 4.0) for name in SIDES}
    return turns | {f"{name}_bucket": truth.moved(t, rng, 0.0, 1.0, 5.0) for name in SIDES}


JETS: Final = Case(
    name="jets",
    hull=HULL,
    push=push,
    signals=signals,
    actuators=tuple(Actuator(name=n, kind="waterjet", x=AFT, y=y) for n, y in SIDES.items()),
    effects=(
        "waterjets",
        "waterjets_bucket",
        *SLOW_HULL,
    ),
    sought={
        "k_jet_ahead": JET,
        "k_bucket": BUCKET,
        "Xuu": HULL.Xuu / (0.5 * truth.RHO * HULL.L**2),
        "Xu0": HULL.Xu,
        "Yv0": HULL.Yv,
        "Nr0": HULL.Nr,
        "C_D": HULL.C_D,
    },
    held={"k_jet_astern": 1.0},
)
