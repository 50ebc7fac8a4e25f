"""What the rudder of a record did: excursions to either side, and the course before each."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask, Vector
from trialid.trial import Trial
from trialid.white_noise import white_noise

Indices = NDArray[np.intp]

MIDSHIPS: Final = float(np.deg2rad(3.0))
"""Rudder within which a course is kept. Here and below, on 15 simulated days with 65 manoeuvres
(all found and bounded right, no name besides): by half of it 53 are found and 16 named besides, for
an autopilot's rudder then is one; by twice 65 and 1."""
LEAST: Final = float(np.deg2rad(4.5))
"""A rudder that is held by less executes no manoeuvre: the smallest standard angle is 5 deg. Half
and twice change nothing on those days."""
ALIKE: Final = 0.15
"""Share by which angles of one manoeuvre may differ, and the rudder while it is held. By half of it
no name is wrong on those days, by twice 1 is."""
HELD: Final = 0.9
"""Share of the samples, from the first to the last at the angle, at which the rudder is there."""
STRAIGHT: Final = float(np.deg2rad(3.0))
"""From the middle of the headings before the order; a turn out of another one has no advance. The
lengths below change nothing on those days by half and twice; this changes where a Williamson turn
ends, which 11 then do elsewhere."""
SHORTEST: Final = 3
"""Samples that show how fast she turned, where the record begins with the order: of seven zig-zags
in a tank, recorded from a second before it, six are known so (the seventh is a 5/1), by half as
well, by twice three; a compass of 0.2 deg leaves 0.14 deg a sample open then."""
SLOWEST_GEAR: Final = 2.0 * 6.0 / (65.0 / 28.0)
"""[s] Twice what SOLAS leaves a gear for the 6 deg about midships: 65 deg in 28 s."""
LATE: Final = 10
"""Samples by which a rudder may have left an angle before it is seen to."""
KEEPING: Final = 0.25
"""Share of the angle below which a rudder may still keep the course: 9 deg of 35 in a strong wind.
With half and twice of it the orders of four turning tests in wind come out within 1.4 s; a rudder
of up to 8 deg to the side of the turn had one of them ordered 14 s too early."""
LENGTHS: Final = 1.0
"""Ship lengths of straight course before the order."""
STEP: Final = float(1.0 / np.sqrt(12.0))
"""Standard deviation of an order that lies anywhere between two samples."""
STRAIGHT_RAMP: Final = 2
"""Samples on a rudder's way from which on its shape shows."""


@dataclass(frozen=True)
class Excursion:
    """Samples from `begin` to before `end` in which the rudder is to one side; the angle [rad]."""

    begin: int
    end: int
    angle: float
    held: float
    """Share of the time from where it reaches that angle to where it leaves it."""


def heading(trial: Trial) -> Vector | None:
    """Heading as recorded, or the integral of the rate of turn [rad]; (N,)."""
    if "psi" in trial.signals:
        return trial.signals["psi"]
    if "r" not in trial.signals:
        return None
    r = trial.signals["r"]
    return np.concatenate([[0.0], np.cumsum((r[1:] + r[:-1]) / 2.0) * trial.period])


def rudder_of(trial: Trial) -> Vector | None:
    """The rudder's order, or its angle where no order is recorded [rad]; (N,)."""
    return trial.signals.get("delta_order", trial.signals.get("delta"))


class SteeredRecord:
    """A trial's rudder and heading, cut into excursions; `clock` samples make a ship length."""

    def __init__(self, trial: Trial, rudder: Vector, psi: Vector, clock: int) -> None:
        self.trial, self.rudder, self.psi, self.clock = trial, rudder, psi, clock
        self.excursions = list(excursions(rudder))

    def straight(self, begin: int) -> float | None:
        """The mean heading of the course before a sample; None where it was none.

        A record that begins less than a length before shows it by how fast she turned meanwhile.
        """
        span = round(LENGTHS * self.clock)
        before = self.psi[max(begin - span, 0) : begin]
        if len(before) < SHORTEST or np.ptp(before) > 2.0 * STRAIGHT:
            return None
        slope = np.polyfit(np.arange(len(before)), before, 1)[0]
        if len(before) < span and abs(slope) * span > 2.0 * STRAIGHT:
            return None
        return float(np.mean(before))

    def turned(self, one: Excursion) -> float:
        """How far the heading went to the side of the rudder, up to where it was given back."""
        last = min(one.end, len(self.psi) - 1)
        return float(np.sign(one.angle) * (self.psi[last] - self.psi[one.begin]))


def excursions(rudder: Vector) -> Iterator[Excursion]:
    """What the rudder did to one side or the other, each from and to midships; (N,) [rad].

    All at once: a restless rudder leaves midships 15 000 times in a log of six hours.
    """
    side = np.where(np.abs(rudder) > MIDSHIPS, np.sign(rudder), 0.0)
    edges = np.array([0, *(np.flatnonzero(np.diff(side)) + 1), len(side)])
    away = np.flatnonzero(side[edges[:-1]]) if len(rudder) else np.zeros(0, dtype=int)
    if not len(away):
        return
    begins, sizes = edges[away], np.diff(edges)[away]
    firsts = np.cumsum(sizes) - sizes
    one = np.repeat(np.arange(len(away)), sizes)
    angles = np.abs(rudder[side != 0.0])
    usual = _angles(angles[np.lexsort((angles, one))], firsts, sizes, one)
    there = np.abs(angles - usual[one]) <= np.maximum(ALIKE * usual, MIDSHIPS / 3.0)[one]
    for k, held in enumerate(_shares(there, firsts, sizes)):
        begin = int(begins[k])
        angle = float(side[begin] * usual[k])
        yield Excursion(begin, begin + int(sizes[k]), angle, float(held))


def _angles(ordered: Vector, firsts: Indices, sizes: Indices, one: Indices) -> Vector:
    """The middle of the largest angles of each excursion; `ordered` (N,) are so within each."""
    place = 0.95 * (sizes - 1.0)
    below = firsts + place.astype(int)
    above = np.minimum(below + 1, firsts + sizes - 1)
    high = ordered[below] + (ordered[above] - ordered[below]) * (place - np.floor(place))
    large = np.add.reduceat(ordered >= 0.8 * high[one], firsts, dtype=int)
    last = firsts + sizes - 1
    return (ordered[last - large // 2] + ordered[last - (large - 1) // 2]) / 2.0


def _shares(there: Mask, firsts: Indices, sizes: Indices) -> Vector:
    """Share of the samples there, from the first such to the last, of each excursion."""
    counts = np.add.reduceat(there, firsts, dtype=int)
    at = np.flatnonzero(there)
    last = np.cumsum(counts)
    known = counts > 2
    span = np.ones(len(sizes))
    span[known] = at[last[known] - 1] - at[(last - counts)[known]] + 1.0
    return np.where(known, counts / span, 0.0)


def is_held(one: Excursion) -> bool:
    """Whether it is one angle, and not one that keeps a course."""
    return one.held >= HELD and abs(one.angle) >= LEAST


def reverses(record: SteeredRecord, last: Excursion, one: Excursion, angle: float) -> bool:
    """Whether one follows another at once, to the other side, by an angle [rad] or nearly so."""
    near = (one.begin - last.end) * record.trial.period <= SLOWEST_GEAR
    alike = abs(abs(one.angle) - abs(angle)) <= ALIKE * abs(angle)
    return near and alike and one.angle * last.angle < 0.0


def given_back(record: SteeredRecord, last: Excursion, before: int) -> int:
    """The sample, before another, at which the rudder first left its angle; noise is one sample."""
    side, near = np.sign(last.angle), (1.0 - ALIKE) * abs(last.angle)
    there = record.rudder[last.begin : before] * side >= near
    reached = int(np.argmax(there))
    left = np.flatnonzero(~there[reached:-1] & ~there[reached + 1 :])
    return last.begin + reached + int(left[0]) if len(left) else before


@dataclass(frozen=True)
class Ramp:
    """A rudder's way from near midships to its angle, `begin` to `end`, and what is before it."""

    begin: int
    end: int
    flat: slice


def order_sample(rudder: Vector, k: int, angle: float) -> float:
    """Sample, with its fraction, at which a rudder left midships that is beyond them from `k` on.

    Its way to the angle is a ramp and told back to where it was; half a sample before `k` where it
    is a step. A rudder to the same side that kept the course before is no part of it.
    """
    ramp = _ramp_to(np.sign(angle) * rudder, k, abs(angle))
    first, last = float(rudder[ramp.begin]), float(rudder[ramp.end])
    steps = ramp.end - ramp.begin
    if not steps:
        return ramp.begin - 0.5
    back = (first - float(np.median(rudder[ramp.flat]))) * steps / (last - first)
    return float(np.clip(ramp.begin - back, ramp.begin - max(LATE, steps), ramp.begin))


def order_doubt(rudder: Vector, k: int, angle: float) -> float:
    """Standard deviation of that [samples].

    Of 100 circles sampled each 2 s, orders at any time between, the advance then holds in 98, 94
    and 91 % with 0, 0.3 and 1 deg of noise on the rudder; by half a sample in 100 % and three times
    as wide.
    """
    ramp = _ramp_to(np.sign(angle) * rudder, k, abs(angle))
    return ramp_doubt(rudder[ramp.begin : ramp.end + 1], rudder[ramp.flat])


def ramp_doubt(way: Vector, flat: Vector) -> float:
    """Standard deviation of where a rudder's way began [samples]: anywhere between two for a step.

    Else two single angles make the ramp, each off by what angles lie off it or scatter before.
    """
    steps = len(way) - 1
    if steps < STRAIGHT_RAMP:
        return STEP
    rate = float(way[-1] - way[0]) / steps
    bent = float(np.sqrt(np.mean((way - way[0] - rate * np.arange(steps + 1)) ** 2)))
    return float(min(np.sqrt(2.0) * max(bent, white_noise(flat)) / abs(rate), LATE))


def _ramp_to(ahead: Vector, k: int, angle: float) -> Ramp:
    """The way to an angle, both to the same side; it ends where it begins where it is a step."""
    reached = k + int(np.argmax(ahead[k:] >= (1.0 - ALIKE) * angle))
    keeping = np.flatnonzero(ahead[k:reached] < max(MIDSHIPS, KEEPING * angle))
    k += int(keeping[-1]) + 1 if len(keeping) else 0
    reached = reached if ahead[reached] > ahead[k] else k
    span = max(LATE, 2 * (reached - k))  # so that the way itself is the lesser part of it
    return Ramp(k, reached, slice(max(k - span, 0), max(k - 1, 1)))
