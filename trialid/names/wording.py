"""Numbers as people read them: few digits, a true minus sign, an en dash where nothing is known."""

import math
import re
from collections.abc import Sequence
from typing import Final

DASH = "\N{EN DASH}"
MINUS = "\N{MINUS SIGN}"
THIN = "\N{NARROW NO-BREAK SPACE}"
_TIMES = f"{THIN}\N{MULTIPLICATION SIGN}{THIN}10"
TOO_SHORT: Final = "too short"
"""Begins why what there is of a stretch tells nothing; what to do asks for a longer one then."""
SET_BACK: Final = "a local clock set back by an hour"
"""Told of stamps that step back by as much: two hours' samples are mixed."""
RAISED = dict(zip("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹", strict=True))
"""Signs of an exponent, plain to raised."""

_RAISED = str.maketrans(RAISED)
_SHOWN = {"rad": ("deg", 180 / math.pi), "rad/s": ("deg/s", 180 / math.pi)}


def number(value: float | None, digits: int = 4) -> str:
    """A number to so many significant digits.

    >>> number(0.0023456), number(0.5, 2), number(0.0)
    ('0.002346', '0.50', '0')
    """
    if value is None or not math.isfinite(value):
        return DASH
    if value == 0:
        return "0"
    if isinstance(value, int):
        return f"{value:,}".replace(",", THIN).replace("-", MINUS)
    power = _power(value, digits)
    if -4 <= power < 5:
        return _fixed(value, digits - 1 - power)
    mantissa = f"{value:.{digits - 1}e}".partition("e")[0].replace("-", MINUS)
    return mantissa + _TIMES + str(power).translate(_RAISED)


MOST: Final = 1000.0
"""[%] From which on a person reads no digits: ten times its own size is not known at all. Half of
it still prints the error of a boat begun with a gain 25 times too large, 231 %, as twice does."""


def percent(fraction: float | None, digits: int = 3) -> str:
    """A fraction as a percentage: 0.12345 is `12.3 %`, and 3e14 is `> 1000 %`."""
    if fraction is None or not math.isfinite(fraction):
        return DASH
    value = 100.0 * fraction
    if abs(value) > MOST:
        beyond = ">" if value > 0.0 else "below"
        return f"{beyond}{THIN}{_fixed(math.copysign(MOST, value), 0)}{THIN}%"
    if abs(value) < 0.001:
        return number(value, min(digits, 2)) + THIN + "%"
    return _fixed(value, min(digits - 1 - _power(value, digits), 4)) + THIN + "%"


def percent_range(interval: Sequence[float] | None) -> str:
    """An interval of a fraction, `3.90 to 4.41 %`, or nothing."""
    if interval is None or any(end is None for end in interval):
        return ""
    low, high = (percent(end) for end in interval)
    return f"{low.removesuffix(THIN + '%')} to {high}"


def by_error(value: float | None, error: float | None) -> str:
    """A value with the digits its standard error leaves it, two of the error.

    >>> by_error(0.0123456789, 1.2e-6), by_error(0.0123456789, 4e-4)
    ('0.0123457', '0.01235')
    """
    return number(value, digits_by_error(value, error))


def digits_by_error(value: float | None, error: float | None) -> int:
    """Significant digits that a standard error leaves a value; four where it is not known.

    >>> digits_by_error(0.0123456789, 4e-4), digits_by_error(0.0123456789, None)
    (4, 4)
    """
    if value is None or error is None or not (math.isfinite(value) and math.isfinite(error)):
        return 4
    if value == 0.0 or error <= 0.0:
        return 4
    digits = _power(value, 4) - _power(error, 2) + 2
    return min(max(digits, 2), 7)


def count_of(count: int, one: str, many: str = "") -> str:
    """How many there are of something, one being one; `many` where an s alone makes no plural.

    >>> count_of(1, "effect"), count_of(16, "effect"), count_of(0, "remark on it", "remarks on it")
    ('1 effect', '16 effects', '0 remarks on it')
    """
    return f"{count} {one if count == 1 else many or one + 's'}"


def named_together(names: Sequence[str]) -> str:
    """Names of things that do something together.

    >>> named_together(["a", "b"]), named_together(["a", "b", "c"])
    ('a and b', 'a, b and c')
    """
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def sign_text(value: float | None) -> str:
    """A move with its sign, one place.

    >>> sign_text(2.44), sign_text(None)
    ('+2.4', '\N{EN DASH}')
    """
    return DASH if value is None else f"{value:+.1f}".replace("-", MINUS)


def points(drop: float | None) -> str:
    """A drop of a percentage, in percentage points; a rise has a plus sign.

    >>> points(0.0151), points(-0.002)
    ('\N{MINUS SIGN}1.51', '+0.20')
    """
    if drop is None:
        return DASH
    return ("+" if drop < 0.0 else MINUS) + f"{abs(100.0 * drop):.2f}"


def prose(sentence: str) -> str:
    """A sentence whose percent signs stay on the line of their numbers."""
    return re.sub(r"(?<=\d) %", THIN + "%", sentence)


def shown_unit(unit: str | None) -> tuple[str, float]:
    """The unit a parameter is shown in and the factor to it: angles in degrees.

    >>> shown_unit("m/s"), shown_unit("rad/s")[0]
    (('m/s', 1.0), 'deg/s')
    """
    return _SHOWN.get(unit or "", (unit or "", 1.0))


def with_unit(value: float, unit: str) -> str:
    """A parameter's SI value in words, four digits and the unit it is shown in.

    >>> with_unit(-0.1, "rad"), with_unit(0.25, "1")
    ('-5.73 deg', '0.25')
    """
    shown, factor = shown_unit(unit)
    return f"{value * factor:.4g} {shown if shown != '1' else ''}".rstrip()


def short_hash(digest: str | None) -> str:
    """Enough of a hash to recognise a file by."""
    return digest[:12] if digest else DASH


def _power(value: float, digits: int) -> int:
    """The power of ten after rounding: 9.9996 to four digits is 10.00."""
    return int(f"{value:.{digits - 1}e}".partition("e")[2])


def _fixed(value: float, places: int) -> str:
    return f"{value:.{max(places, 0)}f}".replace("-", MINUS)
