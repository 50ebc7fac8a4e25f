"""Several rudders: together they act as the one of `linear_rudder`, each with its share."""

from collections.abc import Iterator, Mapping, Sequence

from trialid.effects.actuators.instances import make_effect, own_name
from trialid.effects.actuators.pushes import lag_of, total
from trialid.maths import Number
from trialid.ship.actuators import Actuator
from trialid.ship.effect import Effect, Force, Parameter
from trialid.ship.particulars import Ship

BK99 = "Blanke & Knudsen (1999), section 4"
SN82 = "Son & Nomoto (1982), container ship S-175"
LINEAR = {"Ydelta": -0.003, "Kdelta": 0.0001, "Ndelta": 0.0015}
DRAG = "Xdd"


def rudder_effects(ship: Ship) -> Iterator[Effect]:
    """Side force and drag of all rudders, and their gear."""
    ones = [one for one in ship.actuators if one.kind == "rudder"]
    if ones:
        yield _side_force(ones)
        yield _drag(ship, ones)
        yield lag_of("rudders", ones, 1.0)


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
