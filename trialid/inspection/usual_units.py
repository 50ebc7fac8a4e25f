"""The units that logs are full of, without the half a second that a library of all units takes."""

import math
from typing import Final

from trialid.errors import UnitError
from trialid.names import unit_words, units

USUAL: Final = {
    "rad": ("rad", 1.0),
    "deg": ("rad", math.pi / 180),
    "rad/s": ("rad/s", 1.0),
    "deg/s": ("rad/s", math.pi / 180),
    "deg/min": ("rad/s", math.pi / 10800),
    "rpm": ("rad/s", math.pi / 30),
    "m/s": ("m/s", 1.0),
    "kn": ("m/s", 1852 / 3600),
    "km/h": ("m/s", 1 / 3.6),
    "m": ("m", 1.0),
}
"""Unit to the SI unit it becomes, and the factor."""


def to_si(unit: str, si: str) -> float | None:
    """What to multiply a number in `unit` by to have it in the SI unit; None where it cannot be.

    >>> to_si("kn", "m/s") == 1852 / 3600, to_si("deg", "m/s")
    (True, None)
    """
    try:
        usual = USUAL.get(unit_words.plain(unit))
        if usual is not None:
            return usual[1] if usual[0] == si else None
        return units.factor(unit, si)
    except UnitError:
        return None
