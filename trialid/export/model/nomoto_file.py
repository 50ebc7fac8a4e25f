"""Nomoto's K and T as JSON, with their likely ranges and what to know of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal

from trialid.design.steering.nomoto import Nomoto
from trialid.export.model.fitted_model import FittedModel
from trialid.result.json_file import finite

SCHEMA: Final[Literal["trialid-nomoto/1"]] = "trialid-nomoto/1"
UNITS: Final = {"K": "1/s", "T": "s", "K_prime": "1", "T_prime": "1"}
UNSTABLE: Final = (
    "The ship is not directionally stable: K and T are negative, and a small order leads to no "
    "steady turn."
)


@dataclass(frozen=True, kw_only=True)
class NomotoNumber:
    """A number with its unit and its 95 % range; None where nobody knows that."""

    value: float
    unit: str
    likely: tuple[float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class NomotoFile:
    """T dr/dt + r = K delta, delta positive to starboard, at a speed [m/s]."""

    schema: Literal["trialid-nomoto/1"] = SCHEMA
    name: str
    reliable: bool
    words: tuple[str, ...] = ()
    origin: Mapping[str, str] = field(default_factory=dict)
    speed: float
    stable: bool
    numbers: Mapping[str, NomotoNumber] = field(default_factory=dict)


def nomoto_file(made: FittedModel, found: Nomoto) -> NomotoFile:
    """The content of the file."""
    numbers = {
        name: NomotoNumber(value=value, unit=UNITS[name], likely=found.ranges.get(name))
        for name, value in found.values.items()
    }
    whole: NomotoFile = finite(
        NomotoFile(
            name=made.name,
            reliable=made.reliable,
            words=made.words if found.stable else (UNSTABLE, *made.words),
            origin=dict(made.origin),
            speed=found.speed,
            stable=found.stable,
            numbers=numbers,
        )
    )
    return whole
