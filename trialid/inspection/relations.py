"""Which quantity an unnamed channel is by how it moves, and to which side a rudder is positive.

A rate of turn is the slope of the heading, a roll rate the slope of the roll angle: a relation with
a number in it, which the unit must give. Nothing else is as sharp, so nothing else is used.
"""

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from trialid.alignment.agreement import signs
from trialid.alignment.agreement.first_turn import first_turn
from trialid.alignment.agreement.turning import Turning
from trialid.arrays import Mask
from trialid.inspection.drives import DRIVES
from trialid.inspection.inspected import ChannelInspection, Guess
from trialid.inspection.name_words import words
from trialid.inspection.sketch import Vector, on_one_clock
from trialid.inspection.usual_units import to_si
from trialid.names import units
from trialid.names.quantities import SLOPES

SURE: Final = 0.95
"""Correlation from which a channel without a telling name is taken to be the rate of an angle."""

MOST_UNNAMED: Final = 60
"""More unnamed channels than this are a log of something else; they are not tried one by one."""

RATES: Final = ("rad/s", "deg/s", "deg/min")
SPEEDS: Final = ("m/s", "kn", "km/h")

FASTEST: Final = 0.95
"""Share of a record that is no faster than her approach: in a turn she loses three quarters."""

NEAR: Final = 0.25
"""A speed in the right unit is as near as this to the stated one, as a share of it."""


def recognise(channels: Mapping[str, ChannelInspection]) -> dict[str, ChannelInspection]:
    """The channels, with a guess for those that only their motion tells."""
    found = dict(channels)
    unnamed = [c for c in channels.values() if _unnamed(c)]
    if len(unnamed) > MOST_UNNAMED:
        return found
    for rate, angle in SLOPES.items():
        for reference in _named(channels, angle)[:1]:
            for channel in unnamed:
                strength = abs(slope_agreement(channel, reference))
                if strength > SURE and unit_of_rate(channel, reference):
                    why = f"by its relation to {angle} (correlation {strength:.2f})"
                    guess = Guess(rate, "relation", why)
                    found[channel.key] = dataclasses.replace(channel, guess=guess)
    return found


def _unnamed(channel: ChannelInspection) -> bool:
    able = (channel.stated_unit or RATES[0]) in RATES and not DRIVES & {*words(channel.name)}
    return able and channel.guess is None and not channel.constant and len(channel.sketch.t) > 40


def _named(channels: Mapping[str, ChannelInspection], quantity: str) -> list[ChannelInspection]:
    return [c for c in channels.values() if c.guess and c.guess.quantity == quantity]


def slope_agreement(rate: ChannelInspection, angle: ChannelInspection) -> float:
    """Correlation of a rate with the change of an angle; 0 where they have too little in common."""
    common = on_one_clock(rate.sketch, angle.sketch)
    if common is None:
        return 0.0
    _, (y, x), whole = common
    return signs.agreement(y, x, whole)[0]


@dataclass(frozen=True)
class Side:
    """Which side a rudder counts as positive, measured by a rate of turn.

    `strength` is their correlation as logged, `by` what of the rate it is with; `if_to` the side
    the rate is taken to be positive to.
    """

    side: Literal["starboard", "port"]
    strength: float
    if_to: Literal["starboard", "port"]
    by: str


def side(
    rudder: ChannelInspection,
    rate: ChannelInspection,
    if_to: str | None = None,
    beside: Sequence[ChannelInspection] = (),
) -> Side | None:
    """The side of a rudder against a rate of turn, or a heading; None where it is not clear.

    The rate is positive to `if_to`; None: by its format's convention, starboard where it has none.
    What else turns her stands `beside`.
    """
    found = _turning(rudder, rate, beside)
    if found is None or not found.sign:
        return None
    towards = if_to or (rate.guess.positive if rate.guess else None) or "starboard"
    to: Literal["starboard", "port"] = "port" if towards == "port" else "starboard"
    other: Literal["starboard", "port"] = "starboard" if to == "port" else "port"
    return Side(to if found.sign > 0 else other, found.correlation, to, found.words)


def turns_late(drive: ChannelInspection, rate: ChannelInspection) -> tuple[float, float] | None:
    """After what time [s] she answers a drive best, by both clocks, and the correlation then.

    None where the two have too little in common.
    """
    common = _with_rate(drive, rate, ())
    if common is None:
        return None
    period, (force, r), whole = common
    return signs.late_cause(force, r, whole, period)


def _with_rate(
    rudder: ChannelInspection, turning: ChannelInspection, beside: Sequence[ChannelInspection]
) -> tuple[float, list[Vector], Mask] | None:
    """Both on one clock, as `on_one_clock`, of a heading its slope, and what stands beside."""
    common = on_one_clock(rudder.sketch, turning.sketch, *(one.sketch for one in beside))
    if common is not None and turning.guess is not None and turning.guess.quantity == "psi":
        period, (delta, psi, *others), whole = common
        return period, [delta, np.gradient(psi), *others], whole
    return common


def turning_beside(rudder: ChannelInspection, turning: ChannelInspection) -> Vector | None:
    """How fast she turns where both were logged, in the unit of `turning`, of a heading its slope.

    (N,), without what lies in gaps; None where the two have too little in common.
    """
    common = _with_rate(rudder, turning, ())
    return None if common is None else common[1][1][common[2]]


def _turning(
    rudder: ChannelInspection, turning: ChannelInspection, beside: Sequence[ChannelInspection]
) -> Turning | None:
    """How the ship answers a rudder; None where the two have too little in common."""
    common = _with_rate(rudder, turning, beside)
    if common is None:
        return None
    period, (delta, r, *others), whole = common
    found = signs.answer_of(delta, r, whole, period, others)
    return found if found.sign or others else first_turn(delta, r, whole)


def unit_of_rate(rate: ChannelInspection, angle: ChannelInspection) -> str | None:
    """The unit of a rate that its angle, whose unit is known, leaves open; None where none fits."""
    common = on_one_clock(rate.sketch, angle.sketch)
    size = to_si(angle.stated_unit or angle.unit_by_size or "", "rad")
    if common is None or size is None:
        return None
    period, (y, x), whole = common
    factor = abs(_factor(y, x * size, period, whole))
    able = (*RATES, "rps")  # a name that ends so may mean either
    fitting = [unit for unit in able if 0.8 < factor / units.factor(unit, "rad/s") < 1.25]
    stated = rate.stated_unit
    return next((unit for unit in fitting if stated in (None, unit)), None)


def unit_of_speed(speed: ChannelInspection, stated: float) -> str | None:
    """The one unit in which she approaches as fast as stated [m/s]; None where it is not one."""
    return _one_unit(speed, FASTEST, stated)


def unit_by_way(speed: ChannelInspection, sailed: float) -> str | None:
    """The one unit in which it is usually as fast as her positions are sailed [m/s]; else None."""
    return _one_unit(speed, 0.5, sailed)


def _one_unit(speed: ChannelInspection, share: float, known: float) -> str | None:
    """The unit in which this share of the record is no faster than a known speed [m/s]."""
    if not len(speed.sketch.y):
        return None
    told = float(np.quantile(np.abs(speed.sketch.y), share))
    sizes = {unit: told * (to_si(unit, "m/s") or 0.0) for unit in SPEEDS}
    fitting = [unit for unit, size in sizes.items() if abs(size - known) <= NEAR * known]
    return fitting[0] if len(fitting) == 1 else None


def _factor(rate: Vector, angle: Vector, period: float, whole: Mask) -> float:
    """What to multiply a rate by to have the slope of the angle [rad/s], by least squares."""
    change = np.diff(angle) / period
    mean = (rate[1:] + rate[:-1]) / 2
    both = whole[1:] & whole[:-1]
    power = float(mean[both] @ mean[both])
    return float(mean[both] @ change[both]) / power if power else 0.0
