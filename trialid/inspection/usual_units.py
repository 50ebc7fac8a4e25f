"""Whether a unit may be a quantity's, which is asked of many pairs that do not belong together."""

from typing import Final

from trialid.errors import UnitError
from trialid.names import unit_words, units

NO_RADIANS: Final = 6.5
"""Largest number of a heading or roll in radians, a whole turn and noise; beyond it is degrees."""


def of_angle(largest: float) -> str | None:
    """The unit of a heading or roll whose numbers go so far, where none is stated.

    >>> of_angle(359.7), of_angle(3.1)
    ('deg', None)
    """
    return "deg" if largest > NO_RADIANS else None


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
