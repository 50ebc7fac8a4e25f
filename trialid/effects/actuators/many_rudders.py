"""Several rudders: together they act as the one of `linear_rudder`, each with its share.

Behind a screw a rudder also has the race of it, which is there when the ship lies still.
"""

from collections.abc import Iterator, Mapping, Sequence

from trialid.effects.actuators.instances import GAIN_UNITS, make_effect, own_name, typical_gain
from trialid.effects.actuators.push_kinds import Driven, Push, thrust
from trialid.effects.actuators.pushes import lag_of, total, turned
from trialid.maths import Number, cos, sin
from trialid.ship.actuators import Actuator
from trialid.ship.effect import Effect, Force, Parameter
from trialid.ship.particulars import Ship

BK99 = "Blanke & Knudsen (1999), section 4"
SN82 = "Son & Nomoto (1982), container ship S-175"
LINEAR = {"Ydelta": -0.003, "Kdelta": 0.0001, "Ndelta": 0.0015}
DRAG = "Xdd"
RACE = "k_race"


def rudder_effects(ship: Ship) -> Iterator[Effect]:
    """Side force and drag of all rudders, and their gear."""
    ones = [one for one in ship.actuators if one.kind == "rudder"]
    if ones:
        yield _side_force(ones)
        yield _drag(ship, ones)
        yield lag_of("rudders", ones, 1.0)
    if behind := [one for one in ones if one.behind]:
        yield _race(ship, behind)


def _share(one: Actuator, ones: Sequence[Actuator]) -> float:
    """Its share of a shared coefficient, which is of all together; all of its own."""
    return 1.0 if one.own else 1.0 / sum(not other.own for other in ones)


def _side_force(ones: Sequence[Actuator]) -> Effect:
    def rudders(**values: Number) -> Force:
        forces = []
        for one in ones:
            delta = values[one.name] * _share(one, ones)
            Y, K, N = (values[own_name(n, one)] * delta for n in LINEAR)
            side = -1.0 if one.x > 0.0 else 1.0  # ahead it pushes to where it turns the ship
            forces.append(Force(Y=side * Y, K=side * K, N=N))
        return total(forces)

    return make_effect(
        rudders,
        name="rudders",
        equation="Y, K, N = Ydelta, Kdelta, Ndelta times the mean angle: all rudders together",
        source=BK99,
        signals=[one.name for one in ones],
        parameters={own_name(n, one): Parameter(x) for one in ones for n, x in LINEAR.items()},
        system="prime",
    )


def _drag(ship: Ship, ones: Sequence[Actuator]) -> Effect:
    L = ship.particulars["L"]

    def drag(**values: Number) -> Force:
        forces = []
        for one in ones:
            X = values[own_name(DRAG, one)] * _share(one, ones) * values[one.name] ** 2
            forces.append(Force(X=X, N=-one.y / L * X))
        return total(forces)

    parameters: Mapping[str, Parameter] = {
        own_name(DRAG, one): Parameter(-0.002, low=-0.05, high=0.0) for one in ones
    }
    return make_effect(
        drag,
        name="rudders_drag",
        equation="X = Xdd delta^2, N = -y X: resistance of each rudder, at its place",
        source=SN82,
        signals=[one.name for one in ones],
        parameters=parameters,
        system="prime",
    )


def _race(ship: Ship, ones: Sequence[Actuator]) -> Effect:
    """The part of u_R^2 that a screw running ahead adds; one running astern adds none."""
    screws = {one.name: one for one in ship.actuators}

    def race(**values: Number) -> Force:
        forces = []
        for one in ones:
            screw, delta = screws[one.behind], values[one.name]
            by = Driven(screw.command, values[screw.name], 0.0, 0.0)
            normal = thrust(by, values[own_name(RACE, one)], 0.0) * sin(delta)
            forces.append(turned(one, Push(-normal * sin(delta), -normal * cos(delta))))
        return total(forces)

    parameters: Mapping[str, Parameter] = {
        own_name(RACE, one): Parameter(
            typical_gain(ship, screws[one.behind].command),
            GAIN_UNITS[screws[one.behind].command],
            low=0.0,
        )
        for one in ones
    }
    return make_effect(
        race,
        name="rudders_race",
        equation="F_N = k_race n^2 sin(delta), n ahead: each rudder in the race of its own screw",
        source=f"{SN82}: u_R^2 = u_P^2 + 8 k_R K_T (n D_P)^2 / pi, its second part",
        signals=[s for one in ones for s in (one.name, one.behind)],
        parameters=parameters,
    )
