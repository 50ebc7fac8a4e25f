"""Whether a unit may be a quantity's, which is asked of many pairs that do not belong together."""

from trialid.errors import UnitError
from trialid.names import unit_words, units


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
