"""What manoeuvres of a record come to, with intervals, beside the fitted model's.

Angles are read from the recorded heading, through polynomials that take its noise off: white, by
third differences. What an order is uncertain by is part of every interval. Headings and
rates are those through the water: a current does not turn the ship. A wind does, and where the
model has one, overshoots are given without it.
"""

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.excursions import LATE, STEP, order_sample, ramp_doubt, rudder_of
from trialid.design.imo.recognise import UNSETTLED
from trialid.design.imo.recognition import Recognised
from trialid.design.imo.track_numbers import Around, foretold
from trialid.design.imo.trial_numbers import ManoeuvreNumber, Range
from trialid.design.prediction.sailed_numbers import Drift
from trialid.errors import DesignError
from trialid.trial import Trial
from trialid.white_noise import white_noise

NORMAL: Final = 1.96
STILL: Final = 6
"""Samples before it is seen to leave that tell the angle held."""
LAST: Final = 3
"""The part of a held rudder, the last of so many, in which a rate of turn has settled."""
REVERSED: Final = 0.3
"""Share of what the wind does to an overshoot that is left, one standard deviation: in calm air the
helmsman would have reversed at other times than he did. Of a 175 m ship in winds of 5, 8 and 10.7
m/s from eight sides, 10/10 and 20/20, 0.16 deg of 0.52 in the first overshoot, 0.17 of 0.62 in the
second."""
ORDINALS: Final = ("first", "second", "third", "fourth", "fifth", "sixth")
"""In words as the criteria have them; what comes after is counted."""

Value = tuple[float, float]
"""A number and its standard error."""
Read = Callable[[Vector, float], dict[str, Value]]
"""What is read from headings (N,) [rad] with noise of this standard deviation."""


def heading_numbers(
    trial: Trial, found: Sequence[Recognised], around: Around
) -> Iterator[ManoeuvreNumber]:
    """The numbers of every zig-zag, pull-out and spiral of a trial.

    Parameters
    ----------
    around
        The trial as the fitted ship sails it; without that nothing is predicted.
    """
    psi = trial.signals.get("psi")
    if psi is None:
        return  # the integral of a rate has its bias in it, and no white noise
    for one in (m for m in found if m.kind in READERS and m.remark != UNSETTLED):
        read, unit = READERS[one.kind](trial, one), UNITS[one.kind]
        try:
            values = read(psi, white_noise(psi[one.execute : one.end]))
        except DesignError:
            continue
        order = order_time(trial, one)
        predicted, off = _foretold(around, one, order, read)
        for name, (value, error) in values.items():
            known = predicted.get(name, (None, None))
            yield ManoeuvreNumber(
                trial=trial.name,
                kind=one.kind,
                t=order,
                rudder=one.rudder,
                name=name,
                unit=unit,
                measured=value,
                interval=(value - NORMAL * error, value + NORMAL * error),
                **_without_wind(value, error, off.get(name)),
                predicted=known[0],
                predicted_interval=known[1],
            )


def order_time(trial: Trial, one: Recognised) -> float:
    """When the order was given [s]: where the rudder's way to its angle began, by that way.

    Of a stop half a sample before the shaft was seen to have left its revolutions.
    """
    rudder = rudder_of(trial)
    if rudder is None or one.rudder == 0.0:
        return (one.execute - 0.5) * trial.period
    return order_sample(rudder[: one.end], one.execute, one.rudder) * trial.period


def _foretold(
    around: Around, one: Recognised, order: float, read: Read
) -> tuple[dict[str, tuple[float, Range | None]], dict[str, Drift]]:
    """The model's numbers; of a zig-zag in calm air, with what the wind did to them."""

    def numbers_of(track: Mapping[str, Vector]) -> dict[str, float]:
        return {n: x for n, (x, _) in read(track["psi"], 0.0).items()}

    def doubts(track: Mapping[str, Vector]) -> dict[str, float]:
        return {n: error for n, (_, error) in read(track["psi"], 0.0).items()}

    if one.kind != "zig-zag":  # a pull-out begins in a turn, a spiral settles in the wind
        around = replace(around, calm=None)
    return foretold(around, order, one.end + 1, numbers_of, doubts)


def _without_wind(value: float, error: float, off: Drift | None) -> dict[str, Any]:
    """An overshoot in calm air, with the range of what the wind did to it."""
    if off is None or off.range is None:
        return {}
    left = NORMAL * np.hypot(error, REVERSED * off.value)
    below, above = (float(np.hypot(left, end - off.value)) for end in off.range)
    calm = value + off.value
    return {
        "corrected": calm,
        "corrected_interval": (calm - below, calm + above),
        "corrected_for": "wind",
    }


def zigzag_reader(trial: Trial, one: Recognised) -> Read:
    """Every overshoot: how far the heading goes on from where the rudder was ordered over [rad].

    A leg that does not come back has none, and ends them.
    """
    rudder = rudder_of(trial)
    assert rudder is not None
    orders = [left_angle(rudder, k) for k in one.reversals]
    ends = [*one.reversals[1:], one.end]
    sides = [float(np.sign(rudder[max(k - 1, 0)])) for k in one.reversals]

    def read(psi: Vector, noise: float) -> dict[str, Value]:
        found = {}
        legs = zip(orders, ends, sides, strict=True)
        for place, ((at, doubt), end, side) in enumerate(legs):
            peak = _peak(side * psi[int(at) : end + 1], noise)
            if peak is None:
                break
            start, error, rate = _between(side * psi, at, noise)
            whole = float(np.sqrt(peak[1] ** 2 + error**2 + (doubt * rate) ** 2))
            found[f"{ordinal(place)} overshoot"] = peak[0] - start, whole
        return found

    return read


def ordinal(place: int) -> str:
    """The word for a place counted from 0.

    >>> ordinal(0), ordinal(6), ordinal(10), ordinal(20), ordinal(21)
    ('first', '7th', '11th', '21st', '22nd')
    """
    if place < len(ORDINALS):
        return ORDINALS[place]
    number = place + 1
    ending = "th" if 10 < number % 100 < 14 else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def left_angle(rudder: Vector, k: int) -> tuple[float, float]:
    """Sample, with its fraction, at which a rudder left the angle it is below from `k` on.

    And its standard deviation. The way there is a ramp, by its crossing of midships; where it is a
    step, half a sample before.
    """
    side = np.sign(np.median(rudder[max(k - STILL, 0) : max(k, 1)]))
    over = np.flatnonzero(rudder[k:] * side <= 0.0)
    steps = int(over[0]) if len(over) else 0
    fall = abs(float(rudder[k] - rudder[k + steps]))
    if fall == 0.0:
        return k - 0.5, STEP
    span = max(STILL, steps)  # a fifth of it is the way at most
    flat = rudder[max(k - span, 0) : max(k, 1)]
    back = abs(float(np.median(flat)) - float(rudder[k])) * steps / fall
    at = float(np.clip(k - back, k - max(LATE, steps), k))
    return at, ramp_doubt(rudder[k : k + steps + 1], flat)


def pull_out_reader(trial: Trial, one: Recognised) -> Read:
    """The rate of turn that stays with the rudder midships [rad/s]; none of a stable ship."""
    first = one.end - (one.end - one.execute) // LAST

    def read(psi: Vector, noise: float) -> dict[str, Value]:
        return {"residual rate of turn": _rate(psi, first, one.end, noise, trial.period)}

    return read


def spiral_reader(trial: Trial, one: Recognised) -> Read:
    """The rate of turn that each angle settles to [rad/s]."""
    rudder = rudder_of(trial)
    assert rudder is not None
    degrees = np.round(np.rad2deg(rudder[one.execute : one.end]))
    edges = np.flatnonzero(np.abs(np.diff(degrees)) > 1.0) + 1
    stops = [one.execute, *(one.execute + edges).tolist(), one.end]

    def read(psi: Vector, noise: float) -> dict[str, Value]:
        found = {}
        for begin, end in itertools.pairwise(stops):
            first = end - (end - begin) // LAST
            if end - first >= 10:
                angle = float(np.rad2deg(np.median(rudder[first:end])))
                found[f"rate at {angle:+.0f} deg"] = _rate(psi, first, end, noise, trial.period)
        return found

    return read


READERS: Final[Mapping[str, Callable[[Trial, Recognised], Read]]] = {
    "zig-zag": zigzag_reader,
    "pull-out": pull_out_reader,
    "spiral": spiral_reader,
}
UNITS: Final = {"zig-zag": "rad", "pull-out": "rad/s", "spiral": "rad/s"}


def _peak(y: Vector, noise: float) -> Value | None:
    """Height of a peak and its error, by a quartic about it; None where it has not come back.

    Through an eighth of the leg to either side where there is noise to take off, which is at most
    0.01 deg off in overshoots of 9 deg (a cubic 0.03, for she swings out faster than back).
    """
    top = int(np.argmax(y))
    wide = len(y) // 8 if noise > 0.0 else 0
    reach = max(min(top, len(y) - 1 - top, max(wide, 2)), 0)
    if not 0 < top < len(y) - 1 or reach < 1:
        return None
    x = np.arange(-reach, reach + 1.0)
    A = np.vander(x, min(len(x), 5))
    shape = np.linalg.lstsq(A, y[top - reach : top + reach + 1], rcond=None)[0]
    at = _highest(shape, reach)
    row = at ** np.arange(len(shape) - 1.0, -1.0, -1.0)
    error = noise * float(np.sqrt(row @ np.linalg.pinv(A.T @ A) @ row))
    return float(row @ shape), error


def _highest(shape: Vector, reach: int) -> float:
    """Where a polynomial is highest within a reach of 0."""
    flat = np.roots(np.polyder(shape))
    inside = flat[(flat.imag == 0.0) & (np.abs(flat.real) <= reach)].real
    places = np.array([-reach, *inside, reach])
    return float(places[np.argmax(np.polyval(shape, places))])


def _between(y: Vector, at: float, noise: float) -> tuple[float, float, float]:
    """A value between samples by a cubic, its error, and the slope a sample."""
    reach = 3 if noise > 0.0 else 1
    first, last = max(int(at) - reach, 0), min(int(at) + reach + 2, len(y))
    x = np.arange(first, last) - at
    A = np.vander(x, min(len(x), 4))
    *_, slope, value = np.linalg.lstsq(A, y[first:last], rcond=None)[0]
    error = noise * float(np.sqrt(np.linalg.pinv(A.T @ A)[-1, -1]))
    return float(value), error, float(abs(slope))


def _rate(psi: Vector, first: int, end: int, noise: float, period: float) -> Value:
    """Slope of the heading by a line and its error [rad/s]."""
    x = period * np.arange(end - first)
    A = np.vander(x, 2)
    slope = float(np.linalg.lstsq(A, psi[first:end], rcond=None)[0][0])
    return slope, noise * float(np.sqrt(np.linalg.pinv(A.T @ A)[0, 0]))
