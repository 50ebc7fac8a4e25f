"""What a ship's actuators do to her: each kind an effect that loops over its instances."""

import math
from collections.abc import Iterator, Mapping, Sequence

from trialid.effects.actuators.instances import (
    GAIN_UNITS,
    advance_gain,
    make_effect,
    own_name,
    typical_drive,
    typical_gain,
)
from trialid.effects.actuators.push_kinds import F11, PUSHES, Driven, Push, PushKind, thrust
from trialid.maths import Number, clip
from trialid.ship.actuators import COMMANDS, Actuator
from trialid.ship.effect import Effect, Force, Parameter, Rate, Steered
from trialid.ship.particulars import Ship

TRIED = tuple(2.0 * 0.87**i for i in range(16))
"""Largest drives tried, over the stated or the usual one, of which nobody knows more: from twice to
a quarter of it, so near each other that one is within 7 % of what is true. Half as many missed a
drive that gave out at 0.77 of full."""
M22 = "Miyauchi et al. (2022), J. Mar. Sci. Technol. 27: Y and N lose a share of their own with Fr"
DEAD = 0.1
"""Share of full that dead bands of motors go to: with no order below it a band is another gain."""
WIDEST = 2.0 * DEAD
"""Share of full that a fitted band may come to: at half of it bands of real motors lie at its end,
at twice it a boat that only held her place had one of 0.38 named, which she had not."""
EXACT = 12
"""Digits of a cosine: that of 90 deg is zero."""


def push_effects(ship: Ship) -> Iterator[Effect]:
    """Thrust of each kind she has; lag and dead band; thrust lost to the speed."""
    for kind, push in PUSHES.items():
        ones = [one for one in ship.actuators if one.kind == kind]
        if ones:
            yield _pushes(ship, push, ones)
            yield lag_of(push.effect, ones, 0.5)
            if len({one.command for one in ones}) == 1:  # else they have no band in common
                yield _deadband(ship, push.effect, ones)
                yield _saturation(ship, push.effect, ones)
        if {one.command for one in ones} == {"share"} and not push.shapes:
            yield _linear(ship, push, ones)
        if ones and kind == "thruster":
            yield _advance(ship, ones)
        if ones and kind == "tunnel":
            yield _on_the_hull(ship, ones)


def turned(one: Actuator, push: Push) -> Force:
    """Force and moment on the ship of a push along the actuator's direction, from its place."""
    ahead, aside = (round(f(one.direction), EXACT) for f in (math.cos, math.sin))
    X = push.along * ahead - push.aside * aside
    Y = push.along * aside + push.aside * ahead
    return Force(X=X, Y=Y, N=one.x * Y - one.y * X)


def driven(one: Actuator, values: Mapping[str, Number]) -> Driven:
    """What drives one of a ship's actuators, from values by name."""
    angle = values[one.angle] if one.angle else 0.0
    return Driven(one.command, values[one.drive], angle, values.get("u", 0.0))


def total(forces: Sequence[Force]) -> Force:
    """The sum of forces."""
    X, Y, K, N = (sum(row[1:], start=row[0]) for row in zip(*forces, strict=True))
    return Force(X, Y, K, N)


def _pushes(ship: Ship, kind: PushKind, ones: Sequence[Actuator]) -> Effect:
    names = (*kind.gains, *kind.shapes)

    def push(**values: Number) -> Force:
        forces = []
        for one in ones:
            p = {n: values[own_name(n, one)] for n in names}
            forces.append(turned(one, kind.force(driven(one, values), p)))
        return total(forces)

    parameters = {
        own_name(n, one): kind.shapes.get(n)
        or Parameter(typical_gain(ship, one.command), GAIN_UNITS[one.command], low=0.0)
        for one in ones
        for n in names
    }
    return make_effect(
        push,
        name=kind.effect,
        equation=kind.equation,
        source=kind.source,
        signals=[*(s for one in ones for s in one.signals), *kind.reads],
        parameters=parameters,
    )


def lag_of(kind: str, ones: Sequence[Actuator], typical: float) -> Effect:
    """Each follows its order: the signal becomes a state that starts where its order starts."""
    follows = {one.name: f"{one.name}_order" for one in ones}

    def lag(**values: Number) -> Rate:
        T = values[f"T_{kind}"]
        return Rate(**{n: (values[order] - values[n]) / T for n, order in follows.items()})

    return make_effect(
        lag,
        name=f"{kind}_lag",
        equation=f"d(n)/dt = (n_order - n) / T_{kind}: {kind} follow their orders late",
        source=F11,
        signals=[*follows, *follows.values()],
        parameters={
            f"T_{kind}": Parameter(typical, "s", low=0.05, high=60.0, scan=(0.2, 1.0, 4.0)),
        },
        states=follows,
    )


def _deadband(ship: Ship, kind: str, ones: Sequence[Actuator]) -> Effect:
    def deadband(**values: Number) -> Steered:
        return Steered(
            **{one.name: -clip(values[one.name], values[f"dead_{kind}"]) for one in ones}
        )

    command = ones[0].command
    unit, size = COMMANDS[command], typical_drive(ship, command)
    return make_effect(
        deadband,
        name=f"{kind}_deadband",
        equation=f"n = n - clip(n, dead_{kind}): small orders do nothing, large ones act less",
        source="speed controllers of small motors: 2 to 10 % of full",
        signals=[one.name for one in ones],
        parameters={f"dead_{kind}": Parameter(0.05 * size, unit, low=0.0, high=WIDEST * size)},
        within={one.name: DEAD for one in ones},
    )


def _saturation(ship: Ship, kind: str, ones: Sequence[Actuator]) -> Effect:
    full = f"n_full_{kind}"

    def saturation(**values: Number) -> Steered:
        return Steered(
            **{one.name: clip(values[one.name], values[full]) - values[one.name] for one in ones}
        )

    command = ones[0].command
    stated = [one.limit for one in ones if math.isfinite(one.limit)]
    size = min(stated, default=typical_drive(ship, command))
    tried = tuple(share * size for share in TRIED)
    return make_effect(
        saturation,
        name=f"{kind}_saturation",
        equation=f"n = clip(n, {full}): no more comes of an order than the drive can",
        source=F11,
        signals=[one.name for one in ones],
        parameters={
            full: Parameter(0.5 * size, COMMANDS[command], low=0.05 * size, null=None, scan=tried)
        },
    )


def _linear(ship: Ship, kind: PushKind, ones: Sequence[Actuator]) -> Effect:
    """What thrust has in proportion to a share of full, that is no share of full revolutions.

    A motor's voltage is not: the propeller's torque takes of it with the square of its revolutions,
    so that thrust goes with a power of it between the first and the second.
    """

    def linear(**values: Number) -> Force:
        forces = []
        for one in ones:
            gain = values[own_name(f"k_linear_{kind.effect}", one)]
            by = driven(one, values)._replace(command="thrust")
            forces.append(turned(one, kind.force(by, dict.fromkeys(kind.gains, gain))))
        return total(forces)

    gain = Parameter(typical_gain(ship, "share"), GAIN_UNITS["share"], low=0.0)
    return make_effect(
        linear,
        name=f"{kind.effect}_linear",
        equation=f"T = k_linear_{kind.effect} n: thrust in proportion to the share of full",
        source=F11,
        signals=[s for one in ones for s in one.signals],
        parameters={own_name(f"k_linear_{kind.effect}", one): gain for one in ones},
    )


def _advance(ship: Ship, ones: Sequence[Actuator]) -> Effect:
    """Thrust that falls as the water comes faster; the wake is in the coefficient."""

    def advance(u: Number, **values: Number) -> Force:
        forces = []
        for one in ones:
            along = u * round(math.cos(one.direction), EXACT)
            lost = values[own_name("k_advance", one)] * abs(values[one.name]) * along
            forces.append(turned(one, Push(-lost)))
        return total(forces)

    return make_effect(
        advance,
        name="thrusters_advance",
        equation="T = -k_advance |n| u: thrust that falls with the speed ahead, wake included",
        source=F11,
        signals=[*(one.name for one in ones), "u"],
        parameters={own_name("k_advance", one): advance_gain(ship, one) for one in ones},
    )


def _on_the_hull(ship: Ship, ones: Sequence[Actuator]) -> Effect:
    """What a tunnel's jet, bent along the side, does beside fading: the force loses the more."""
    full = math.sqrt(ship.particulars["g"] * ship.particulars["L"])

    def hull(u: Number, **values: Number) -> Force:
        forces = []
        for one in ones:
            jet = thrust(Driven(one.command, values[one.name], 0.0, u), 1.0, 1.0) * abs(u) / full
            side = turned(one, Push(values[own_name("aY_tunnel", one)] * jet))
            forces.append(Force(X=side.X, Y=side.Y))
        return total(forces)

    gains = {one: (typical_gain(ship, one.command), GAIN_UNITS[one.command]) for one in ones}
    parameters = {
        own_name("aY_tunnel", one): Parameter(-x, unit) for one, (x, unit) in gains.items()
    }
    return make_effect(
        hull,
        name="tunnels_hull",
        equation="Y = aY_tunnel n |n| Fr: force that a tunnel's jet takes off the hull, not moment",
        source=M22,
        signals=[*(one.name for one in ones), "u"],
        parameters=parameters,
    )
