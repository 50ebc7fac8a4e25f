"""What drives a ship on her approach, stopped and astern: the orders of her shafts and thrusters.

A shaft `n` that turns astern pulls by `propeller_thrust` and what `propeller_astern` and
`propeller_astern_advance` say of it; an `[[actuator]]` has a gain of its own astern.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

from trialid.design.helm import Vessel
from trialid.errors import DesignError
from trialid.simulation.reference import evaluator

SHAFTS: Final = ("n", "n_p", "n_s")
"""Inputs that are zero where the engine is stopped."""
PUSHING: Final = ("thruster", "azimuth", "waterjet")
"""Kinds of actuators that drive a ship ahead."""
ABOUT: Final = 0.2
"""Share by which revolutions are other ones: those of the record are better known than the ones a
model holds its speed by. Twelve ships whose held coefficients were off by up to 15 % had models up
to 12 % from their revolutions. Half of it left 93 % of their numbers in their ranges, with it all
were; twice takes the median of a pond's trials at several speeds, a third off, for her own."""
DOUBLINGS: Final = 60
"""Of a thousandth, until an order is found that holds the speed."""


@dataclass(frozen=True)
class Engine:
    """What drives a ship: orders on the approach by the name of the input [SI].

    Attributes
    ----------
    feedback
        By input, the state that follows it where its lag is in the model, else the input itself.
    """

    approach: Mapping[str, float]
    feedback: Mapping[str, str]


def engine_of(ship: Vessel) -> Engine:
    """What drives a ship that is in calm water.

    Raises
    ------
    DesignError
        The model does not simulate the speed, nothing drives her, or no order holds her speed.
    """
    if "u" not in ship.model.states:
        raise DesignError(
            "stop: this model is given its speed and does not simulate it; put u "
            "among its states, with effects such as propeller_thrust and surge_resistance"
        )
    inputs = ship.simulator.equations.inputs
    shafts = [n for n in SHAFTS if n in inputs]
    driven = [a for a in ship.model.ship.actuators if a.kind in PUSHING]
    feedback = {n: a.drive for a in driven for n in (a.drive, f"{a.drive}_order") if n in inputs}
    if shafts and not feedback:
        return Engine({n: ship.constants[n] for n in shafts}, {n: n for n in shafts})
    if not feedback:
        raise DesignError(
            f"stop: no effect of this model reads a shaft's speed ({', '.join(SHAFTS)}) or a "
            "thruster, so there is nothing to stop; add propeller_thrust"
        )
    if shafts or len({a.command for a in driven}) > 1:
        raise DesignError(
            f"stop: {', '.join([*shafts, *feedback])} are not driven by one kind of order; give "
            "the orders of each as a CSV"
        )
    order = _holding(ship, feedback)
    return Engine(dict.fromkeys(feedback, order), feedback)


def astern_orders(ship: Vessel, engine: Engine) -> dict[str, float]:
    """As fast astern as ahead on the approach, by input.

    Raises
    ------
    DesignError
        The model does not know what pushes her astern.
    """
    back = {n: -x for n, x in engine.approach.items()}
    if not _push(ship, engine.feedback, back) < _push(
        ship, engine.feedback, dict.fromkeys(back, 0.0)
    ):
        raise DesignError(
            f"stop astern: no push astern comes from {', '.join(back)} in this model, it is zero "
            "or has the wrong sign: free its gain astern, with a trial that holds it astern"
        )
    return back


def _push(ship: Vessel, feedback: Mapping[str, str], orders: Mapping[str, float]) -> float:
    """du/dt [m/s^2] on a straight course at the approach speed under these orders."""
    eq = ship.simulator.equations
    known = {**dict.fromkeys((*eq.states, *eq.inputs), 0.0), **ship.constants}
    known |= {n: ship.model.value(n) for n in eq.parameters}
    known |= {"u": ship.model.ship.particulars["U0"], **orders}
    known |= {feedback[n]: x for n, x in orders.items()}
    symbols = (*eq.states, *eq.inputs, *eq.parameters)
    run = evaluator([eq.f[eq.states.index("u")]], symbols, scalar=True)
    return float(run([float(known[s]) for s in symbols])[0])


def _holding(ship: Vessel, feedback: Mapping[str, str]) -> float:
    """The order, the same to each, under which she keeps her approach speed."""

    def rate(order: float) -> float:
        return _push(ship, feedback, dict.fromkeys(feedback, order))

    order = holding_order(rate)
    if order is None:
        raise DesignError(
            f"stop: no order of {', '.join(feedback)} holds the approach speed of "
            f"{ship.model.ship.particulars['U0']:g} m/s in this model; give the orders as a CSV"
        )
    return order


def at_her_speed(ship: Vessel, calm: Vessel) -> Vessel:
    """A ship at the revolutions that hold her approach speed in calm water.

    As she is where hers hold it about, her model is given its speed or reads no shaft: the median
    of a trial at other speeds would have her slow down or speed up all through a manoeuvre.
    """
    shafts: list[str] = [n for n in SHAFTS if n in calm.simulator.equations.inputs]
    if "u" not in calm.model.states or not shafts:
        return ship
    same = dict[str, str](zip(shafts, shafts, strict=True))
    order = holding_order(lambda x: _push(calm, same, dict.fromkeys(shafts, x)))
    if order is None or all(abs(ship.constants[n] - order) <= ABOUT * order for n in shafts):
        return ship
    return replace(ship, constants={**ship.constants, **dict.fromkeys(shafts, order)})


def holding_order(rate: Callable[[float], float]) -> float | None:
    """The order that holds a speed, of du/dt [m/s^2] by the order; None where none does."""
    from scipy.optimize import brentq  # a quarter of a second, for stops alone

    most = next((1e-3 * 2.0**k for k in range(DOUBLINGS) if rate(1e-3 * 2.0**k) > 0.0), None)
    return None if most is None or rate(0.0) >= 0.0 else float(brentq(rate, 0.0, most))
