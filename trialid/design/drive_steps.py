"""Tests of a boat that steers by two thrusters: steps of their difference, and spins on the spot.

Numbers are shares of what the ship file says may be ordered of each (`limit`), so that a test in
which none is larger than one keeps to it.
"""

import math
from collections.abc import Iterable, Sequence

import numpy as np

from trialid.arrays import Vector
from trialid.design.drive_commands import Drive
from trialid.design.helm import Instructions
from trialid.errors import DesignError
from trialid.ship.actuators import Actuator

Pair = tuple[Actuator, Actuator]
"""The thruster to port and the one to starboard."""


def differential_steps(
    pair: Pair | None,
    ahead: Sequence[float],
    differences: Sequence[float],
    lengths: Sequence[float],
    samples: int,
) -> Instructions:
    """Port gets `ahead` more, starboard `ahead` less the difference, step by step; shares.

    The first of `ahead` is held in the approach; what `lengths` says of the steps is relative.
    """
    port, starboard = _checked(pair)
    difference = np.asarray(differences, dtype=np.float64)
    both = np.resize(np.asarray(ahead, dtype=np.float64), len(difference))
    parts = np.resize(np.asarray(lengths, dtype=np.float64), len(difference))
    yield Drive(
        {
            port.name: port.limit * _held(both + difference, parts, samples),
            starboard.name: starboard.limit * _held(both - difference, parts, samples),
        },
        {port.name: port.limit * float(both[0]), starboard.name: starboard.limit * float(both[0])},
    )


def spins(
    pair: Pair | None, turning: Sequence[float], lengths: Sequence[float], samples: int
) -> Instructions:
    """One ahead and the other astern by the same share, to starboard where positive; from rest."""
    yield from differential_steps(pair, (0.0,), turning, lengths, samples)


def _held(values: Vector, parts: Vector, samples: int) -> Vector:
    """Each value for its part of the samples; (samples,)."""
    ends = np.cumsum(parts) / parts.sum()
    place = np.searchsorted(ends, (np.arange(samples) + 0.5) / samples)
    return np.asarray(values[np.minimum(place, len(values) - 1)])


def _checked(pair: Pair | None) -> Pair:
    if pair is None:
        raise DesignError(
            "the ship has not one thruster to port and one to starboard; write an [[actuator]] for "
            "each in her file, or take a test of the rudder"
        )
    for one in pair:
        if not math.isfinite(one.limit):
            raise DesignError(
                f"actuator {one.name!r} states no limit in the ship file, of which the test is a "
                "share; write limit = the most that may be ordered of it"
            )
    return pair


def thruster_pair(actuators: Iterable[Actuator]) -> tuple[Actuator, Actuator] | None:
    """The thruster to port and the one to starboard; None where there is not one of each."""
    thrusters = [one for one in actuators if one.kind == "thruster"]
    port = [one for one in thrusters if one.y < 0.0]
    starboard = [one for one in thrusters if one.y > 0.0]
    return (port[0], starboard[0]) if len(port) == len(starboard) == 1 else None
