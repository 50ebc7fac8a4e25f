"""Numbers of a manoeuvre that are read from its track: as recorded, corrected, and the model's.

Corrected for the current that the fit found, and for the wind where the model has one: by what the
model drifts with and without it under the recorded rudder. Intervals hold the noise of position,
heading and logged speed, taken as white, what the order is uncertain by, the current's error and
the drift's own range. What the same ship does on another day they do not hold.
"""

import contextlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.calm_air import FromOrder
from trialid.design.imo.excursions import STEP
from trialid.design.imo.sailed_trial import Numbers, SailedTrial, Track
from trialid.design.imo.trial_numbers import Range
from trialid.design.prediction.sailed_numbers import Drift, drift, numbers
from trialid.design.prediction.unexplained_motion import UnexplainedMotion
from trialid.errors import DesignError
from trialid.trial import Trial
from trialid.white_noise import white_noise

DRAWS: Final = 400
"""Of noise, timing and current; the interval's width is known to 4 % by so many."""
NORMAL: Final = 1.96
LOGGED: Final = ("x", "y", "psi", "u")
"""What is read, where it is there."""

Read = Callable[[Track, Vector, float], dict[str, float]]


@dataclass(frozen=True)
class TrackReader:
    """What reads numbers from the part of a track that a manoeuvre spans.

    Attributes
    ----------
    span, order
        Samples of it, and when the order was given [s].
    units
        Of the numbers, by name.
    read
        Takes that part, its clock [s], and by how much later [s] the order is taken to be;
        DesignError where there is nothing to read.
    doubt
        Standard deviation of the order [samples].
    """

    span: slice
    order: float
    units: Mapping[str, str]
    read: Read
    doubt: float = STEP


@dataclass(frozen=True)
class Water:
    """The current of a trial, north and east, and its standard errors [m/s]; None: unknown.

    `in_log`: the speed that was logged is over the ground, and has it too.
    """

    speed: tuple[float, float]
    error: tuple[float, float] | None
    in_log: bool = False


@dataclass(frozen=True, kw_only=True)
class Around:
    """What acts on a trial besides the ship: its current, and the model with the wind and without.

    None where the fit knows no current, where nothing is predicted, where the model has no wind.

    Attributes
    ----------
    calm
        Sails on from an order [s] up to a sample in the wind and without; None where she cannot.
    unexplained
        What fitted trials did beyond the model.
    """

    water: Water | None = None
    sailed: SailedTrial | None = None
    calm: Callable[[float, int], FromOrder | None] | None = None
    unexplained: UnexplainedMotion | None = None

    @property
    def words(self) -> str:
        """What numbers are corrected for; empty where for nothing."""
        causes = (("current", self.water), ("wind", self.calm))
        return " and ".join(name for name, known in causes if known is not None)


def track_numbers(reader: TrackReader, trial: Trial, around: Around) -> dict[str, dict[str, Any]]:
    """Each number by name: fields of its row, from `measured` to `predicted_interval`.

    Raises
    ------
    DesignError
        The record does not come so far.
    """
    track = {n: trial.signals[n][reader.span] for n in LOGGED if _is_read(trial, n, reader.span)}
    t = trial.t[reader.span]
    plain, spread = reader.read(track, t, 0.0), _spread(reader, t, track, trial.period, None)
    through = {n: (x, spread.get(n)) for n, x in plain.items()}
    if around.water is not None:
        through = _through(reader, t, track, trial.period, around.water)

    def read(whole: Track) -> dict[str, float]:
        return reader.read({n: x[reader.span] for n, x in whole.items()}, t, 0.0)

    def doubts(whole: Track) -> dict[str, float]:
        return _by_timing(reader, t, {n: x[reader.span] for n, x in whole.items()}, trial.period)

    predicted, off = foretold(around, reader.order, reader.span.stop, read, doubts)
    found = {}
    for name, value in plain.items():
        half, own = spread.get(name), predicted.get(name, (None, None))
        if half is not None:
            ends = {"measured": value, "interval": (value - half, value + half)}
            known = _without_wind(through.get(name), around, off.get(name))
            found[name] = {**ends, **known, "predicted": own[0], "predicted_interval": own[1]}
    return found


def foretold(
    around: Around, order: float, end: int, read: Numbers, doubts: Numbers
) -> tuple[dict[str, tuple[float, Range | None]], dict[str, Drift]]:
    """The model's numbers of a manoeuvre by name, in calm air, and what the wind did to them.

    Parameters
    ----------
    order, end
        When it was ordered [s], and the sample up to which it is read.
    doubts
        Standard errors of the numbers of a track by when the order was given.
    """
    if around.calm is None:
        plain = around.sailed
        return {} if plain is None else _numbers(around, plain, order, read, doubts), {}
    sailed = around.calm(order, end)
    if sailed is None:
        return {}, {}
    known = _numbers(around, sailed.calm, order, read, doubts)
    return known, drift(sailed.windy, sailed.calm, read)


def _numbers(
    around: Around, sailed: SailedTrial, order: float, read: Numbers, doubts: Numbers
) -> dict[str, tuple[float, Range | None]]:
    """The model's numbers with the range of a single run, whenever the order was given."""
    try:
        beyond = dict(doubts(sailed.track))
        if around.unexplained is not None:
            begin = int(order / around.unexplained.period)
            for n, x in around.unexplained.errors(read, sailed.track, begin).items():
                beyond[n] = float(np.hypot(beyond.get(n, 0.0), x))
    except DesignError:
        return {}
    return numbers(sailed, read, beyond)


def _is_read(trial: Trial, name: str, span: slice) -> bool:
    """Whether a signal is there; a log of the speed only where it is so throughout."""
    return name in trial.signals and (name != "u" or bool(trial.valid[name][span].all()))


def _through(
    reader: TrackReader, t: Vector, track: Track, period: float, water: Water
) -> dict[str, tuple[float, float | None]]:
    """Through the water, each with half its interval, None where the current's error is unknown."""
    through = through_water(track, t, water.speed)
    width = {} if water.error is None else _spread(reader, t, through, period, water.error)
    return {n: (x, width.get(n)) for n, x in reader.read(through, t, 0.0).items()}


def _without_wind(
    known: tuple[float, float | None] | None, around: Around, off: Drift | None
) -> dict[str, Any]:
    """The corrected number with its interval, the wind's drift taken off where it is known."""
    words = around.words
    if known is None or not words or (around.calm is not None and off is None):
        return {}
    value, half = known
    below = above = half
    if off is not None:
        value += off.value
        spans = (None, None) if off.range is None else np.abs(np.subtract(off.range, off.value))
        below, above = (
            None if half is None or s is None else float(np.hypot(half, s)) for s in spans
        )
    ends: Range | None = None
    if below is not None and above is not None:
        ends = value - below, value + above
    return {"corrected": value, "corrected_interval": ends, "corrected_for": words}


def through_water(track: Track, t: Vector, speed: tuple[float, float]) -> dict[str, Vector]:
    """A track through the water, from that over the ground and the current [m/s]."""
    north, east = speed
    return {**track, "x": track["x"] - north * t, "y": track["y"] - east * t}


def _spread(
    reader: TrackReader,
    t: Vector,
    track: Track,
    period: float,
    current: tuple[float, float] | None,
) -> dict[str, float]:
    """Half a 95 % interval of each number, by drawing all that is uncertain once more."""
    rng = np.random.default_rng(0)
    sizes = {n: white_noise(x) for n, x in track.items()}
    drawn: dict[str, list[float]] = {}
    for _ in range(DRAWS):
        there = {n: x + sizes[n] * rng.standard_normal(len(x)) for n, x in track.items()}
        if current is not None:
            north, east = (e * rng.standard_normal() for e in current)
            there = through_water(there, t - reader.order, (north, east))
        with contextlib.suppress(DesignError):
            for name, value in reader.read(there, t, 0.0).items():
                drawn.setdefault(name, []).append(value)
    known = {n: float(np.std(x)) for n, x in drawn.items() if len(x) > DRAWS // 2}
    late = _by_timing(reader, t, track, period)
    return {n: NORMAL * float(np.hypot(x, late.get(n, 0.0))) for n, x in known.items()}


def _by_timing(reader: TrackReader, t: Vector, track: Track, period: float) -> dict[str, float]:
    """Standard deviation of each number by an order that may be somewhat off.

    By itself: between samples a noisy track is smoother, and draws of both would be too narrow.
    """
    try:
        early, late = (reader.read(track, t, side * period) for side in (-0.5, 0.5))
    except DesignError:
        return {}
    return {n: abs(x - early[n]) * reader.doubt for n, x in late.items()}
