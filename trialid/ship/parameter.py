"""Numbers that an effect asks for: parameters to be identified, signals of one's own."""

import math
from dataclasses import dataclass, replace
from typing import Final

S175: Final = 175.0
"""Length [m] of the ship whose typical values are those of the catalogue."""

FROUDE: Final = {"m": 1.0, "N m s": 4.5}
"""Power of the length by which a value grows, by its unit, where speeds grow with its root."""


@dataclass(frozen=True)
class Parameter:
    """A number to be identified.

    Parameters
    ----------
    start
        Typical value: where a fit starts, and the scale of everything relative; of a ship as long
        as `of_length` says [m], or of any where that is None.
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
    corrects
        The number of the ship's file that it is added to: as sure as the file calls that.
    """

    start: float
    unit: str = "1"
    low: float = -math.inf
    high: float = math.inf
    null: float | None = 0.0
    scan: tuple[float, ...] = ()
    by_meaning: bool = False
    of_length: float | None = None
    corrects: str | None = None

    def of_ship(self, length: float) -> "Parameter":
        """The same with a typical value for a ship of this length [m], by Froude's law.

        >>> Parameter(0.05, "m", of_length=175.0).of_ship(3.5).start
        0.001
        """
        if self.of_length is None:
            return self
        times = (length / self.of_length) ** FROUDE[self.unit]
        scan = tuple(x * times for x in self.scan)
        return replace(self, start=self.start * times, scan=scan, of_length=None)


@dataclass(frozen=True)
class Signal:
    """A signal of one's own that an effect reads: any that the pipeline names.

    Parameters
    ----------
    unit
        Unit in which the effect wants it; the pipeline may state another of the same kind.
    """

    unit: str
