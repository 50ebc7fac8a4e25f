"""Gains of an autopilot from K and T, and what they promise over all that the record leaves open.

Turn rate, by feed-forward and a proportional and an integral part: FF = 1 / K, and with P = (w T -
1) / K the rate follows as fast as a lag of 1 / w, which is the bandwidth; the integral takes off
what wind and trim leave, 25 times as slowly, for 4 % of overshoot.

Heading, by poles: Kp = w_n^2 T / K, Kd = (2 z w_n T - 1) / K, Ki = w_n Kp / 10 (Fossen 2011,
Handbook of Marine Craft Hydrodynamics and Motion Control, section 12.2), damping z of 0.8.

What is ordered is what steers the ship: a rudder angle, or half the difference of two thrusters.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.design.helm import Vessel
from trialid.design.prediction.drawn_ships import draw_ships, groups_of_ships
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.design.standard import acts_in_calm, in_calm
from trialid.design.steering.closed_loop import (
    SWINGS,
    Answer,
    Controller,
    answer,
    hold_heading,
    hold_rate,
)
from trialid.design.steering.nomoto import read
from trialid.design.steering.straight_course import LinearShip, StraightCourse
from trialid.errors import DesignError

SLOWER: Final = 25.0
"""By how much the integral of a rate controller is slower than its bandwidth."""
FASTER: Final = 2.0
"""Bandwidth of a rate controller, where none is asked for, in 1 / T: twice as fast as the ship."""
LESS: Final = "ask for less by --bandwidth, or sail more trials"
MORE: Final = (
    "most of those turn on by themselves, which gains for more hold sooner: ask for more by "
    "--bandwidth, or sail trials that tell whether she is stable on her course"
)
"""What to do where too many ships swing: by too much of a gain, or as too little holds them."""

MOST: Final = 30.0
"""Times the usual bandwidth up to which gains are made: beyond, steering gears, samples and waves
are what acts, of which her model says nothing. Where it stands is a choice, by no record."""
DAMPING: Final = 0.8
NUMBER: Final = 200
"""Ships drawn that gains are tried on."""
ENDS: Final = (2.5, 97.5)
"""Per cent of them beyond which the ends of a range lie."""

FIELDS: Final = ("overshoot", "settling", "phase_margin", "delay_margin")

Made = Callable[[LinearShip], Controller]
Uncertain = tuple[Vessel, LikelySpread]
"""A ship, and all that what she does is uncertain by."""


@dataclass(frozen=True, kw_only=True)
class Promise:
    """What gains do to the fitted ship, and to 95 of 100 ships that the record leaves open.

    `ranges` are by the name of a field of `Answer`; `stable` is the share of ships that are, the
    least of several models.
    """

    fitted: Answer
    ranges: Mapping[str, tuple[float, float]]
    stable: float


@dataclass(frozen=True, kw_only=True)
class Gains:
    """Gains by name, of an order that steers a linear ship [SI], for a bandwidth [rad/s]."""

    values: Mapping[str, float]
    bandwidth: float
    ship: LinearShip
    promise: Promise


def rate_gains(
    ship: Vessel,
    spread: LikelySpread,
    bandwidth: float | None = None,
    others: Sequence[Uncertain] = (),
) -> Gains:
    """FF and P [s], I [1]: order by turn rate, for a bandwidth or twice that of the ship.

    What they promise holds for `others`, too: other models of the ship.

    Raises
    ------
    DesignError
        The ship is not directionally stable, too slow is asked for, or ships that the record leaves
        open swing.
    """
    linear, K, T = _known(ship, spread)
    wanted = _asked(bandwidth, FASTER / T)
    if wanted * T < 1.0:
        raise DesignError(
            f"a bandwidth of {wanted:.3g} rad/s is slower than the ship by herself, {1 / T:.3g}; "
            "ask for more"
        )
    models = [(ship, spread), *others]
    values = {"FF": 1.0 / K, "P": (wanted * T - 1.0) / K, "I": wanted**2 * T / SLOWER / K}
    return _tried(models, linear, values, wanted, lambda one: hold_rate(one, **values))


def heading_gains(
    ship: Vessel,
    spread: LikelySpread,
    bandwidth: float | None = None,
    others: Sequence[Uncertain] = (),
) -> Gains:
    """Kp [1], Ki [1/s] and Kd [s]: order by heading, for a bandwidth or that of the ship.

    What they promise holds for `others`, too: other models of the ship.

    Raises
    ------
    DesignError
        The ship is not directionally stable, or ships that the record leaves open swing.
    """
    linear, K, T = _known(ship, spread)
    wanted = _asked(bandwidth, 1.0 / T)
    z2 = DAMPING**2
    natural = wanted / np.sqrt(1.0 - 2.0 * z2 + np.sqrt(4.0 * z2 * z2 - 4.0 * z2 + 2.0))
    Kp = natural**2 * T / K
    Kd = max(2.0 * DAMPING * natural * T - 1.0, 0.0) / K
    models = [(ship, spread), *others]
    values = {"Kp": float(Kp), "Ki": float(natural * Kp / 10.0), "Kd": float(Kd)}
    return _tried(models, linear, values, wanted, lambda one: hold_heading(one, **values))


def _known(ship: Vessel, spread: LikelySpread) -> tuple[LinearShip, float, float]:
    """The linear ship in calm water, her K and T."""
    course = StraightCourse(in_calm(ship))
    linear = course.at(course.theta)
    found = read(linear)
    if not linear.stable or found["K"] <= 0.0 or found["T"] <= 0.0:
        drawn = [one is not None and one.stable for one in _drawn(ship, spread)]
        raise DesignError(
            "as fitted the ship is not directionally stable, or turns against her order "
            f"({np.mean(drawn):.0%} of the ships that the record leaves open are stable); gains by "
            "K and T are for one that is: free fewer parameters, or sail more trials"
        )
    return linear, found["K"], found["T"]


def _asked(bandwidth: float | None, usual: float) -> float:
    if bandwidth is None:
        return usual
    if not 0.0 < bandwidth <= MOST * usual:
        raise DesignError(
            f"a bandwidth of {bandwidth:g} rad/s is none of hers; expected more than 0, up to "
            f"{MOST * usual:.3g}, {MOST:g} times what is usual for her"
        )
    return bandwidth


def _tried(
    models: Sequence[Uncertain],
    linear: LinearShip,
    values: Mapping[str, float],
    bandwidth: float,
    made: Made,
) -> Gains:
    """Gains with what they promise.

    Raises
    ------
    DesignError
        Too many of the ships that the record leaves open swing, or hold no speed.
    """
    ships = [[*_drawn(*model)] for model in models]
    drawn = [
        [SWINGS if one is None else answer(made(one), bandwidth) for one in some] for some in ships
    ]
    stable = min(float(np.mean([one.stable for one in some])) for some in drawn)
    unheld = ", or hold no speed," if linear.steered_by.thrusters else ""
    if stable < ENDS[1] / 100.0:
        pairs = [x for some in zip(ships, drawn, strict=True) for x in zip(*some, strict=True)]
        swing = [one for one, answered in pairs if not answered.stable]
        turn_on = sum(one is not None and not one.stable for one in swing)
        other = MORE if turn_on > 0.5 * len(swing) else LESS
        raise DesignError(
            f"{1.0 - stable:.0%} of the ships that the record leaves open would swing{unheld} "
            f"under gains for {bandwidth:.3g} rad/s; {other}"
        )
    fitted = answer(made(linear), bandwidth)
    ranges = {n: _range(n, fitted, drawn) for n in FIELDS}
    promise = Promise(fitted=fitted, ranges=ranges, stable=stable)
    return Gains(values=values, bandwidth=bandwidth, ship=linear, promise=promise)


def _range(name: str, fitted: Answer, drawn: Sequence[Sequence[Answer]]) -> tuple[float, float]:
    """Where 95 of 100 ships of each model lie, and the one as it was fitted."""
    every = [[float(getattr(one, name)) for one in some if one.stable] for some in drawn]
    ends = np.array([np.percentile(values, ENDS, method="nearest") for values in every])
    own = float(getattr(fitted, name))
    return min(float(ends[:, 0].min()), own), max(float(ends[:, 1].max()), own)


def _drawn(ship: Vessel, spread: LikelySpread) -> Iterator[LinearShip | None]:
    """Linear ships as the record leaves them open, None where no command holds the speed.

    What is known at a value tried is left out.
    """
    base = in_calm(ship)
    ships = draw_ships(base, spread, NUMBER, seed=0)
    for one in groups_of_ships(base, spread, ships, acts_in_calm):
        course = StraightCourse(one.ship)
        for theta in one.thetas:
            try:
                yield course.at(dict(zip(course.parameters, theta.tolist(), strict=True)))
            except DesignError:
                yield None
