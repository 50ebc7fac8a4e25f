"""The prime system: forces over 1/2 rho L^2 U^2, lengths over L, speeds over U; one table.

SNAME (1950) without a prime on the draught: m' = m / (1/2 rho L^3), r' = r L / U.
"""

from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from typing import Final

from trialid.errors import EffectError, ShipError
from trialid.maths import Number
from trialid.names.quantities import PARTICULARS, QUANTITIES
from trialid.ship.actuators import rudder_signals
from trialid.ship.effect import Effect, Force, Steered
from trialid.ship.particulars import Ship

FORCE_LENGTH: Final = {"X": 2, "Y": 2, "K": 3, "N": 3}
"""Power of L in the scale 1/2 rho L^k U^2 of a force or moment."""

MASS_LENGTH: Final = {
    "m": 3, "I_xx": 5, "I_zz": 5,
    "Xudot": 3, "Yvdot": 3, "Ypdot": 4, "Yrdot": 4,
    "Kvdot": 4, "Kpdot": 5, "Krdot": 5, "Nvdot": 4, "Npdot": 5, "Nrdot": 5,
}  # fmt: skip
"""Power of L in the scale 1/2 rho L^k of a mass, an inertia or an added mass."""

ARMS: Final = ("x_G", "z_G")
"""Lengths among the mass parameters: their scale is L."""

UNIT_POWERS: Final = {
    "1": (0, 0), "rad": (0, 0), "m": (1, 0), "s": (1, -1), "m/s": (0, 1),
    "1/s": (-1, 1), "rad/s": (-1, 1), "1/m": (-1, 0),
}  # fmt: skip
"""Unit of a parameter to the powers of L and U that make it primed."""


def power(base: Number, exponent: int) -> Number:
    """A whole power, negative ones as a quotient.

    >>> power(2.0, -2)
    0.25
    """
    if exponent == 0:
        return 1.0
    return base**exponent if exponent > 0 else 1.0 / base**-exponent


def scale(length: int, speed: int, L: Number, U: Number) -> Number:
    """The prime scale L^length U^speed."""
    return power(L, length) * power(U, speed)


def prime_signal(name: str, value: Number, L: Number, U: Number) -> Number:
    """A signal or particular in the prime system; density becomes 2 because forces have a 1/2.

    >>> prime_signal("r", 0.01, 175.0, 7.0)
    0.25
    """
    if name == "rho":
        return 2.0
    quantity = QUANTITIES.get(name)  # none: the angle of an actuator, or one's own signal
    if quantity is None or quantity.length == quantity.speed == 0:
        return value
    return value * scale(-quantity.length, -quantity.speed, L, U)


def prime_parameter(effect: Effect, name: str, value: Number, L: Number, U: Number) -> Number:
    """A parameter as a primed effect wants it: one with a unit is divided by its scale."""
    unit = effect.parameters[name].unit
    if unit not in UNIT_POWERS:
        known = ", ".join(UNIT_POWERS)
        raise EffectError(
            f"effect {effect.name!r}: parameter {name!r} has unit {unit!r}; a primed effect can "
            f'use {known}; declare the effect with system="SI" for other units'
        )
    length, speed = UNIT_POWERS[unit]
    return value if length == speed == 0 else value * scale(-length, -speed, L, U)


def mass_scale(name: str, L: float, rho: float) -> float:
    """What to multiply a primed mass parameter by to have it in SI."""
    return L if name in ARMS else 0.5 * rho * L ** MASS_LENGTH[name]


def primed_coefficient(ship: Ship, effect: Effect, name: str) -> float:
    """A coefficient of the ship file in the prime system and with this project's rudder sign.

    The scale is read off the effect itself, by calling it with dimensional and with primed signals,
    and so is the sign: a term odd in delta changes sign when the source counts delta to port.
    """
    value = ship.coefficients[name]
    rudders = {"delta", *rudder_signals(ship.actuators)}
    if effect.system == "SI" or effect.parameters[name].unit != "1":
        steers = bool(rudders & {*effect.acts_on(Steered)})
        return -value if ship.rudder_positive == "port" and steers else value
    if ship.system == "dimensional":
        value *= _dimensional_ratio(ship, effect, name)
    if ship.rudder_positive == "port" and rudders & {*effect.signals}:
        value *= _rudder_parity(effect, name, rudders)
    return value


def _probe(effect: Effect, name: str, signals: Mapping[str, float]) -> Force:
    """What one unit of a parameter adds to the forces."""
    [with_it] = effect({**signals, **effect.nulls, name: 1.0})
    [without] = effect({**signals, **effect.nulls})
    return Force(*(a - b for a, b in zip(with_it, without, strict=True)))


def _some_signals(ship: Ship, effect: Effect) -> dict[str, float]:
    U = ship.coefficient_speed
    known = {"u": U, "U": U, **{n: x for n, x in ship.particulars.items() if n in PARTICULARS}}
    return {s: known.get(s, 0.1) for s in effect.signals}


def _dimensional_ratio(ship: Ship, effect: Effect, name: str) -> float:
    L, rho, U = ship.particulars["L"], ship.particulars["rho"], ship.coefficient_speed
    signals = _some_signals(ship, effect)
    primed = {s: prime_signal(s, x, L, U) for s, x in signals.items()}
    dimensional, prime = _probe(effect, name, signals), _probe(effect, name, primed)
    ratios = {
        float(a / (0.5 * rho * L ** FORCE_LENGTH[row] * U**2 * b))
        for row, a, b in zip(Force._fields, dimensional, prime, strict=True)
        if b != 0.0
    }
    if len(ratios) != 1:
        raise ShipError(
            f"ship {ship.name!r}: coefficient {name!r} acts on several equations with different "
            "scales; give it primed"
        )
    return ratios.pop()


def _rudder_parity(effect: Effect, name: str, rudders: AbstractSet[str]) -> float:
    signals = dict.fromkeys(effect.signals, 0.1)
    here = _probe(effect, name, signals)
    there = _probe(effect, name, {n: -x if n in rudders else x for n, x in signals.items()})
    if there == Force(*(-a for a in here)):
        return -1.0
    if there == here:
        return 1.0
    raise ShipError(
        f"coefficient {name!r} of effect {effect.name!r} is neither odd nor even in delta; its "
        'ship file has rudder_positive = "port": convert it to "starboard" by hand'
    )
