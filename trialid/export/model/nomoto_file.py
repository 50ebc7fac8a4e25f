"""Nomoto's numbers and the state space as JSON, at each speed seen, with their likely ranges."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal

import numpy as np

from trialid.design.steering.nomoto import UNITS, Nomoto
from trialid.export.model.fitted_model import FittedModel
from trialid.export.model.order_words import nomoto_words
from trialid.names import labels
from trialid.result.json_file import finite

SCHEMA: Final[Literal["trialid-nomoto/1"]] = "trialid-nomoto/1"
UNITS_OF_THRUSTERS: Final[Mapping[str, Mapping[str, str]]] = {
    "revolutions": {"K": "1", "K_prime": "s", "T_prime": "1"},
    "share": UNITS,
    "thrust": {"K": "1/(N s)", "K_prime": "1/N", "T_prime": "1"},
}
UNSTABLE: Final = (
    "As fitted the ship is not directionally stable: K and T are negative, and a small order leads "
    "to no steady turn."
)
ENDLESS: Final = (
    "K, T and T1 have no range, nor is it said that she is stable: with some of what may be "
    "missing they pass through infinity, though the margin of the model stays on one side."
)

Row = tuple[float | None, ...]


@dataclass(frozen=True, kw_only=True)
class NomotoNumber:
    """A number with its unit and its 95 % range; None where nobody knows that."""

    value: float
    unit: str
    likely: tuple[float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class StateSpace:
    """dx/dt = A x + B delta for small angles, r the output; SI, with the ends of each entry."""

    states: tuple[str, ...]
    units: tuple[str, ...]
    input: str
    A: tuple[Row, ...]
    B: Row
    A_from: tuple[Row, ...]
    A_to: tuple[Row, ...]
    B_from: Row
    B_to: Row


@dataclass(frozen=True, kw_only=True)
class AtSpeed:
    """T dr/dt + r = K delta, delta positive to starboard, at a speed [m/s]; and second order.

    r = K (1 + T3 s) / ((1 + T1 s) (1 + T2 s)) delta, of the rudder or the thrusters themselves;
    `order` says what delta is; `stable` is None where the record does not tell.
    """

    speed: float
    stable: bool | None
    order: str
    numbers: Mapping[str, NomotoNumber] = field(default_factory=dict)
    state_space: StateSpace


@dataclass(frozen=True, kw_only=True)
class NomotoFile:
    """What `trialid export --as nomoto` writes: the approach speed first, then others seen."""

    schema: Literal["trialid-nomoto/1"] = SCHEMA
    name: str
    verdict: str
    words: tuple[str, ...] = ()
    origin: Mapping[str, str] = field(default_factory=dict)
    at: tuple[AtSpeed, ...] = ()


def nomoto_file(made: FittedModel, found: Sequence[Nomoto], told: bool = True) -> NomotoFile:
    """The content of the file; `told` whether the record tells that she is stable or not."""
    beside = () if all(one.stable for one in found) else (UNSTABLE,)
    if told and not all(one.ranges.get("K") for one in found):
        beside = (*beside, ENDLESS)
    whole: NomotoFile = finite(
        NomotoFile(
            name=made.name,
            verdict=made.verdict,
            words=(*beside, *made.words),
            origin=dict(made.origin),
            at=tuple(_at_speed(one, told) for one in found),
        )
    )
    return whole


def _at_speed(found: Nomoto, told: bool) -> AtSpeed:
    """At one speed; whether she is stable is told where K, too, has a range."""
    stable = found.stable if told and found.ranges.get("K") else None
    numbers = {
        name: NomotoNumber(value=value, unit=_unit(name, found), likely=found.ranges.get(name))
        for name, value in found.values.items()
    }
    ship = found.ship
    space = StateSpace(
        states=ship.states,
        units=tuple(labels.quantity(s).unit for s in ship.states),
        input=ship.steered_by.name,
        A=_rows(ship.A),
        B=_row(ship.B),
        A_from=_rows(found.A_likely[..., 0]),
        A_to=_rows(found.A_likely[..., 1]),
        B_from=_row(found.B_likely[..., 0]),
        B_to=_row(found.B_likely[..., 1]),
    )
    return AtSpeed(
        speed=found.speed,
        stable=stable,
        order=nomoto_words(ship),
        numbers=numbers,
        state_space=space,
    )


def _unit(name: str, found: Nomoto) -> str:
    """Of a number: K is a rate of turn by a rudder angle or by the command of a thruster."""
    thrusters = found.ship.steered_by.thrusters
    per = UNITS_OF_THRUSTERS[thrusters[0].command] if thrusters else UNITS
    return per.get(name, "s")


def _rows(values: np.ndarray) -> tuple[Row, ...]:
    return tuple(_row(row) for row in values)


def _row(values: np.ndarray) -> Row:
    return tuple(float(x) for x in values)
