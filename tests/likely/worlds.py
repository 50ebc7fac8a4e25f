"""Ships on which intervals are counted: two of them, at three scales, with something hidden.

The truth is the ship as the person who fits knows her with one effect more, drawn from the
scenarios of the hidden-effects benchmark at a random size; or coefficients that are held fixed lie
off. Time and forces go by Froude's law, so that a boat manoeuvres as the ship does.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

import numpy as np
from hidden_scenarios import SCENARIOS, TYPICAL
from hidden_truth import (
    EFFECTS,
    FREE,
    OUTPUTS,
    ROOT,
    SHIP,
    Scenario,
    generator,
)

from trialid.effects import CATALOGUE
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship, read_ship
from trialid.simulation.integrate import Simulator, prepare

NAVAL: Final = (
    *("linear_hull", "sway_drag_vav", "sway_drag_var", "sway_drag_rav", "roll_drag_vav"),
    *("roll_drag_var", "roll_drag_rav", "yaw_drag_rar", "yaw_drag_rav", "heel_sway", "heel_yaw"),
    *("heel_roll", "heel_drift", "linear_roll", "still_water_roll_damping"),
    *("quadratic_roll_damping", "righting_arm_cubic", "linear_rudder"),
)
SCALES: Final = {"container": 1.0, "boat": 17.5, "model": 50.0}
"""By how much the container ship is scaled down."""

REFERENCE: Final = SHIP.particulars["L"] / SHIP.particulars["U0"]
"""[s] Time for her own length: the clock of a record goes by it."""

POOL: Final = tuple(
    name
    for name, s in SCENARIOS.items()
    if s.group in ("physics", "sensor")
    and s.effects
    and not name.startswith("surge_")
    and name not in ("clock_drift_r", "propeller_side_force", "shaft_speed_drop", "shaft_thrust")
)
"""What is hidden: what acts on sway, roll and yaw of a ship whose speed and shaft are steady."""

EVERY: Final = (
    *POOL,
    *(n for n, s in TYPICAL.items() if s.group in ("physics", "sensor") and n[:6] != "surge_"),
)
"""The same with all else of the catalogue at its typical size, as a rudder that stalls where no
trial goes: what may act in a manoeuvre beyond the trials."""

SMALLEST, LARGEST = 0.4, 1.6
"""Sizes of what is hidden, as shares of the scenario's own; even in the logarithm."""


@dataclass(frozen=True, kw_only=True)
class Conditions:
    """A ship and how she was logged; times at the scale of the container ship.

    Attributes
    ----------
    minutes, period
        Length of a trial [min], of a sample [s].
    noise
        `waves` in the sensors alone, or `process`: on the hull too.
    held_off
        Share by which hull, rudder and heel terms that are not free are off, drawn evenly.
    """

    ship: str = "container"
    minutes: float = 20.0
    period: float = 0.5
    single: bool = False
    noise: str = "waves"
    held_off: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class World:
    """A true ship, what of her is hidden and known, and the unit of time [s] of the record."""

    conditions: Conditions
    hidden: str
    effects: tuple[Effect, ...]
    known: ShipModel
    true: Simulator
    free: tuple[str, ...]
    unit: float

    @property
    def truth(self) -> dict[str, float]:
        """True value of every free parameter."""
        return {n: self.true.model.value(n) for n in self.free}

    @property
    def step(self) -> float:
        """[s] of the true motion."""
        return min(0.25, self.conditions.period / 2.0) * self.unit

    @property
    def period(self) -> float:
        """[s] of the record."""
        return self.conditions.period * self.unit


def hidden_world(conditions: Conditions, seed: int, pool: Sequence[str] = POOL) -> World:
    """A world with a random effect of the pool hidden at a random size, by its seed."""
    rng = generator(seed, repr(conditions), "hidden")
    every = {**SCENARIOS, **TYPICAL}
    able = [n for n in pool if _fits(conditions, every[n])]
    scenario = every[able[int(rng.integers(len(able)))]]
    size = float(np.exp(rng.uniform(np.log(SMALLEST), np.log(LARGEST))))
    return world(conditions, scenario, size)


def _fits(conditions: Conditions, scenario: Scenario) -> bool:
    """Whether the known ship either lacks all of it or has it as an effect that can be hidden."""
    if conditions.ship != "naval":
        return True
    taken = {p for n in NAVAL for p in CATALOGUE[n].parameters}
    return not any({*e.parameters} & taken or {*e.signals} & {"n"} for e in scenario.effects)


def world(conditions: Conditions, scenario: Scenario, size: float = 1.0) -> World:
    """The true ship with a scenario at a share of its size."""
    known, free = _known(conditions)
    p = known.ship.particulars
    unit = p["L"] / p["U0"] / REFERENCE
    for effect in scenario.effects:
        if effect.name in {e.name for e in known.effects}:
            known = known - effect.name
    true = known
    for effect in scenario.effects:
        true = true + effect
    true = replace(true + CATALOGUE["outer_force"], states=(*known.states, "psi"))
    values = _scaled(scenario, size, known.ship, unit)
    simulator = prepare(true.with_values({**values, "scale_ext": 1.0}), (), OUTPUTS)
    return World(
        conditions=conditions,
        hidden=scenario.name,
        effects=scenario.effects,
        known=known,
        true=simulator,
        free=free,
        unit=unit,
    )


def _scaled(scenario: Scenario, size: float, ship: Ship, unit: float) -> dict[str, float]:
    """Sizes for this ship: what has a length or a time goes with hers."""
    metres = ship.coefficients["GM"] / SHIP.coefficients["GM"]
    by_time = {"tau_r", "tau_phi", "T_r", "T_phi", "tau_delta"}
    by_rate = {"b_r"}
    made = {}
    for n, x in scenario.values.items():
        factor = unit if n in by_time else 1.0 / unit if n in by_rate else 1.0
        made[n] = x * size * (metres if n == "GM3" else factor)
    return made


def _known(conditions: Conditions) -> tuple[ShipModel, tuple[str, ...]]:
    if conditions.ship == "naval":
        ship = read_ship(ROOT / "sample_data/ships/naval.toml")
        effects = tuple(CATALOGUE[n] for n in NAVAL)
        free = ("Yv", "Ydelta", "Nr", "Ndelta", "Kv", "Kp0", "GM", "Nrar")
        return ShipModel(ship, ("v", "p", "r", "phi"), effects), free
    effects = tuple(CATALOGUE[n] for n in EFFECTS)
    return ShipModel(_smaller(SCALES[conditions.ship]), ("u", "v", "p", "r", "phi"), effects), FREE


def _smaller(scale: float) -> Ship:
    """The container ship with her length divided; primed numbers stay."""
    p = SHIP.particulars
    sizes = {n: p[n] / scale for n in ("L", "B", "T")}
    speed = p["U0"] / np.sqrt(scale)
    particulars = {**p, **sizes, "nabla": p["nabla"] / scale**3, "U0": float(speed)}
    c = SHIP.coefficients
    coefficients = {**c, "GM": c["GM"] / scale, "D_P": c["D_P"] / scale}
    return replace(SHIP, particulars=particulars, coefficients=coefficients)


def guessed(world: World, seed: int) -> ShipModel:
    """What a fit begins with: free values up to 15 % off, those held off as the conditions say."""
    rng = generator(seed, repr(world.conditions), "start")
    values = {n: x * (1.0 + rng.uniform(-0.15, 0.15)) for n, x in world.truth.items()}
    share = world.conditions.held_off
    if share:
        every = [n for e in world.known.effects for n in e.parameters if n not in world.free]
        held = [n for n in every if n[0] in "YKN" and world.known.stated(n)]
        values |= {n: world.known.value(n) * (1.0 + rng.uniform(-share, share)) for n in held}
    return world.known.with_values(values)
