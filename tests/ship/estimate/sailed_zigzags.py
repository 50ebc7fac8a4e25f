"""Zig-zags of the published ships, and fits that begin with the ship files made of particulars."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from published import Published

from trialid.design.helm import vessel
from trialid.design.kinds import Test, sail
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.identification.ship_priors import ship_priors
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship
from trialid.trial import Trial
from trialid.workflow.first_pipeline.pipeline_text import ROLL

D: Final = np.pi / 180.0
NOISE: Final = 0.02
"""Of the sensors, as a share of what each signal moves."""
CUBIC: Final = ("sway_cubic_vvv", "sway_cubic_cross", "yaw_cubic_vvv", "yaw_cubic_cross")
HEEL: Final = ("linear_roll", "heel_roll", "heel_sway", "heel_yaw")
YAW: Final = ("Nv", "Nr", "Ndelta")
"""With `ROLL`, what `inspect --init` frees."""


@dataclass(frozen=True)
class Sailed:
    """A ship as published, her zig-zags, and the model a fit of them begins with."""

    truth: ShipModel
    begun: ShipModel
    trials: tuple[Trial, ...]

    @property
    def free(self) -> tuple[str, ...]:
        """What is estimated."""
        return YAW + (ROLL if "phi" in self.truth.states else ())

    @property
    def outputs(self) -> tuple[str, ...]:
        """What is compared."""
        return ("r", "phi") if "phi" in self.truth.states else ("r",)


def sailed(ship: Published, angles: Sequence[float] = (10.0, 20.0)) -> Sailed:
    """Zig-zags of a ship with every number that is published, the others as estimated.

    Her rudder is the estimated one where her source has none. She rolls where her source says how.
    """
    rolls = {"Kv", "Kp"} <= ship.values.keys()
    states = ("v", "p", "r", "phi") if rolls else ("v", "r")
    effects = tuple(CATALOGUE[e] for e in _effects(ship, rolls))
    truth = ShipModel(_as_published(ship), states, effects)
    begun = ShipModel(ship.estimated.ship, states, effects)
    made = Sailed(truth, begun, ())
    return replace(made, trials=tuple(_zigzag(made, a * D, i) for i, a in enumerate(angles)))


def fit(made: Sailed, priors: bool, more: Sequence[str] = ()) -> Fit:
    """The fit of the zig-zags from the file, with or without its scatter as priors."""
    free = (*made.free, *more)
    settings = Settings(
        free,
        made.outputs,
        nuisance=("initial_state", "bias", "rudder_offset", "delay"),
        priors=ship_priors(made.begun, free) if priors else {},
    )
    return identify(made.trials, made.begun, settings)


def _effects(ship: Published, rolls: bool) -> tuple[str, ...]:
    base = ("linear_hull", "linear_rudder")
    if "Yvvv" in ship.values:
        further = (*CUBIC, "sway_cubic_rrr", "yaw_cubic_rrr") if "Nrrr" in ship.values else CUBIC
    else:
        further = ("sway_drag_vav", "yaw_drag_rav", "yaw_drag_rar")
    return (*base, *further, *(HEEL if rolls else ()))


def _as_published(ship: Published) -> Ship:
    known = ship.estimated.ship
    mass, coefficients = (
        {n: ship.values.get(n, x) for n, x in rows.items()}
        for rows in (known.mass, known.coefficients)
    )
    return replace(known, name=ship.name, mass=mass, coefficients=coefficients)


def _zigzag(made: Sailed, angle: float, seed: int) -> Trial:
    ship = made.truth.ship
    L, U = ship.particulars["L"], ship.particulars["U0"]
    period, rate = L / U / 40.0, 2.5 * D * 24.0 * U / L
    ready = vessel(made.truth, period, {"u": U}, rate)
    test = Test("zigzag", {"angle": angle, "heading": angle}, 40.0 * L / U, L / U, {}, "zigzag")
    trial = sail(test, ready, 1.0).trial
    rng = np.random.default_rng(seed)
    signals = {"delta": trial.signals["delta"], "u": np.full(trial.samples, U)}
    for c in made.outputs:
        y = trial.signals[c]
        signals[c] = y + NOISE * np.std(y) * rng.standard_normal(len(y))
    valid = {n: np.ones(len(y), dtype=bool) for n, y in signals.items()}
    return Trial(f"zigzag-{angle / D:.0f}", "fit", period, signals, valid)
