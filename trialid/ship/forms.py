"""What an effect may give: forces, rates of states, and what sensors do to a record."""

from collections.abc import Iterator, Mapping
from typing import Final, NamedTuple, TypeAlias

from trialid.maths import Number


class Force(NamedTuple):
    """Forces X, Y and moments K, N on the ship; the axes stay horizontal and move with the ship.

    Primed (divided by 1/2 rho L^2 U^2, moments by 1/2 rho L^3 U^2) unless the effect says SI.
    """

    X: Number = 0.0
    Y: Number = 0.0
    K: Number = 0.0
    N: Number = 0.0


class _Named(Mapping[str, Number]):
    """A frozen mapping written with keywords: `Rate(delta=...)`."""

    def __init__(self, **parts: Number) -> None:
        self._parts = parts

    def __getitem__(self, name: str) -> Number:
        return self._parts[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)


class Rate(_Named):
    """Time derivatives [SI/s] of the states an actuator or a sensor adds."""


class Measured(_Named):
    """What a sensor adds to the true value of an output [SI]: bias, scale, cross-axis."""


class Steered(_Named):
    """What is added to a recorded input before it acts on the ship [SI]: the rudder's offset."""


class Delayed(_Named):
    """How late an output is recorded, or how much later than recorded an input acts [s]."""


class Lagged(_Named):
    """Time constant of a sensor's first-order low-pass on an output [s]."""


class Mass(_Named):
    """What is added to the ship's mass parameters, primed."""


Result: TypeAlias = Force | Rate | Measured | Steered | Delayed | Lagged | Mass
FORMS: Final = (Force, Rate, Measured, Steered, Delayed, Lagged, Mass)
SENSORS: Final = (Measured, Delayed, Lagged)
"""Forms of what happens between a motion and its record."""
