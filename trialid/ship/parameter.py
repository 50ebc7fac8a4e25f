"""Numbers that an effect asks for: parameters to be identified, signals of one's own."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Parameter:
    """A number to be identified.

    Parameters
    ----------
    start
        Typical value: where a fit starts, and the scale of everything relative.
    unit
        `1` for a primed coefficient, else its SI unit.
    low, high
        Physical range.
    null
        The value at which the effect is absent; None for a number that shapes the effect and
        cannot switch it off, as the frequency of a tank.
    scan
        Values tried where the effect is not linear at its null, as the speed of a steering gear,
        or may be far from it, as a sensor of many seconds.
    by_meaning
        Whether its range is what it means: beyond it is another effect, as strong is beyond weak.
    """

    start: float
    unit: str = "1"
    low: float = -math.inf
    high: float = math.inf
    null: float | None = 0.0
    scan: tuple[float, ...] = ()
    by_meaning: bool = False


@dataclass(frozen=True)
class Signal:
    """A signal of one's own that an effect reads: any that the pipeline names.

    Parameters
    ----------
    unit
        Unit in which the effect wants it; the pipeline may state another of the same kind.
    """

    unit: str
