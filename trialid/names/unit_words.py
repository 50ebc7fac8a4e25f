"""Units as people and instruments write them, to the words that are looked up."""

import re
from typing import Final

from trialid.errors import UnitError

WHOLE: Final = {
    "rpm": ("rpm", "upm", "u/min", "umdr/min", "umin", "omdr/min", "o/min", "tr/min", "r/min",
            "rev/min", "revs/min", "giri/min", "1/min", "/min", "min-1", "min^-1", "min**-1"),
    "rps": ("rps", "rev/s", "revs/s", "r/s", "u/s", "umdr/s", "tr/s", "rev/sec"),
    "kn": ("kn", "kt", "kts", "knoten", "knop", "knopen", "knoop", "noeuds", "nœuds", "nudos",
           "nodi"),
    "km/h": ("km/h", "kmh", "kph", "km/t"),
}  # fmt: skip
"""A shaft turns so often a minute or a second; nothing else is given in `1/min`."""
PARTS: Final = {
    "deg": ("°", "º", "deg.", "grader", "graden", "grade", "grados", "gradi", "degrés", "degres",
            "deg true", "deg t", "degt", "°t", "° t", "degrees true", "deg mag", "deg magnetic"),
    "gradian": ("gon", "gons"),
    "s": ("sec", "sec.", "sek", "sek.", "sekunden", "sekunde", "seconds", "second", "secs"),
    "min": ("min.", "minute", "minuten", "minutes"),
    "m": ("meter", "metre", "metres", "meters"),
}  # fmt: skip
"""Words for what stands on either side of a slash."""

_WHOLE: Final = {text: unit for unit, texts in WHOLE.items() for text in texts}
_PARTS: Final = {text: unit for unit, texts in PARTS.items() for text in texts}
DOUBTFUL: Final = "grad"
"""A degree in German and Norwegian where it is `Grad`; the hundredth of a right angle to others."""


def plain(unit: str) -> str:
    """The unit in words that are looked up.

    >>> [plain(unit) for unit in ("U/min", "min-1", "rev/s", "°/min", "Grad/s", "Knoten")]
    ['rpm', 'rpm', 'rps', 'deg/min', 'deg/s', 'kn']
    >>> plain("deg true"), plain("degT"), plain("deg magnetic")  # of a compass
    ('deg', 'deg', 'deg')
    >>> plain("m/s^2"), plain("mm")
    ('m/s^2', 'mm')
    """
    text = " ".join(unit.split())
    if (whole := _WHOLE.get(text.lower().replace(" ", ""))) is not None:
        return whole
    parts = [part.strip() for part in re.sub(r"\bper\b", "/", text).split("/")]
    return "/".join(_part(part) for part in parts)


def _part(text: str) -> str:
    if text == DOUBTFUL:
        raise UnitError(
            f"unit {text!r} may be a degree or the hundredth of a right angle; write deg or gon"
        )
    if text == "Grad":
        return "deg"
    return _PARTS.get(text.lower(), text)
