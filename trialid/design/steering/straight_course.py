"""A ship linearised on a straight course: dx/dt = A x + B delta, for any parameters."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import GEAR_STATE, Vessel
from trialid.errors import DesignError
from trialid.simulation.graph import gradient
from trialid.simulation.reference import evaluator

RUDDERS: Final = ("delta", "delta_order")
ALONG: Final = ("u", "u_lost", "u_off", "psi")
"""States that a small turn on a straight course leaves alone, or that leave it alone."""


@dataclass(frozen=True, kw_only=True)
class LinearShip:
    """dx/dt = A x + B delta on a straight course at a speed [m/s]; SI, small angles.

    Attributes
    ----------
    states
        Names in the order of `A` (n, n) and `B` (n,).
    rudder
        What steers: `delta`, or `delta_order` where the model has a gear of its own.
    """

    states: tuple[str, ...]
    A: Vector
    B: Vector
    rudder: str
    speed: float
    length: float

    @property
    def stable(self) -> bool:
        """Whether a small disturbance dies out with the rudder amidships."""
        return bool(np.linalg.eigvals(self.A).real.max() <= 0.0)

    @property
    def turning(self) -> int:
        """The place of the rate of turn."""
        return self.states.index("r")

    @property
    def hull(self) -> "LinearShip":
        """Sway and yaw alone under the rudder itself: everything else follows at once.

        Raises
        ------
        DesignError
            What follows does not settle, or is not there.
        """
        kept = [i for i, s in enumerate(self.states) if s in ("v", "r")]
        rest = [i for i, s in enumerate(self.states) if s not in ("v", "r", GEAR_STATE)]
        A, B = self.A, self.B
        if GEAR_STATE in self.states:
            B = A[:, self.states.index(GEAR_STATE)]
        try:
            back = np.linalg.solve(A[np.ix_(rest, rest)], np.column_stack([A[rest], B[rest]]))
        except np.linalg.LinAlgError as error:
            raise DesignError("what beside sway and yaw moves does not settle") from error
        slim = A[kept][:, kept] - A[np.ix_(kept, rest)] @ back[:, kept]
        drive = B[kept] - A[np.ix_(kept, rest)] @ back[:, -1]
        names = tuple(self.states[i] for i in kept)
        return replace(self, states=names, A=slim, B=drive, rudder="delta")


class StraightCourse:
    """The equations of a ship on a straight course, ready for any values of her parameters.

    Raises
    ------
    DesignError
        No rudder steers her, or she does not turn.
    """

    def __init__(self, ship: Vessel) -> None:
        eq, model = ship.simulator.equations, ship.model
        self.parameters = eq.parameters
        self.states = tuple(s for s in eq.states if s not in ALONG)
        table = {n.value: n for n in eq.graph.nodes if n.op == "symbol"}
        rudder = next((d for d in RUDDERS if d in eq.inputs), None)
        if rudder is None or rudder not in table or "r" not in self.states:
            raise DesignError("Nomoto's K and T need a model that turns by a rudder")
        by = [table[s] for s in self.states if s in table] + [table[rudder]]
        self._columns = [n.value for n in by]
        rows = [eq.f[eq.states.index(s)] for s in self.states]
        nodes = [d for row in rows for d in gradient(row, by)]
        self._symbols = (*eq.states, *eq.inputs, *eq.parameters)
        self._run = evaluator(nodes, self._symbols, scalar=True)
        self.theta = {n: model.value(n) for n in eq.parameters}
        p = model.ship.particulars
        start = {"u": p["U0"]}
        self._point = {**dict.fromkeys(self._symbols, 0.0), **ship.constants, **start, rudder: 0.0}
        self.rudder, self.speed, self.length = rudder, p["U0"], p["L"]

    def at(self, theta: Mapping[str, float]) -> LinearShip:
        """The ship with these values of her parameters."""
        known = {**self._point, **theta}
        flat = np.array(self._run([float(known[s]) for s in self._symbols]))
        whole = np.zeros((len(self.states), len(self.states) + 1))
        for place, name in enumerate(self._columns):
            column = -1 if name == self.rudder else self.states.index(name)
            whole[:, column] = flat.reshape(len(self.states), -1)[:, place]
        return LinearShip(
            states=self.states,
            A=whole[:, :-1],
            B=whole[:, -1],
            rudder=self.rudder,
            speed=self.speed,
            length=self.length,
        )
