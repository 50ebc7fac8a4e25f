"""What is known of a ship before her first trial, each number with its words and its unit."""

from dataclasses import dataclass, fields
from typing import Final, NamedTuple

KNOT: Final = 1852.0 / 3600.0
SEA: Final = 1025.0
"""[kg/m^3]"""


@dataclass(frozen=True, kw_only=True)
class Given:
    """Particulars as they are stated, SI; None where nobody has said.

    Attributes
    ----------
    length
        Between perpendiculars [m].
    block
        Displaced volume over length, beam and draught.
    displacement
        Mass [kg].
    x_G
        Centre of gravity ahead of midships [m].
    roll_period
        Of the natural roll [s].
    rudder_area, rudder_aspect
        Of all rudders together [m^2]; height over chord of one.
    rho
        Density of the water [kg/m^3].
    """

    length: float | None = None
    beam: float | None = None
    draught: float | None = None
    block: float | None = None
    displacement: float | None = None
    speed: float | None = None
    GM: float | None = None
    roll_period: float | None = None
    rudder_area: float | None = None
    rudder_aspect: float | None = None
    propeller_diameter: float | None = None
    x_G: float | None = None
    rho: float = SEA


class Words(NamedTuple):
    """How people say a particular: its name, its unit, how many of these one in SI has."""

    name: str
    unit: str
    factor: float = 1.0


WORDS: Final = {
    "length": Words("length", "m"),
    "beam": Words("beam", "m"),
    "draught": Words("draught", "m"),
    "block": Words("block coefficient", ""),
    "displacement": Words("displacement", "t", 1e-3),
    "speed": Words("speed", "kn", 1.0 / KNOT),
    "GM": Words("GM", "m"),
    "roll_period": Words("roll period", "s"),
    "rudder_area": Words("rudder area", "m^2"),
    "rudder_aspect": Words("rudder aspect ratio", ""),
    "propeller_diameter": Words("propeller diameter", "m"),
    "x_G": Words("centre of gravity ahead of midships", "m"),
    "rho": Words("density of the water", "kg/m^3"),
}
"""Every particular, in the order of the options."""


def tell(given: Given, name: str) -> str:
    """A particular in words, in the unit people use.

    >>> tell(Given(displacement=21.753e6), "displacement")
    'displacement 21753 t'
    """
    words = WORDS[name]
    value = getattr(given, name) * words.factor
    return f"{words.name} {value:.9g} {words.unit}".rstrip()


def known_names(given: Given) -> tuple[str, ...]:
    """Names of what is known, in order."""
    return tuple(f.name for f in fields(given) if getattr(given, f.name) is not None)


def told_of(given: Given) -> str:
    """Everything that is known, in words; of the water only what is not the sea.

    >>> told_of(Given(length=96.5, beam=16.2))
    'length 96.5 m, beam 16.2 m'
    """
    known = (n for n in known_names(given) if n != "rho" or given.rho != SEA)
    return ", ".join(tell(given, n) for n in known)
