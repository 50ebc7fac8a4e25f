"""What a steering order is: a rudder angle, or half the difference between two thrusters.

Of two thrusters, one on each side, an order d adds d to the command of the port one and takes d
from that of the starboard one, both about the command that holds the speed; so she turns to
starboard by a positive one, as by a rudder. A skid-steered vehicle of ArduPilot Rover mixes alike.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from trialid.design.helm import Vessel
from trialid.design.prediction.engine_orders import PUSHING
from trialid.design.rudders import GEAR_STATE
from trialid.errors import DesignError
from trialid.ship.actuators import Actuator

RUDDERS: Final = ("delta", "delta_order")
DIFFERENCE: Final = "difference"


@dataclass(frozen=True, kw_only=True)
class SteeredBy:
    """What an order of one adds to each input, and to each state that follows one [SI].

    Attributes
    ----------
    name
        `delta`, `delta_order` where the model has a gear of its own, or `difference`.
    thrusters
        Port and starboard; empty of a rudder, which is amidships on a straight course.
    """

    name: str = "delta"
    inputs: Mapping[str, float] = field(default_factory=lambda: {"delta": 1.0})
    states: Mapping[str, float] = field(default_factory=lambda: {GEAR_STATE: 1.0})
    thrusters: tuple[Actuator, ...] = ()


def steered_by(ship: Vessel) -> SteeredBy:
    """What steers a ship.

    Raises
    ------
    DesignError
        Neither a rudder nor two thrusters on opposite sides, or her speed is not simulated.
    """
    eq = ship.simulator.equations
    rudder = next((d for d in RUDDERS if d in eq.inputs), None)
    if rudder is not None:
        return SteeredBy(name=rudder, inputs={rudder: 1.0})
    ones = tuple(
        sorted((a for a in ship.model.ship.actuators if _told(a, eq.inputs)), key=lambda a: a.y)
    )
    names = [n for a in ones for n in _told(a, eq.inputs)]
    if not _opposite(ones):
        raise DesignError(
            "K, T and gains are those of a rudder angle, or of two thrusters alike, one to port "
            f"and one to starboard; this model has the inputs {', '.join(eq.inputs)}"
        )
    if "u" not in eq.states:
        raise DesignError(
            f"{' and '.join(names)} steer about the commands that hold the speed, which this model "
            "is given and does not simulate: put u among its states"
        )
    signs = dict(zip(ones, (1.0, -1.0), strict=True))
    return SteeredBy(
        name=DIFFERENCE,
        inputs={n: sign for a, sign in signs.items() for n in _told(a, eq.inputs)},
        states={a.name: sign for a, sign in signs.items()},
        thrusters=ones,
    )


def _told(one: Actuator, inputs: Sequence[str]) -> list[str]:
    """Inputs that say what an actuator pushes with; one that may be late reads its order, too."""
    both = (one.drive, f"{one.drive}_order") if one.kind in PUSHING else ()
    return [n for n in both if n in inputs]


def _opposite(ones: tuple[Actuator, ...]) -> bool:
    """Whether these are two thrusters on opposite sides that one kind of command drives."""
    if len(ones) != 2 or {a.kind for a in ones} != {"thruster"}:
        return False
    return ones[0].y < 0.0 < ones[1].y and ones[0].command == ones[1].command
