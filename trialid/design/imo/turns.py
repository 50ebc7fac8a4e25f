"""Turning circles that a record with a track holds, measured beside those of the fitted model."""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage
from trialid.design.imo import measures
from trialid.design.imo.sailed_trial import Numbers, numbers, sail_trial
from trialid.design.likely_spread import LikelySpread, Range
from trialid.effects.track import CURRENT
from trialid.errors import DesignError
from trialid.identification.fit import Fit, of_trial
from trialid.trial import Trial

NEEDED: Final = ("x", "y", "psi")
PLATEAU: Final = 0.7
"""Share of the rudder's angle from which it is hard over."""

LEFT: Final = 0.1
"""Share of that angle beyond which the rudder has left midships."""

APPROACH: Final = 10
"""Samples before the order that tell the course, ..."""

STRAIGHT: Final = float(np.deg2rad(3.0))
"""... within which the heading may spread: a turn out of another manoeuvre has no advance."""

FEW_GAPS: Final = 0.1
"""Share of a turn in which the position may be missing."""

DRAWS: Final = 400
"""Of noise, timing and current; the interval's width is known to 4 % by so many."""


@dataclass(frozen=True, kw_only=True)
class Turn:
    """A turn by a held rudder, recognised: order at `t` [s], angle [rad], samples it spans.

    `course` is the mean heading before the order [rad].
    """

    t: float
    rudder: float
    begin: int
    end: int
    course: float


@dataclass(frozen=True, kw_only=True)
class TurnMeasure:
    """One measure of a turn [m]; None where there is nothing to know it from.

    Attributes
    ----------
    measured, interval
        As recorded, over the ground, with its 95 %: noise of position and heading, and half a
        sample of the order.
    corrected, corrected_interval
        The same through the water, by the current that the fit found, with its error.
    predicted, predicted_interval
        Of the fitted model through the water, under the rudder as recorded, and where the true
        ship's is likely to lie.
    """

    trial: str
    t: float
    rudder: float
    name: str
    measured: float
    interval: tuple[float, float]
    corrected: float | None = None
    corrected_interval: tuple[float, float] | None = None
    predicted: float | None = None
    predicted_interval: Range | None = None


@dataclass(frozen=True)
class Water:
    """The current of a trial, north and east, and its standard errors [m/s]; None: unknown."""

    speed: tuple[float, float]
    error: tuple[float, float] | None


def find_turns(trial: Trial) -> Iterator[Turn]:
    """Turns of 180 deg and more by a rudder held to one side, out of a straight course."""
    rudder = trial.signals.get("delta_order", trial.signals.get("delta"))
    if rudder is None or not {*NEEDED} <= {*trial.signals}:
        return
    largest = float(np.quantile(np.abs(rudder), 0.95))
    hard = np.where(np.abs(rudder) >= PLATEAU * largest, np.sign(rudder), 0.0)
    edges = [0, *(np.flatnonzero(np.diff(hard)) + 1).tolist(), len(hard)]
    psi = trial.signals["psi"]
    for first, end in itertools.pairwise(edges):
        side = hard[first]
        if side == 0.0 or side * (psi[end - 1] - psi[first]) < np.pi:
            continue
        turn = _ordered(trial, rudder, first, end)
        if turn is not None and _seen(trial, turn):
            yield turn


def _ordered(trial: Trial, rudder: Vector, first: int, end: int) -> Turn | None:
    """When the rudder left midships for the angle that it holds from `first` on."""
    held = float(np.median(rudder[first:end]))
    last = first
    while last > 0 and rudder[last - 1] / held > LEFT:
        last -= 1
    if last < APPROACH:
        return None
    course = trial.signals["psi"][last - APPROACH : last]
    if np.ptp(course) > 2.0 * STRAIGHT:
        return None
    t = _left_midships(rudder / held, last, first) * trial.period
    return Turn(t=t, rudder=held, begin=last - 1, end=end, course=float(np.mean(course)))


def _left_midships(share: Vector, last: int, first: int) -> float:
    """Sample, with its fraction, at which a ramp began; half a sample before where it is a step."""
    before = float(np.median(share[last - APPROACH : last]))
    rise = share[first] - share[last]
    if first == last or rise <= 0.0:
        return last - 0.5
    ramp = rise / (first - last)
    return float(np.clip(last - (share[last] - before) / ramp, last - 1.0, last))


def _seen(trial: Trial, turn: Turn) -> bool:
    """Whether positions and heading are there where the turn is."""
    span = slice(turn.begin, turn.end)
    valid = np.all([trial.valid[n][span] for n in NEEDED], axis=0)
    return bool(np.mean(~valid) < FEW_GAPS and valid[0])


def measure(turn: Turn, t: Vector, track: Mapping[str, Vector]) -> dict[str, float]:
    """Advance, transfer and tactical diameter [m] of a track `x`, `y`, `psi`; (N,) each.

    Raises
    ------
    DesignError
        The heading does not change by 180 deg.
    """
    parts = {n: track[n][turn.begin : turn.end].copy() for n in NEEDED}
    for n in ("x", "y"):
        parts[n][0] = np.interp(turn.t, t, track[n])
    parts["psi"][0] = turn.course
    order = np.full(len(parts["x"]), turn.rudder)
    trial = Trial("turn", "fit", 1.0, {"psi": parts["psi"], "delta_order": order}, {})
    return measures.turning(Passage(trial, parts["x"], parts["y"], None))


def turns(
    fit: Fit, errors: Mapping[str, float], spread: LikelySpread | None = None
) -> tuple[TurnMeasure, ...]:
    """Every measure of every turning circle in the trials of a fit, to fit and to check.

    Parameters
    ----------
    errors
        Standard errors of the unknowns by name.
    spread
        What a prediction is uncertain by; without it there is none.
    """
    return tuple(one for s in fit.scores for one in _of_trial(fit, s.trial, errors, spread))


def _of_trial(
    fit: Fit, trial: Trial, errors: Mapping[str, float], spread: LikelySpread | None
) -> Iterator[TurnMeasure]:
    found = list(find_turns(trial))
    water = _water(fit, trial, errors) if found else None
    sailed = sail_trial(fit, trial, spread) if found and spread is not None else None
    for turn in found:
        predicted = {} if sailed is None else numbers(sailed, reader(turn, trial))
        try:
            yield from _measured(turn, trial, water, predicted)
        except DesignError:
            continue  # the noise of the heading took the last degree


def _water(fit: Fit, trial: Trial, errors: Mapping[str, float]) -> Water | None:
    values, _ = of_trial(fit.problem, fit.theta, trial, fit.level)
    if not {*CURRENT} <= {*values}:
        return None
    north, east = (values[n] for n in CURRENT)
    own = [errors.get(f"{n} [{trial.name}]") for n in CURRENT]
    known = None if own[0] is None or own[1] is None else (own[0], own[1])
    return Water((north, east), known)


def reader(turn: Turn, trial: Trial) -> Numbers:
    """What reads the measures of a turn from a track through it, with the course of that track."""

    def read(track: Mapping[str, Vector]) -> dict[str, float]:
        course = float(np.mean(track["psi"][turn.begin + 1 - APPROACH : turn.begin + 1]))
        return measure(replace(turn, course=course), trial.t, track)

    return read


def _measured(
    turn: Turn,
    trial: Trial,
    water: Water | None,
    predicted: Mapping[str, tuple[float, Range | None]],
) -> Iterator[TurnMeasure]:
    track = {n: trial.signals[n] for n in NEEDED}
    plain = measure(turn, trial.t, track)
    spread = _spread(turn, trial, track, None)
    through, width = dict[str, float](), dict[str, float]()
    if water is not None:
        track = through_water(track, trial.t, water.speed)
        through = measure(turn, trial.t, track)
        width = _spread(turn, trial, track, water.error) if water.error is not None else {}
    for name, value in plain.items():
        yield TurnMeasure(
            trial=trial.name,
            t=turn.t,
            rudder=turn.rudder,
            name=name,
            measured=value,
            interval=(value - spread[name], value + spread[name]),
            corrected=through.get(name),
            corrected_interval=_about(through.get(name), width.get(name)),
            predicted=predicted.get(name, (None, None))[0],
            predicted_interval=predicted.get(name, (None, None))[1],
        )


def _about(value: float | None, reach: float | None) -> tuple[float, float] | None:
    return None if value is None or reach is None else (value - reach, value + reach)


def through_water(
    track: Mapping[str, Vector], t: Vector, speed: tuple[float, float]
) -> dict[str, Vector]:
    """A track through the water, from that over the ground and the current [m/s]."""
    north, east = speed
    return {**track, "x": track["x"] - north * t, "y": track["y"] - east * t}


def _spread(
    turn: Turn, trial: Trial, track: Mapping[str, Vector], current: tuple[float, float] | None
) -> dict[str, float]:
    """Half a 95 % interval of each measure [m], by drawing all that is uncertain once more."""
    rng = np.random.default_rng(0)
    noise = {n: _noise(track[n][turn.begin : turn.end]) for n in NEEDED}
    drawn: dict[str, list[float]] = {}
    for _ in range(DRAWS):
        there = {n: x + noise[n] * rng.standard_normal(len(x)) for n, x in track.items()}
        if current is not None:
            north, east = (e * rng.standard_normal() for e in current)
            there = through_water(there, trial.t - turn.t, (north, east))
        late = turn.t + trial.period * rng.uniform(-0.5, 0.5)
        course = turn.course + noise["psi"] * rng.standard_normal() / np.sqrt(APPROACH)
        try:
            found = measure(replace(turn, t=late, course=course), trial.t, there)
        except DesignError:
            continue
        for name, value in found.items():
            drawn.setdefault(name, []).append(value)
    return {n: 1.96 * float(np.std(x)) for n, x in drawn.items()}


def _noise(y: Vector) -> float:
    """Standard deviation of what is white in a smooth motion, by its third differences."""
    return float(np.std(np.diff(y, 3))) / np.sqrt(20.0) if len(y) > 8 else 0.0
