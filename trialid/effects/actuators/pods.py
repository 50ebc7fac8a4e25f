"""What pods do beside pushing to where they point: struts, thrust lost to speed and to races."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from trialid.effects.actuators.instances import (
    GAIN_UNITS,
    NOWHERE,
    advance_gain,
    make_effect,
    own_name,
    typical_gain,
)
from trialid.effects.actuators.push_kinds import F11, Push
from trialid.effects.actuators.pushes import total, turned
from trialid.maths import Number, cos, sin, sqrt
from trialid.ship.actuators import Actuator
from trialid.ship.effect import Effect, Force, Parameter
from trialid.ship.particulars import Ship

YY15 = "Yasukawa & Yoshimura (2015), MMG: F_N of a foil, here of a strut in undisturbed flow"
DANG = "Dang & Laheij (2004), MTS DP Conference: width of a race; a round jet slows with 1 / x"
STRUTS: Final = 0.02
"""Area of all struts over L^2 / 20, as of a rudder: only where a search starts."""
SLOPE: Final = 2.5
"""Of a strut's lift by its angle, of an aspect ratio about 1.5: likewise."""
LOST: Final = 0.3
"""Share of thrust that a pod in the race of another has lost at usual distances of 4 to 12
propeller diameters, 0.3 to 0.57 by the same source: likewise, and for the width."""
WIDTH: Final = 130.0 * math.radians(1.0) ** 3 / (1.0 - LOST) ** 3
"""Cube of the angle off the race's axis [rad] at which half of the loss is left, 7 deg."""


def pod_effects(ship: Ship) -> Iterator[Effect]:
    """Struts of all pods; races of pods and fixed screws that one kind of command drives."""
    pods = [one for one in ship.actuators if one.kind == "azimuth"]
    if pods:
        yield _struts(ship, pods)
        yield _advance(ship, pods)
    if len({one.command for one in pods}) == 1:
        screws = [one for one in ship.actuators if one.kind == "thruster"]
        blow = [*pods, *(one for one in screws if one.command == pods[0].command)]
        if len(blow) > 1:
            yield _races(ship, pods, blow)


def _struts(ship: Ship, pods: Sequence[Actuator]) -> Effect:
    def strut(**values: Number) -> Force:
        forces = []
        for one in pods:
            along, aside = _flow(one, values)
            normal = -values[own_name("k_strut", one)] * aside
            normal *= sqrt(along * along + aside * aside + NOWHERE)
            angle = values[one.angle]
            forces.append(turned(one, Push(-normal * sin(angle), normal * cos(angle))))
        return total(forces)

    L, rho = ship.particulars["L"], ship.particulars["rho"]
    size = 0.5 * rho * SLOPE * STRUTS * L * L / 20.0 / len(pods)
    return make_effect(
        strut,
        name="azimuths_strut",
        equation="F_N = -k_strut U_P v_P, v_P the flow across a pod: lift and drag of its strut",
        source=YY15,
        signals=[*(one.angle for one in pods), "u", "v", "r"],
        parameters={own_name("k_strut", one): Parameter(size, "kg/m", low=0.0) for one in pods},
    )


def _flow(one: Actuator, values: dict[str, Number]) -> tuple[Number, Number]:
    """Speed of a pod through the water along and across its strut, as the ship carries it."""
    u = values["u"] - one.y * values["r"]
    v = values["v"] + one.x * values["r"]
    angle = values[one.angle] + one.direction
    return u * cos(angle) + v * sin(angle), v * cos(angle) - u * sin(angle)


def _advance(ship: Ship, pods: Sequence[Actuator]) -> Effect:
    def advance(**values: Number) -> Force:
        forces = []
        for one in pods:
            lost = values[own_name("k_pod_advance", one)] * abs(values[one.drive])
            lost *= _flow(one, values)[0]
            angle = values[one.angle]
            forces.append(turned(one, Push(-lost * cos(angle), -lost * sin(angle))))
        return total(forces)

    return make_effect(
        advance,
        name="azimuths_advance",
        equation="T = -k_pod_advance |n| U_P, U_P the flow along a pod: thrust lost to the speed",
        source=F11,
        signals=[*(s for one in pods for s in one.signals), "u", "v", "r"],
        parameters={own_name("k_pod_advance", one): advance_gain(ship, one) for one in pods},
    )


def _races(ship: Ship, pods: Sequence[Actuator], blow: Sequence[Actuator]) -> Effect:
    pairs = [(one, other) for one in pods for other in blow if one is not other]
    nearest = min(_apart(one, other) for one, other in pairs)

    def race(**values: Number) -> Force:
        forces = []
        for one, other in pairs:
            hit = _hit(one, other, values) * nearest / _apart(one, other)
            lost = values[own_name("k_lost", one)] * hit * _turns(one, values)
            angle = values[one.angle]
            forces.append(turned(one, Push(-lost * cos(angle), -lost * sin(angle))))
        return total(forces)

    size = LOST * typical_gain(ship, pods[0].command)
    unit = GAIN_UNITS[pods[0].command]
    return make_effect(
        race,
        name="azimuths_race",
        equation="T = -k_lost n n_other where the race of another meets a pod: thrust it loses",
        source=DANG,
        signals=[s for one in blow for s in one.signals],
        parameters={own_name("k_lost", one): Parameter(size, unit, low=0.0) for one in pods},
    )


def _apart(one: Actuator, other: Actuator) -> float:
    """Distance of two [m]; those at one place are a millimetre apart."""
    return max(math.hypot(one.x - other.x, one.y - other.y), 1e-3)


def _turns(one: Actuator, values: dict[str, Number]) -> Number:
    """What a race is as fast as: revolutions, or the root of a stated thrust, with its sign."""
    drive = values[one.drive]
    return drive / sqrt(abs(drive) + NOWHERE) if one.command == "thrust" else drive


def _hit(one: Actuator, other: Actuator, values: dict[str, Number]) -> Number:
    """The other's revolutions as far as its race, behind its push, goes to this one."""
    turned_by = values[other.angle] if other.angle else 0.0
    angle, n = turned_by + other.direction, _turns(other, values)
    towards = (cos(angle) * (one.x - other.x) + sin(angle) * (one.y - other.y)) / _apart(one, other)
    ahead, astern = 0.5 * (abs(n) + n), 0.5 * (abs(n) - n)
    return ahead * _inside(-towards) + astern * _inside(towards)


def _inside(cosine: Number) -> Number:
    """Share of the loss that is left at this cosine of the angle off the axis of a race."""
    square = 2.0 * (1.0 - cosine)  # of the angle, where it is small
    return 1.0 / (1.0 + square * sqrt(abs(square) + NOWHERE) / WIDTH)
