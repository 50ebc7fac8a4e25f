"""Nomoto's K and T of a fitted ship, with where each is likely to lie.

T dr/dt + r = K delta describes slow steering about a straight course. K is the rate of turn per
rudder angle that a small order leads to, T the time it lags behind by: of the linearised model
dx/dt = A x + B delta, r = C x,

    K = -C A^-1 B,    T = -C A^-2 B / (C A^-1 B),

which is T1 + T2 - T3 of the second-order model (Nomoto, Taguchi, Honda & Hirano 1957, On the
steering qualities of ships).
"""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Vessel
from trialid.design.imo.measure_slopes import WithColumns, tried_ship, with_columns
from trialid.design.prediction.likely_spread import LikelySpread, Range
from trialid.design.standard import acts_in_calm, in_calm
from trialid.errors import DesignError
from trialid.simulation.graph import gradient
from trialid.simulation.reference import evaluator

RUDDERS: Final = ("delta", "delta_order")
ALONG: Final = ("u", "u_lost", "psi")
"""States that a small turn on a straight course leaves alone, or that leave it alone."""
STEP: Final = 1e-5
"""Share of a parameter's size that it is moved by to see what it does."""
NAMES: Final = ("K", "T", "K_prime", "T_prime")


@dataclass(frozen=True, kw_only=True)
class Nomoto:
    """K [1/s] and T [s] at a speed [m/s], and primed: K L / U, T U / L; each with its 95 % range.

    `stable` says whether a small disturbance dies out with the rudder amidships; where it does not
    K and T are negative, and no rate of turn is ever steady.
    """

    speed: float
    values: Mapping[str, float]
    ranges: Mapping[str, Range | None] = field(default_factory=dict)
    stable: bool = True


def nomoto(ship: Vessel, spread: LikelySpread) -> Nomoto:
    """K and T of a fitted ship at her approach speed, in calm deep water.

    Raises
    ------
    DesignError
        No rudder steers her, or it turns nothing.
    """
    base = in_calm(ship)
    acting = [m for m in spread.missing if acts_in_calm(m.effect)]
    moved = with_columns(base, spread.known, acting)
    point = _Straight(moved)
    values, stable = point.read(point.theta)
    slopes = np.zeros((len(NAMES), len(spread.known) + spread.width))
    for place, name in zip(moved.places, moved.ship.simulator.equations.free, strict=True):
        size = abs(moved.ship.model.value(name)) or abs(moved.ship.model.parameters[name].start)
        step = STEP * (size or 1.0)
        with suppress(DesignError):  # in a dead band a small order does nothing: no K to compare
            up, down = (
                point.read({**point.theta, name: point.theta[name] + s})[0] for s in (step, -step)
            )
            slopes[:, place] = (up - down) / (2.0 * step)
    for one in (m for m in acting if m.tried):
        with suppress(DesignError):
            other = _Straight(with_columns(tried_ship(base, one), (), ()))
            apart = other.read(other.theta)[0] - values
            slopes[:, [len(spread.known) + c for c in one.columns]] = apart[:, None]
    found = dict(zip(NAMES, map(float, values), strict=True))
    ranges = dict(zip(NAMES, spread.ranges(values, slopes), strict=True))
    speed = base.model.ship.particulars["U0"]
    return Nomoto(speed=speed, values=found, ranges=ranges, stable=stable)


class _Straight:
    """A ship linearised on a straight course, for any values of her parameters."""

    def __init__(self, of: WithColumns) -> None:
        ship = of.ship
        eq, self.model = ship.simulator.equations, ship.model
        self.states = [s for s in eq.states if s not in ALONG]
        table = {n.value: n for n in eq.graph.nodes if n.op == "symbol"}
        rudder = next((d for d in RUDDERS if d in eq.inputs), None)
        if rudder is None or rudder not in table or "r" not in self.states:
            raise DesignError("Nomoto's K and T need a model that turns by a rudder")
        by = [table[s] for s in self.states if s in table] + [table[rudder]]
        self.columns = [n.value for n in by]
        rows = [eq.f[eq.states.index(s)] for s in self.states]
        nodes = [d for row in rows for d in gradient(row, by)]
        self.symbols = (*eq.states, *eq.inputs, *eq.parameters)
        self.run = evaluator(nodes, self.symbols, scalar=True)
        self.theta = {n: self.model.value(n) for n in eq.parameters}
        start = {"u": self.model.ship.particulars["U0"]}
        self.point = {**dict.fromkeys(self.symbols, 0.0), **ship.constants, **start, rudder: 0.0}
        self.rudder = rudder

    def read(self, theta: Mapping[str, float]) -> tuple[Vector, bool]:
        """K, T and both primed; whether the straight course is stable."""
        known = {**self.point, **theta}
        flat = np.array(self.run([float(known[s]) for s in self.symbols]))
        whole = np.zeros((len(self.states), len(self.states) + 1))
        for place, name in enumerate(self.columns):
            column = -1 if name == self.rudder else self.states.index(name)
            whole[:, column] = flat.reshape(len(self.states), -1)[:, place]
        A, B = whole[:, :-1], whole[:, -1]
        r = self.states.index("r")
        try:
            once = np.linalg.solve(A, B)
            twice = np.linalg.solve(A, once)
        except np.linalg.LinAlgError as error:
            raise DesignError("a small rudder angle leads to no steady turn: no K, no T") from error
        if once[r] == 0.0:
            raise DesignError("the rudder turns nothing on a straight course: no K, no T")
        K, T = -once[r], -twice[r] / once[r]
        p = self.model.ship.particulars
        time = p["L"] / p["U0"]
        growing = np.linalg.eigvals(A).real.max()
        return np.array([K, T, K * time, T / time]), bool(growing <= 0.0)
