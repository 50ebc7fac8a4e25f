"""What the effects of a ship's actuators share: names, typical sizes, and how one is made."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from trialid.ship.actuators import Actuator, Command
from trialid.ship.effect import FORMS, Effect, Parameter, System
from trialid.ship.particulars import Ship

DIAMETER: Final = 0.07
"""Of a propeller over the length of a boat, 0.04 to 0.1: only where a search starts."""
K_T: Final = 0.4
"""Thrust coefficient at rest; its slope with the advance ratio is about the same."""
FULL: Final = 0.01
"""Full thrust over 1/2 rho L^2 U^2, as a boat needs it at her speed."""
FROUDE: Final = 0.3
"""Of a boat whose speed nobody states."""
NOWHERE: Final = 1e-9
"""Keeps the slope of a root finite where what is under it vanishes."""
GAIN_UNITS: Final = {"revolutions": "N s^2", "share": "N", "thrust": "1"}
"""Unit of a gain of thrust, by what drives the actuator."""
ADVANCE_UNITS: Final = {"revolutions": "N s^2/m", "share": "N s/m", "thrust": "s/m"}
"""Unit of what is lost of it to the speed."""


def own_name(parameter: str, one: Actuator) -> str:
    """A parameter as this actuator calls it: with its own name where it has its own.

    >>> own_name("k_ahead", Actuator(name="left", kind="thruster", x=0.0, y=-1.0, own=True))
    'k_ahead_left'
    """
    return f"{parameter}_{one.name}" if one.own else parameter


def usual_speed(ship: Ship) -> float:
    """Speed of this ship, or of a boat of her length [m/s]."""
    p = ship.particulars
    return max(p["U0"], FROUDE * math.sqrt(p["g"] * p["L"]))


def typical_gain(ship: Ship, command: Command) -> float:
    """Gain of thrust of a propeller that fits the ship: where a search starts."""
    L, rho = ship.particulars["L"], ship.particulars["rho"]
    return {
        "revolutions": K_T * rho * (DIAMETER * L) ** 4 / (2.0 * math.pi) ** 2,
        "share": FULL * 0.5 * rho * L * L * usual_speed(ship) ** 2,
        "thrust": 1.0,
    }[command]


def typical_drive(ship: Ship, command: Command) -> float:
    """What drives an actuator that holds the ship's speed: revolutions [rad/s], share, newton."""
    full = typical_gain(ship, "share")
    revolutions = math.sqrt(full / typical_gain(ship, "revolutions"))
    return {"revolutions": revolutions, "share": 1.0, "thrust": full}[command]


def advance_gain(ship: Ship, one: Actuator) -> Parameter:
    """What is lost of its thrust to the speed, over the drive and the speed: half at her speed."""
    half = 0.5 * typical_gain(ship, one.command) / usual_speed(ship)
    half *= typical_drive(ship, one.command) if one.command == "revolutions" else 1.0
    return Parameter(half, ADVANCE_UNITS[one.command], low=0.0)


def make_effect(
    function: Callable[..., Any],
    *,
    name: str,
    equation: str,
    source: str,
    signals: Sequence[str],
    parameters: Mapping[str, Parameter],
    states: Mapping[str, str | None] | None = None,
    system: System = "SI",
    within: Mapping[str, float] | None = None,
) -> Effect:
    """An effect of a ship's own actuators: its function takes any signals by their names."""
    function.__name__, function.__doc__ = name, equation
    values = dict.fromkeys(signals, 0.1) | {n: p.start for n, p in parameters.items()}
    result = function(**values)
    parts = (result,) if isinstance(result, FORMS) else tuple(result)
    return Effect(
        name=name,
        function=function,
        signals=tuple(dict.fromkeys(signals)),
        parameters=dict(parameters),
        states=dict(states or {}),
        forms=tuple(type(part) for part in parts),
        system=system,
        source=source,
        within=dict(within or {}),
    )
