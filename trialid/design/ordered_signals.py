"""What designed tests order of the ship, and whether it is reached."""

from collections.abc import Sequence

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage
from trialid.names.quantities import SIGNALS, Quantity
from trialid.ship.actuators import actuator_quantities

RUDDER = ("delta_order", "delta")


def ordered_signals(passages: Sequence[Passage]) -> dict[str, Quantity]:
    """What is ordered in some tests, and what follows it, by the signal's name."""
    found: dict[str, Quantity] = {}
    if not all(passage.driven for passage in passages) or not passages:
        found |= {n: SIGNALS[n] for n in RUDDER}
    for passage in passages:
        found |= actuator_quantities(passage.driven)
    return found


def late_orders(passage: Passage) -> list[str]:
    """Orders that are not reached before the next: it is tested, and not as written."""
    names = {"rudder": RUDDER}
    if passage.driven:
        names = {one.name: (f"{one.name}_order", one.name) for one in passage.driven}
    signals = passage.trial.signals
    return [
        words
        for name, (order, followed) in names.items()
        for words in _late(name, signals[order], signals[followed])
    ]


def _late(name: str, orders: Vector, followed: Vector) -> list[str]:
    last = np.flatnonzero(np.diff(orders))  # the last samples of all orders but the last
    moved = np.abs(np.diff(followed, prepend=followed[0]))
    late = np.abs(orders[last] - followed[last]) > moved.max() + 1e-9  # a step of it is no delay
    if not late.any():
        return []
    return [
        f"the {name} does not reach {late.sum()} of {len(last)} orders before the next; what is "
        "rated is what it does"
    ]
