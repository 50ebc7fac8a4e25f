"""The standard manoeuvres of MSC.137(76), predicted from a model, with how sure that is.

The resolution asks for them at 90 % of the speed at 85 % of the engine's power, at full load and in
deep calm water. A model fitted at another speed or load predicts them at that one; what is wind,
waves, current or a near bottom in it is left out. They are always sailed alike, to starboard first,
from a ship length of straight course at the approach speed, on a clock that goes by the ship: who
asks for one ship twice gets one number.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.accuracy.ranges import wider
from trialid.arrays import Vector
from trialid.design import manoeuvres
from trialid.design.helm import Instructions, Passage, Vessel, carry_out, vessel
from trialid.design.imo import measures
from trialid.design.imo.measures import Criterion
from trialid.errors import DesignError
from trialid.ship.effect import Effect
from trialid.ship.model import moves_her
from trialid.ship.particulars import Ship

DEGREES: Final = float(np.rad2deg(1.0))
TEN, TWENTY, HARD = (float(np.deg2rad(x)) for x in (10.0, 20.0, 35.0))
STRAIGHT: Final = 1.0
"""Ship lengths of straight course before the order."""
LENGTHS: Final = 90.0
"""Ship lengths a manoeuvre is given; a turn of 540 deg takes about 15."""
STEPS: Final = 200
"""Samples in the time for a ship length: a helmsman who looks so often is late by nothing."""
AT_SEA: Final = {"psi", "V_aw", "gamma_aw", "alpha_w", "h", "X_ext", "Y_ext", "K_ext", "N_ext"}
"""What nothing depends on in calm deep water: course, wind, waves, depth, outer forces."""


@dataclass(frozen=True)
class Measure:
    """One standard measure.

    Attributes
    ----------
    value
        In the criterion's unit; None where the manoeuvre did not come so far, and `remark` why.
    interval
        95 %, None where nothing says how sure the model is.
    """

    criterion: Criterion
    value: float | None
    interval: tuple[float, float] | None
    remark: str = ""

    @property
    def kept(self) -> bool | None:
        """Whether the criterion is kept, whatever of its interval; None where that is open."""
        largest = self.criterion.largest
        if self.value is None or largest is None:
            return None
        low, high = self.interval or (self.value, self.value)
        if high <= largest:
            return True
        return False if low > largest else None


def embrace(measures: Sequence[Measure], there: Sequence[Measure]) -> tuple[Measure, ...]:
    """The same with ranges that hold those of another model of the ship, where both have one."""
    others = {one.criterion.name: one.interval for one in there}
    return tuple(
        replace(one, interval=wider(one.interval, others.get(one.criterion.name)))
        for one in measures
    )


Read = Callable[[Passage, Vector | None], list[float]]


@dataclass(frozen=True)
class Reading:
    """Measures read from one manoeuvre, in the units of their criteria.

    `read` takes the headings that reversals are reckoned from, where not the passage's own.
    """

    names: tuple[str, ...]
    manoeuvre: str
    read: Read


def _turning(passage: Passage, headings: Vector | None) -> list[float]:
    del headings
    found = measures.turning(passage)
    return [found["advance"], found["tactical diameter"]]


def _initial_turning(passage: Passage, headings: Vector | None) -> list[float]:
    del headings
    return [measures.initial_turning(passage, TEN)]


def _overshoots(passage: Passage, headings: Vector | None) -> list[float]:
    return [x * DEGREES for x in measures.overshoots(passage, headings)]


MANOEUVRES: Final[Mapping[str, Callable[[], Instructions]]] = {
    "turning circle": lambda: manoeuvres.turning_circle(HARD),
    "zig-zag 10/10": lambda: manoeuvres.zigzag(TEN, TEN, 4),
    "zig-zag 20/20": lambda: manoeuvres.zigzag(TWENTY, TWENTY, 4),
}
READINGS: Final = (
    Reading(("advance", "tactical diameter"), "turning circle", _turning),
    Reading(("initial turning",), "zig-zag 10/10", _initial_turning),
    *(
        Reading((f"first overshoot {a}", f"second overshoot {a}"), f"zig-zag {a}", _overshoots)
        for a in ("10/10", "20/20")
    ),
)


def acts_in_calm(effect: Effect) -> bool:
    """Whether an effect moves a ship in deep water without wind, waves, current or a tug."""
    return moves_her(effect) and not AT_SEA & {*effect.signals}


def in_calm(ship: Vessel) -> Vessel:
    """The ship as the resolution's manoeuvres are sailed: calm deep water, her own clock.

    She heads 0, whatever she headed in her trials: her track begins ahead.
    """
    model, p = ship.model, ship.model.ship.particulars
    for effect in (e for e in ship.model.effects if not acts_in_calm(e)):
        model = model - effect.name
    constants = {**ship.constants, "u": p["U0"], "psi": 0.0}
    return vessel(model, p["L"] / p["U0"] / STEPS, constants, ship.rudder_rate)


def sail_all(ship: Vessel) -> dict[str, Passage]:
    """Every manoeuvre of the resolution, by name, on a ship that is in calm water."""
    one = STEPS * ship.period
    return {
        name: carry_out(ship, told(), STRAIGHT * one, LENGTHS * one, name)
        for name, told in MANOEUVRES.items()
    }


def read_all(passages: Mapping[str, Passage]) -> tuple[dict[str, float], dict[str, str]]:
    """Every measure that the passages come to, and why there are no others; by name."""
    values, remarks = dict[str, float](), dict[str, str]()
    for reading in READINGS:
        passage = passages[reading.manoeuvre]
        try:
            found = reading.read(passage, None)
            why = f"no such overshoot in {LENGTHS:.0f} ship lengths"
        except DesignError as error:
            found, why = [], str(error)
        if passage.departure is not None:
            found, why = [], f"the ship leaves her model: {passage.departure}"
        values |= dict(zip(reading.names, found, strict=False))
        remarks |= dict.fromkeys(reading.names[len(found) :], why)
    return values, remarks


def measures_of(
    ship: Ship,
    values: Mapping[str, float],
    remarks: Mapping[str, str],
    ranges: Mapping[str, tuple[float, float] | None],
) -> tuple[Measure, ...]:
    """What was read of a ship beside what the resolution allows her; none of it is below zero."""
    p = ship.particulars
    positive = {n: (max(r[0], 0.0), max(r[1], 0.0)) for n, r in ranges.items() if r is not None}
    return tuple(
        Measure(c, values.get(c.name), positive.get(c.name), remarks.get(c.name, ""))
        for c in measures.criteria(p["L"], p["U0"])
    )


def predict(vessels: Sequence[Vessel]) -> tuple[Measure, ...]:
    """The standard measures of the first vessel; the others are what she might be as well."""
    (values, remarks), *others = [read_all(sail_all(in_calm(one))) for one in vessels]
    ranges = {}
    for name, value in values.items():
        drawn = [f[name] for f, _ in others if name in f]
        if len(drawn) > 2:
            wide = 1.96 * float(np.std(drawn, ddof=1))
            ranges[name] = value - wide, value + wide
    return measures_of(vessels[0].model.ship, values, remarks, ranges)
