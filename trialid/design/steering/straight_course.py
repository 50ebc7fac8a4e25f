"""A ship linearised on a straight course: dx/dt = A x + B delta, for any parameters.

Delta is what steers her, a rudder angle or half the difference of two thrusters (`steered_by`);
those are linearised about the command that holds her speed, which is another for other parameters.
"""

from collections.abc import Container, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Vessel
from trialid.design.prediction.engine_orders import holding_order
from trialid.design.steering.steered_by import SteeredBy, steered_by
from trialid.errors import DesignError
from trialid.simulation.graph import gradient
from trialid.simulation.reference import evaluator

ALONG: Final = ("u", "u_lost", "u_off", "psi")
"""States that a small turn on a straight course leaves alone, or that leave it alone."""


@dataclass(frozen=True, kw_only=True)
class LinearShip:
    """dx/dt = A x + B delta on a straight course at a speed [m/s]; SI, small angles.

    Attributes
    ----------
    states
        Names in the order of `A` (n, n) and `B` (n,).
    steered_by
        What delta is.
    held
        The command of both thrusters that holds the speed [SI]; of a rudder amidships.
    """

    states: tuple[str, ...]
    A: Vector
    B: Vector
    speed: float
    length: float
    steered_by: SteeredBy = field(default_factory=SteeredBy)
    held: float = 0.0

    @property
    def stable(self) -> bool:
        """Whether a small disturbance dies out without an order."""
        return bool(np.linalg.eigvals(self.A).real.max() <= 0.0)

    @property
    def turning(self) -> int:
        """The place of the rate of turn."""
        return self.states.index("r")

    @property
    def hull(self) -> "LinearShip":
        """Sway and yaw alone under what acts itself: everything else follows at once.

        Raises
        ------
        DesignError
            What follows does not settle, or is not there.
        """
        gear = self.steered_by.states
        kept = [i for i, s in enumerate(self.states) if s in ("v", "r")]
        rest = [i for i, s in enumerate(self.states) if s not in ("v", "r", *gear)]
        A, B = self.A, self.driven()
        try:
            back = np.linalg.solve(A[np.ix_(rest, rest)], np.column_stack([A[rest], B[rest]]))
        except np.linalg.LinAlgError as error:
            raise DesignError("what beside sway and yaw moves does not settle") from error
        slim = A[kept][:, kept] - A[np.ix_(kept, rest)] @ back[:, kept]
        drive = B[kept] - A[np.ix_(kept, rest)] @ back[:, -1]
        names = tuple(self.states[i] for i in kept)
        return replace(self, states=names, A=slim, B=drive)

    def driven(self, without: Container[str] = ()) -> Vector:
        """What an order that has been carried out does; (n,): behind gear and lags, where any are.

        States in `without` are no gear, but states as others.
        """
        gear = {s: x for s, x in self.steered_by.states.items() if s not in without}
        there = [s for s in gear if s in self.states]
        parts = [gear[s] * self.A[:, self.states.index(s)] for s in there]
        return np.sum(parts, axis=0) if parts else self.B


class StraightCourse:
    """The equations of a ship on a straight course, ready for any values of her parameters.

    Raises
    ------
    DesignError
        Neither a rudder nor two thrusters steer her, or she does not turn.
    """

    def __init__(self, ship: Vessel) -> None:
        eq, model = ship.simulator.equations, ship.model
        self.parameters = eq.parameters
        self.states = tuple(s for s in eq.states if s not in ALONG)
        table = {n.value: n for n in eq.graph.nodes if n.op == "symbol"}
        self.steered_by = steered_by(ship)
        if not {*self.steered_by.inputs} <= {*table} or "r" not in self.states:
            raise DesignError("Nomoto's K and T need a model that turns by its steering order")
        by = [table[s] for s in (*self.states, *self.steered_by.inputs) if s in table]
        self._columns = [n.value for n in by]
        rows = [eq.f[eq.states.index(s)] for s in self.states]
        nodes = [d for row in rows for d in gradient(row, by)]
        self._symbols = (*eq.states, *eq.inputs, *eq.parameters)
        self._run = evaluator(nodes, self._symbols, scalar=True)
        self.theta = {n: model.value(n) for n in eq.parameters}
        along = [eq.f[eq.states.index("u")]] if self.steered_by.thrusters else []
        self._surge = evaluator(along, self._symbols, scalar=True)
        p = model.ship.particulars
        start = {"u": p["U0"]}
        self._point = {**dict.fromkeys(self._symbols, 0.0), **ship.constants, **start}
        self.speed, self.length = p["U0"], p["L"]

    def at(self, theta: Mapping[str, float]) -> LinearShip:
        """The ship with these values of her parameters.

        Raises
        ------
        DesignError
            No command of her thrusters holds her speed.
        """
        known = {**self._point, **theta}
        held = self._held(known)
        known |= self._all_at(held)
        flat = np.array(self._run([float(known[s]) for s in self._symbols]))
        whole = np.zeros((len(self.states), len(self.states) + 1))
        for place, name in enumerate(self._columns):
            share = self.steered_by.inputs.get(name)
            column = self.states.index(name) if share is None else -1
            each = flat.reshape(len(self.states), -1)[:, place]
            whole[:, column] += each * (1.0 if share is None else share)
        return LinearShip(
            states=self.states,
            A=whole[:, :-1],
            B=whole[:, -1],
            speed=self.speed,
            length=self.length,
            steered_by=self.steered_by,
            held=held,
        )

    def _all_at(self, command: float) -> dict[str, float]:
        """Every input that steers, and what follows it, at one command."""
        return dict.fromkeys((*self.steered_by.inputs, *self.steered_by.states), command)

    def _held(self, known: Mapping[str, float]) -> float:
        """The command of both thrusters that holds her speed, equal where one is weak; amidships.

        With one of two at half its thrust the moment of an order is 1.4 % less about the unequal
        commands that keep her straight as well.
        """
        if not self.steered_by.thrusters:
            return 0.0

        def rate(command: float) -> float:
            at = {**known, **self._all_at(command)}
            return float(self._surge([float(at[s]) for s in self._symbols])[0])

        held = holding_order(rate)
        if held is None:
            raise DesignError(
                f"no command of {' and '.join(self.steered_by.inputs)} holds the approach speed of "
                f"{self.speed:g} m/s in this model"
            )
        return held
