"""The words of a channel's name: its unit behind an underscore, and the side it is of."""

import re
from collections.abc import Sequence
from typing import Final

from trialid.names.side_words import LETTERS, SIDES

UNITS_IN_NAMES: Final = {
    "deg": "deg",
    "degree": "deg",
    "degrees": "deg",
    "rad": "rad",
    "degps": "deg/s",
    "radps": "rad/s",
    "dps": "deg/s",
    "degs": "deg/s",
    "degpm": "deg/min",
    "dpm": "deg/min",
    "kn": "kn",
    "kt": "kn",
    "kts": "kn",
    "knots": "kn",
    "mps": "m/s",
    "ms": "m/s",
    "rpm": "rpm",
    "rps": "rps",
    "pct": "%",
    "percent": "%",
    "deg s": "deg/s",
    "rad s": "rad/s",
    "m s": "m/s",
    "deg min": "deg/min",
}

_WORD: Final = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[^\W\d_A-Z]+|[A-Z]+|\d+")
HAVE_SIDES: Final = frozenset(("delta", "n", "rud", "rudder", "rpm"))
"""Words behind which these letters, the last of a name, are a side: `DELTA_P`, `n_S`."""


def words(name: str) -> tuple[str, ...]:
    """A name in lower-case words.

    >>> words("/imu:angular_velocity.z"), words("rudderAngle_deg")
    (('imu', 'angular', 'velocity', 'z'), ('rudder', 'angle', 'deg'))
    """
    return tuple(word.lower() for word in _WORD.findall(name))


WATER: Final = frozenset(
    (
        *("stw", "sow", "vhw", "fdw", "loch", "corredera"),
        *("water", "wasser", "eau", "agua", "acqua"),
        *("vann", "vannet", "vatten", "vattnet", "vandet", "água"),
    )
)
"""Words of a speed that a log measures through the water."""


def is_through_water(name: str) -> bool:
    """Whether a channel says that its speed is one through the water.

    >>> is_through_water("VHW/II:speed"), is_through_water("speed/12:water"), is_through_water("u")
    (True, True, False)
    """
    return bool(WATER.intersection(words(name)))


def drop_number(name: str) -> str:
    """A name without the number of one of several behind its unit.

    >>> drop_number("rudder_angle_deg_1"), drop_number("rudder_1"), drop_number("acc_mps2")
    ('rudder_angle_deg', 'rudder_1', 'acc_mps2')
    """
    bare, _, number = name.rpartition("_")
    numbered = number.isdecimal() and words(bare)[-1:] and words(bare)[-1] in UNITS_IN_NAMES
    return bare if numbered else name


def bare_words(name: str) -> Sequence[str]:
    """The words of a name before those of its unit.

    >>> bare_words("rudder_angle_deg_1"), bare_words("ROT")
    (('rudder', 'angle'), ('rot',))
    """
    return without_unit(words(drop_number(name)))


def without_unit(field: Sequence[str]) -> Sequence[str]:
    """The words of a field before those of its unit: `min` of `rot_deg_min` is no smallest."""
    for count in (2, 1):
        if " ".join(field[-count:]) in UNITS_IN_NAMES:
            field = field[:-count]
    return field


def unit_of_rate(unit: str, field: Sequence[str]) -> str | None:
    """The unit of a rate: of `rps` it is rad/s to robots; degrees may be by second or minute.

    A `rot` in degrees may be a rotation; `ms` are milliseconds.

    >>> unit_of_rate("rad", ("yaw", "rate", "rad")), unit_of_rate("deg", ("yaw", "rate", "deg"))
    ('rad/s', None)
    """
    if unit in ("rad", "deg") and "rot" not in field:
        return "rad/s" if unit == "rad" else None
    return None if unit in ("rps", "m/s") else unit


def sides(name: str) -> set[str]:
    """The sides that a name says, as shafts have them; a `P` or `S` at its end says one too.

    >>> sides("rud_sb_deg"), sides("DELTA_P"), sides("rudder")
    ({'n_s'}, {'n_p'}, set())
    """
    told = bare_words(name)
    named = {SIDES[word] for word in told if word in SIDES}
    behind = len(told) > 1 and told[-2] in HAVE_SIDES
    return named or ({LETTERS[told[-1]]} if behind and told[-1] in LETTERS else set())


def without_side(name: str, told: Sequence[str]) -> Sequence[str]:
    """Some words of a name without the one that says its side, if it is of one."""
    if len(sides(name)) != 1:
        return told
    kept = [word for word in told if word not in SIDES]
    return kept if len(kept) < len(told) else told[:-1]
