"""Nomoto's numbers of a fitted ship, with where each is likely to lie.

T dr/dt + r = K delta describes slow steering about a straight course. Delta is a rudder angle, or
half the difference of the commands of two thrusters [SI] (`steered_by`). K is the rate of turn per
order that a small order leads to, T the time it lags behind by: of the linearised model
dx/dt = A x + B delta, r = C x,

    K = -C A^-1 B,    T = -C A^-2 B / (C A^-1 B),

which is T1 + T2 - T3 of the second-order model r = K (1 + T3 s) / ((1 + T1 s) (1 + T2 s)) delta
(Nomoto, Taguchi, Honda & Hirano 1957, On the steering qualities of ships). T1, T2 and T3 are those
of sway and yaw, what else moves, as roll, following at once, and of what acts itself.
"""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from trialid.accuracy.ranges import wider
from trialid.arrays import Vector
from trialid.design.helm import Vessel, vessel
from trialid.design.imo.measure_slopes import tried_ship, with_columns
from trialid.design.prediction.likely_spread import LikelySpread, Range
from trialid.design.standard import acts_in_calm, in_calm
from trialid.design.steering.straight_course import LinearShip, StraightCourse
from trialid.errors import DesignError

STEP: Final = 1e-5
"""Share of a parameter's size that it is moved by to see what it does."""
FIRST: Final = ("K", "T", "K_prime", "T_prime")
SECOND: Final = ("T1", "T2", "T3")
NAMES: Final = (*FIRST, *SECOND)
BOUNDLESS: Final = (*FIRST, "T1")
"""Those that pass through infinity where she turns from a stable ship into an unstable one: of a
tanker hardly stable K was 0.05, "likely" -0.2 to 1.2, and 93 in truth."""
UNITS: Final = {"K": "1/s", "K_prime": "1", "T_prime": "1"}
"""Of those that are no times [s]."""


@dataclass(frozen=True, kw_only=True)
class Nomoto:
    """K [1/s] and times [s] at a speed [m/s], and primed: K L / U, T U / L; with 95 % ranges.

    Attributes
    ----------
    stable
        Whether a small disturbance dies out without an order; where it does not K and T
        are negative, and no rate of turn is ever steady.
    ranges
        None of K, T and T1 where she may be neither: they have no end then.
    values
        T1, T2 and T3 are left out where the ship does not sway, or T1 and T2 are no real numbers.
    ship
        The linearised ship, and the ends of the range of each entry: A (n, n, 2), B (n, 2).
    """

    speed: float
    values: Mapping[str, float]
    ranges: Mapping[str, Range | None] = field(default_factory=dict)
    stable: bool = True
    ship: LinearShip
    A_likely: Vector
    B_likely: Vector

    def embracing(self, there: "Nomoto") -> "Nomoto":
        """The same with ranges that hold those of another model of the ship."""
        ranges = {n: wider(own, there.ranges.get(n)) for n, own in self.ranges.items()}
        made = replace(self, ranges=ranges)
        if there.ship.states != self.ship.states:
            return made
        A, B = (
            _wider(own, other)
            for own, other in ((self.A_likely, there.A_likely), (self.B_likely, there.B_likely))
        )
        return replace(made, A_likely=A, B_likely=B)


def _wider(own: Vector, there: Vector) -> Vector:
    """Ends (..., 2) that hold others, too; NaN where nobody knows them."""
    low, high = np.fmin(own, there)[..., 0], np.fmax(own, there)[..., 1]
    return np.where(np.isnan(own), own, np.stack([low, high], axis=-1))


def nomoto(ship: Vessel, spread: LikelySpread) -> Nomoto:
    """Nomoto's numbers of a fitted ship at her approach speed, in calm deep water.

    Raises
    ------
    DesignError
        Neither a rudder nor two thrusters steer her, or they turn nothing.
    """
    base = in_calm(ship)
    linear = StraightCourse(base)
    at = linear.at(linear.theta)
    values = read(at)
    ranges = _ranges(base, spread, at.states)
    *ranges, neutral = ranges
    known = dict(zip(NAMES, ranges, strict=False))
    if neutral is None or neutral[0] <= 0.0 <= neutral[1]:
        known |= dict.fromkeys(BOUNDLESS)
    entries = np.array([r or (np.nan, np.nan) for r in ranges[len(NAMES) :]])
    split = at.A.size
    return Nomoto(
        speed=at.speed,
        values=values,
        ranges={n: known[n] for n in values},
        stable=at.stable,
        ship=at,
        A_likely=entries[:split].reshape(*at.A.shape, 2),
        B_likely=entries[split:],
    )


def at_speeds(ship: Vessel, spread: LikelySpread, speeds: Iterable[float]) -> tuple[Nomoto, ...]:
    """The same at other speeds [m/s], numbers in the prime system as they are."""
    return tuple(nomoto(_at_speed(ship, speed), spread) for speed in speeds)


def _at_speed(ship: Vessel, speed: float) -> Vessel:
    particulars = {**ship.model.ship.particulars, "U0": speed}
    model = replace(ship.model, ship=replace(ship.model.ship, particulars=particulars))
    return vessel(model, ship.period, {**ship.constants, "u": speed}, ship.rudder_rate)


def read(ship: LinearShip) -> dict[str, float]:
    """Nomoto's numbers of a linear ship, by name.

    Raises
    ------
    DesignError
        A small order leads to no steady turn, or turns nothing.
    """
    A, B, r = ship.A, ship.B, ship.turning
    try:
        once = np.linalg.solve(A, B)
        twice = np.linalg.solve(A, once)
    except np.linalg.LinAlgError as error:
        raise DesignError("a small steering order leads to no steady turn: no K, no T") from error
    if once[r] == 0.0:
        raise DesignError("a steering order turns nothing on a straight course: no K, no T")
    K, T = -once[r], -twice[r] / once[r]
    time = ship.length / ship.speed
    found = dict(zip(FIRST, map(float, (K, T, K * time, T / time)), strict=True))
    if "v" in ship.states:
        with suppress(DesignError):
            found |= _second(ship.hull)
    return found


def _second(hull: LinearShip) -> dict[str, float]:
    """T1, T2 and T3 of sway and yaw, the longer first; nothing where a pair swings."""
    poles = np.linalg.eigvals(hull.A)
    if np.iscomplex(poles).any() or not poles.all():
        return {}
    v, r = hull.states.index("v"), hull.turning
    across = hull.A[r, v] * hull.B[v] - hull.A[v, v] * hull.B[r]
    times = sorted(-1.0 / poles.real, key=abs, reverse=True)
    zero = hull.B[r] / across if across else np.inf
    return dict(zip(SECOND, map(float, (*times, zero)), strict=True))


def _all_numbers(ship: LinearShip, states: Sequence[str]) -> Vector:
    """Every number, then A and B of these states, whatever an effect has added, and det A."""
    found = read(ship)
    named = [found.get(n, np.nan) for n in NAMES]
    kept = [ship.states.index(s) for s in states]
    entries = ship.A[np.ix_(kept, kept)].ravel(), ship.driven(states)[kept]
    return np.concatenate([named, *entries, [np.linalg.det(ship.A)]])


def _ranges(base: Vessel, spread: LikelySpread, states: Sequence[str]) -> list[Range | None]:
    """Where every number of the linear ship is likely to lie."""
    acting = [m for m in spread.missing if acts_in_calm(m.effect)]
    moved = with_columns(base, spread.known, acting)
    point = StraightCourse(moved.ship)
    values = _all_numbers(point.at(point.theta), states)
    slopes = np.zeros((len(values), len(spread.known) + spread.width))
    for place, name in zip(moved.places, moved.ship.simulator.equations.free, strict=True):
        size = abs(moved.ship.model.value(name)) or abs(moved.ship.model.parameters[name].start)
        step = STEP * (size or 1.0)
        with suppress(DesignError):  # in a dead band a small order does nothing: no K to compare
            up, down = (
                _all_numbers(point.at({**point.theta, name: point.theta[name] + s}), states)
                for s in (step, -step)
            )
            slopes[:, place] = np.nan_to_num((up - down) / (2.0 * step))
    for one in (m for m in acting if m.tried):
        with suppress(DesignError):
            other = StraightCourse(with_columns(tried_ship(base, one), (), ()).ship)
            apart = np.nan_to_num(_all_numbers(other.at(other.theta), states) - values)
            slopes[:, [len(spread.known) + c for c in one.columns]] = apart[:, None]
    return spread.ranges(values, slopes)
