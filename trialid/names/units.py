"""Unit text to SI, at the doors only; inside the package every number is SI."""

import functools
import math
import re
from typing import TYPE_CHECKING, Any, Final

from trialid.errors import UnitError, nearest
from trialid.names import unit_words
from trialid.names.quantities import Quantity

if TYPE_CHECKING:
    import pint

TEXT: Final = re.compile(
    r"[A-Za-z%°µ][\w%°µ]*((\s?(\*\*?|/|\^)\s?|\s{1,3})-?[\w%°µ]+)*|1(/[A-Za-z]\w*)?|º(/[A-Za-z]+)?|"
    r"[A-Za-z]+\.?(/[A-Za-z]+\.?)?|min(\^|\*\*)?-1"
)
"""What a unit may look like; anything else would be evaluated as arithmetic."""

ROTATION: Final = re.compile(r"rad|deg|°|rpm|rps|turn|rev|grad|arc|cycle", re.IGNORECASE)
"""What an angle or a rate of turning has in its unit; `1/s` would be wrong by 2 pi or right."""

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
"""Unit to the SI unit it becomes, and the factor: those that logs are full of, without the
0.35 s, beside Dask 0.5 s and more, that a library of all units takes."""

COMMON = ("rad", "deg", "rad/s", "deg/s", "deg/min", "m/s", "kn", "km/h", "m", "s", "rpm", "1/s")


@functools.cache
def _registry() -> "pint.UnitRegistry[Any]":
    import pint

    registry: pint.UnitRegistry[Any] = pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
    if "kn" not in registry:
        registry.define("kn = knot")
    return registry


def factor(unit: str, si: str) -> float:
    """What to multiply a number in `unit` by to have it in the SI unit `si`.

    >>> round(factor("kn", "m/s"), 6)
    0.514444
    >>> round(factor("deg/min", "rad/s") * 60 * 180, 6)
    3.141593
    >>> factor("kN", "N"), round(factor("kN", "m/s"), 6)  # of a speed it is knots
    (1000.0, 0.514444)
    >>> factor("rpm", "N")
    Traceback (most recent call last):
        ...
    trialid.errors.UnitError: unit 'rpm' cannot become 'N'; units that can: N
    >>> factor("deg", "m/s")
    Traceback (most recent call last):
        ...
    trialid.errors.UnitError: unit 'deg' cannot become 'm/s'; units that can: km/h, kn, m/s
    """
    if not TEXT.fullmatch(unit):
        raise UnitError(f"unit {unit!r} is not a unit text; write it like {', '.join(COMMON[:4])}")
    text = "kilonewton" if unit == "kN" and si == "N" else unit_words.plain(unit)
    if "rad" in si and not ROTATION.search(text):
        raise UnitError(
            f"unit {unit!r} cannot become {si!r}: it does not say what turns; write deg, rad, "
            "rpm or rps (turns in a second)"
        )
    usual = USUAL.get(text)
    return usual[1] if usual is not None and usual[0] == si else _looked_up(unit, text, si)


def factor_of(unit: str, quantity: Quantity) -> float:
    """The same for a quantity; of a drive the refusal tells the command that has this unit."""
    try:
        return factor(unit, quantity.unit)
    except UnitError as error:
        others = [name for name, si in quantity.commands if becomes(unit, si)]
        if not others:
            raise
        told = f'at this [[actuator]], command = "{others[0]}"'
        raise UnitError(f"{error}; or say in the ship file, {told}") from error


def becomes(unit: str, si: str) -> bool:
    """Whether a number in it can become one in the SI unit."""
    try:
        return factor(unit, si) > 0.0
    except UnitError:
        return False


def _looked_up(unit: str, text: str, si: str) -> float:
    """The factor by the library of units; `text` is the unit in words that it knows."""
    import pint

    registry = _registry()
    try:
        return float(registry.Quantity(1.0, text).to(si).magnitude)
    except pint.UndefinedUnitError as error:
        raise UnitError(f"unit {unit!r} is not known ({nearest(unit, COMMON)})") from error
    except pint.DimensionalityError as error:
        able = ", ".join(sorted(c for c in COMMON if _fits(c, si))) or si
        raise UnitError(f"unit {unit!r} cannot become {si!r}; units that can: {able}") from error
    except (ValueError, ArithmeticError) as error:  # arithmetic in it: s/0, "s 5", nan
        raise UnitError(f"unit {unit!r} cannot be understood; write it like deg/s") from error


def _fits(unit: str, si: str) -> bool:
    registry = _registry()
    return bool(registry.Quantity(1.0, unit).is_compatible_with(si))


def shown_factor(quantity: Quantity) -> float:
    """What to multiply an SI number by to show it in the unit reports use."""
    if quantity.shown == quantity.unit:
        return 1.0
    return 1.0 / factor(quantity.shown, quantity.unit)
