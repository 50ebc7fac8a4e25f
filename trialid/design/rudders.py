"""What is told to a ship's rudders, one or several that move as one, and what each does of it."""

import itertools
import math
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.ship.actuators import Actuator
from trialid.ship.model import ShipModel

GEAR_STATE: Final = "delta"
"""The state a steering gear among the effects adds; without one the gear here is used."""


def steering_angles(model: ShipModel) -> tuple[str, ...]:
    """Signals that say where the rudders stand, that of a ship which has one first."""
    return (GEAR_STATE, *(one.name for one in _rudders(model)))


def steering_orders(model: ShipModel) -> tuple[str, ...]:
    """Signals that say what the rudders are told; several move as one."""
    return ("delta_order", *(f"{one.name}_order" for one in _rudders(model)))


def steered_signals(model: ShipModel) -> frozenset[str]:
    """Angles and orders of all rudders that a model may have."""
    return frozenset((*steering_angles(model), *steering_orders(model)))


def steering_gears(model: ShipModel, rate: float) -> dict[str, float]:
    """How fast each rudder goes over [rad/s] that no gear in the model moves."""
    own = {one.name: min(one.rate, rate) for one in _rudders(model)}
    return {n: r for n, r in {GEAR_STATE: rate, **own}.items() if n not in model.all_states}


def amidships(model: ShipModel, samples: int) -> dict[str, Vector]:
    """Every rudder amidships, as ordered and as it stands; (N,) each."""
    return {n: np.zeros(samples) for n in sorted(steered_signals(model))}


def steering_courses(
    model: ShipModel, orders: Vector, rate: float, period: float, finer: int = 1
) -> dict[str, Vector]:
    """What every rudder is told and does; (N,) each.

    Parameters
    ----------
    orders
        From amidships [rad], `finer` times as many as samples of this period; (finer N,).
    rate
        What the steering gear does [rad/s]; a rudder may be slower.
    """
    given = dict.fromkeys(steering_orders(model), orders[::finer])
    for name, own in steering_gears(model, rate).items():
        given[name] = ramp(orders, own * period / finer)[::finer]
    return given


def _rudders(model: ShipModel) -> list[Actuator]:
    return [one for one in model.ship.actuators if one.kind == "rudder"]


def ramp(orders: Vector, step: float) -> Vector:
    """A rudder that follows its orders by at most `step` a sample, from amidships; (n,).

    >>> ramp(np.array([0.0, 3.0, 3.0, 3.0, -1.0]), 2.0).tolist()
    [0.0, 0.0, 2.0, 3.0, 3.0]
    """
    followed = np.empty(len(orders))
    edges = np.flatnonzero(np.diff(orders)) + 1
    angle = 0.0
    for begin, end in itertools.pairwise([0, *edges.tolist(), len(orders)]):
        order = float(orders[begin])
        moved = step * np.arange(end - begin + 1)  # an order acts from the next sample on
        on_the_way = angle + math.copysign(1.0, order - angle) * moved
        path = np.where(moved < abs(order - angle), on_the_way, order)
        followed[begin:end] = path[:-1]
        angle = float(path[-1])
    return followed
