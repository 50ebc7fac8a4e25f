"""Turning circles that a record with a track holds, measured beside those of the fitted model."""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage
from trialid.design.imo import measures
from trialid.design.imo.excursions import (
    LATE,
    SteeredRecord,
    given_back,
    is_held,
    order_sample,
    rudder_of,
)
from trialid.design.imo.recognise import recognise
from trialid.design.imo.sailed_trial import Numbers, numbers, sail_trial
from trialid.design.imo.trial_numbers import Range, TurnMeasure
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.effects.track import CURRENT
from trialid.errors import DesignError
from trialid.identification.fit import Fit, of_trial
from trialid.trial import Trial

NEEDED: Final = ("x", "y", "psi")
APPROACH: Final = 10
"""Samples before the order that tell the course."""

SAGITTA: Final = 0.005
"""Share of the turn's own size by which a straight line over a gap in its positions may be off the
arc: an eighth of the chord times the angle turned. Of 60 circles of a 175 m ship with 1 m of noise
and a gap of up to 0.3 of the turn, 8 are taken and the worst number is off by 1.5 %; by half of it
6 and 1.1 %, by twice 13 and 1.8 %."""

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


@dataclass(frozen=True)
class Water:
    """The current of a trial, north and east, and its standard errors [m/s]; None: unknown."""

    speed: tuple[float, float]
    error: tuple[float, float] | None


def find_turns(trial: Trial) -> Iterator[Turn]:
    """Turns of 180 deg and more by a rudder held to one side, out of a straight course."""
    rudder = rudder_of(trial)
    if rudder is None or not {*NEEDED} <= {*trial.signals}:
        return
    record = SteeredRecord(trial, rudder, trial.signals["psi"], APPROACH)
    for one in record.excursions:
        if not is_held(one) or record.turned(one) < np.pi:
            continue
        t = order_sample(rudder[: one.end], one.begin, one.angle)
        begin, course = int(t), record.straight(int(t))
        if course is None:
            continue
        end = given_back(record, one, one.end)
        turn = Turn(t=t * trial.period, rudder=one.angle, begin=begin, end=end, course=course)
        if _seen(trial, turn):
            yield turn


def _seen(trial: Trial, turn: Turn) -> bool:
    """Whether positions and heading are there where the turn is, but for gaps that bridge well."""
    span = slice(turn.begin, turn.end)
    valid = np.all([trial.valid[n][span] for n in NEEDED], axis=0)
    if not valid[0]:
        return False
    x, y, psi = (trial.signals[n][span] for n in NEEDED)
    there = np.flatnonzero(valid)
    gaps = [(a, b) for a, b in itertools.pairwise(there.tolist()) if b > a + 1]
    off = [np.hypot(x[b] - x[a], y[b] - y[a]) * abs(psi[b] - psi[a]) / 8.0 for a, b in gaps]
    size = np.hypot(np.ptp(x[there]), np.ptp(y[there]))
    return bool(max(off, default=0.0) <= SAGITTA * size and there[-1] >= len(valid) - 2)


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
    size = fit.model.ship.particulars
    spirals = [m for m in recognise(trial, size["L"], size["U0"]) if m.kind == "spiral"]
    parts = [range(m.execute - LATE, m.end) for m in spirals]
    found = [turn for turn in find_turns(trial) if not any(turn.begin in part for part in parts)]
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
