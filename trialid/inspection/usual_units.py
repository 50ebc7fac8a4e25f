"""Whether a unit may be a quantity's, which is asked of many pairs that do not belong together."""

from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.errors import UnitError
from trialid.names import unit_words, units

NO_RADIANS: Final = 6.5
"""Largest number of a heading or roll in radians, a whole turn and noise; beyond it is degrees."""
ROUND: Final = 0.9 * 2.0 * np.pi
"""A jump of so much, of numbers no larger than that, is a turn in radians gone round: in degrees a
ship swings by half of it from sample to sample, and a dropout to 0 is as large only from there on;
twice is no jump of such numbers."""
HEELED: Final = 0.5 * np.pi
"""Roll in radians beyond which a ship lies on her side: what is there for more than `SPIKES` is in
degrees. Half of it would take a boat that heels 46 deg for one in degrees, with twice a roll of 2
deg has to be asked for."""
SPIKES: Final = 0.01
"""Share of the samples of a roll that are no measurement."""


def of_angle(y: Vector, goes_round: bool) -> str | None:
    """The unit of a heading or roll by its numbers, where none is stated; None where both may be.

    A simulation's heading in radians `goes_round` without a jump, from where it begins.

    >>> heading = ([10.5, 359.7], [3.1, -3.1], [5.2, 0.0, 5.1], [1.0], [5.2, 7.9, 10.4])
    >>> [of_angle(np.array(y), True) for y in heading], of_angle(np.array([5.2, 7.9, 10.4]), False)
    (['deg', 'rad', None, None, None], 'deg')
    >>> of_angle(np.array([2.9, -2.5, 1.0]), False), of_angle(np.array([0.5, -0.4]), False)
    ('deg', None)
    """
    if not goes_round and len(y) and np.quantile(np.abs(y), 1.0 - SPIKES) > HEELED:
        return "deg"
    jump = np.abs(np.diff(y)).max(initial=0.0)
    if np.abs(y).max(initial=0.0) > NO_RADIANS:
        unwound = goes_round and abs(y[0]) <= NO_RADIANS and jump < np.pi
        return None if unwound else "deg"
    return "rad" if jump > ROUND else None


def to_si(unit: str, si: str) -> float | None:
    """What to multiply a number in `unit` by to have it in the SI unit; None where it cannot be.

    >>> to_si("kn", "m/s") == 1852 / 3600, to_si("deg", "m/s")
    (True, None)
    """
    try:
        usual = units.USUAL.get(unit_words.plain(unit))
        if usual is not None:
            return usual[1] if usual[0] == si else None
        return units.factor(unit, si)
    except UnitError:
        return None
