"""What is known of a nuisance before any record is seen: weakly, from sensors and from the start.

Biases, the rudder's zero, delays and initial states are nearly one direction of a short record:
left alone they run off together, to an initial roll rate of 15 rad/s or a delay of 3 s, and take
the ship's own coefficients with them. Each is therefore held about what a sensor of its kind, or
the first moments of the record, make likely; a record that sees it clearly is not held back.
"""

import math
from collections.abc import Iterable, Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.effects.sensors import compass_deviation
from trialid.effects.track import CURRENT as WATER
from trialid.effects.track import current_in_speed
from trialid.identification.nuisance.gyro_offset import ANGLES, gyro_offset
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import guess
from trialid.trial import Trial
from trialid.white_noise import FEWEST, white_noise

Vector = NDArray[np.float64]
Known = tuple[float, float]
"""Mean and standard deviation."""

OFFSETS: Final = {"b_phi": 0.035, "b_psi": 0.05, "delta_0": 0.02}
"""[rad] How far a roll sensor is mounted, a compass deviates and a rudder's zero lies off: 2 deg,
3 deg and 1.1 deg, the size that a builder's adjustment leaves. Half or twice: see the tests."""

GYRO: Final = 0.001
"""[rad/s] Offset that a rate gyro keeps, 0.06 deg/s."""

SHARE: Final = 0.05
"""Offset of a rate or a speed as a share of what is measured."""

DELAY: Final = 0.5
"""[s] Filters and bus of a motion sensor."""

DRIFT: Final = 0.05
"""Sideways speed of a ship on a straight course, over her speed."""

SWING: Final = 0.5
"""Sideways speed over r L in a turn: a ship turns about a point a half length before midships."""

CURRENT: Final = 1.0
"""[m/s] Speed to the north or to the east of the water that trials are sailed in: tides of open
roads run at 0.5 to 1.5 m/s, and only a narrow sound has more. A record that sees it is not held."""

PLACE: Final = ("psi", "x", "y")
"""Integrals of the motion; no force acts on them."""

LIMIT: Final = 10.0
"""Standard deviations beyond which no initial state is looked for."""

FIRST: Final = 0.5
"""Ship lengths sailed in which the start of a motion is read off the record."""


def nuisance_prior(
    model: ShipModel, trial: Trial, column: str, size: float, null: float = 0.0
) -> Known:
    """Mean and standard deviation of a nuisance of one trial, in its own unit.

    Parameters
    ----------
    column
        Its name: `b_phi`, `tau_r`, `delta_0`, or `phi(0)` for an initial state.
    size, null
        Its typical size, and what it is where nothing is wrong.
    """
    if column.endswith("(0)"):
        return _initial(model, trial, column[:-3])
    if column.startswith("tau_"):
        return null, max(DELAY, trial.period)
    usual, of = (null, _offset(model, trial, column, size)), column.removeprefix("b_")
    seen = gyro_offset(trial, of, OFFSETS[f"b_{ANGLES[of]}"]) if of in ANGLES else None
    return min(usual, seen or usual, key=lambda known: known[1])


def water_prior(column: str) -> Known | None:
    """Of the current in a speed over ground; None of anything else."""
    return (0.0, CURRENT) if column in current_in_speed.parameters else None


def limits(known: Known) -> tuple[float, float]:
    """Bounds of an initial state."""
    mean, deviation = known
    return mean - LIMIT * deviation, mean + LIMIT * deviation


def speed(model: ShipModel, trial: Trial) -> float:
    """How fast she goes [m/s]; for a ship at rest a Froude number of 0.1, so that scales exist."""
    L, g = (model.ship.particulars[n] for n in ("L", "g"))
    u = trial.signals.get("u")
    known = model.ship.particulars["U0"] if u is None else float(np.median(np.abs(u)))
    return max(known, 0.1 * float(np.sqrt(g * L)))


def fastest(model: ShipModel, trials: Iterable[Trial]) -> float:
    """How fast she goes in the fastest trial [m/s]; a turning circle takes half of it."""
    return max(speed(model, trial) for trial in trials)


def time_per_length(model: ShipModel, trials: Iterable[Trial]) -> float:
    """Time in which she goes her own length in the fastest trial [s]; without end at rest."""
    pace = fastest(model, trials)
    return model.ship.particulars["L"] / pace if pace > 0.0 else math.inf


def _offset(model: ShipModel, trial: Trial, column: str, size: float) -> float:
    if column in OFFSETS:
        return OFFSETS[column]
    if column in WATER:
        return CURRENT
    turning = speed(model, trial) / model.ship.particulars["L"]
    of = column.removeprefix("b_")
    if of in ("r", "p"):
        return max(GYRO, 0.01 * turning, SHARE * _moved(trial, of))
    if of in ("u", "v"):
        return max(size, SHARE * speed(model, trial))
    return 3.0 * size


def _deviates(model: ShipModel) -> bool:
    """Whether her compass reads another heading than she has, from the first sample on."""
    return not compass_deviation.parameters.keys().isdisjoint(model.parameters)


def _initial(model: ShipModel, trial: Trial, state: str) -> Known:
    if state in trial.signals:
        mean, deviation = _as_recorded(model, trial, state)
        off = OFFSETS["b_psi"] if state == "psi" and _deviates(model) else 0.0
        return mean, float(np.hypot(deviation, off))
    U, L = speed(model, trial), model.ship.particulars["L"]
    start = guess(model, trial, state)
    if state == "v":
        r = _as_recorded(model, trial, "r")[0] if "r" in trial.signals else 0.0
        return start, float(np.hypot(DRIFT * U, SWING * abs(r) * L))
    if state == "p":
        return _first_roll_rate(trial, _shortest_roll(L))
    known: Mapping[str, float] = {"u": 0.1 * U, "r": 0.05 * U / L}
    return start, known.get(state, 0.1)


def _first_roll_rate(trial: Trial, shortest: float) -> Known:
    """How fast she ever rolls, and where heel is recorded, how it begins to change.

    A parabola through the first half of the shortest roll [s]; three of its slope's errors and a
    tenth of all roll, as for what is recorded. A struck sample makes that error large. At forty
    places of records with white noise and with waves the error of the slope is 0.32 and 0.26 of its
    deviation (rms), 0.84 and 0.61 at most, and 0.0066 and 0.0044 rad/s are left open; through a
    quarter it is the same, for want of samples, through a whole roll 0.22 and 0.31, 0.62 and 0.92,
    0.0049 and 0.0044 rad/s.
    """
    if "phi" not in trial.signals:
        return 0.0, 0.05 * 2.0 * np.pi / shortest + 1e-4
    likely = _moved(trial, "phi") * 2.0 * np.pi / shortest + 1e-4
    phi = trial.signals["phi"][: max(FEWEST, round(0.5 * shortest / trial.period))]
    if len(phi) < FEWEST or not trial.valid["phi"][: len(phi)].all():
        return 0.0, likely
    (_, slope, _), covariance = np.polyfit(trial.period * np.arange(len(phi)), phi, 2, cov=True)
    off = np.hypot(3.0 * np.sqrt(covariance[1, 1]), 0.1 * likely)
    share = likely**2 / (likely**2 + off**2)
    return float(share * slope), float(np.sqrt(share) * off)


def _as_recorded(model: ShipModel, trial: Trial, state: str) -> Known:
    """The first samples, to within their noise and how much moves in half a length sailed.

    The median of five, so that one struck sample is no start; a tenth of all motion is let for
    what the model makes of the first moments, but not of where she is and heads: a heading that is
    free by a tenth of a turning circle begins 50 deg off, to make up for what comes later.
    """
    y = trial.signals[state][trial.valid[state]]
    y = y if len(y) else trial.signals[state]
    U, L = speed(model, trial), model.ship.particulars["L"]
    first = y[: max(5, round(FIRST * L / U / trial.period))]
    floor = 1e-3 * {"u": U, "v": U, "p": U / L, "r": U / L}.get(state, 1.0)
    moves = 0.0 if state in PLACE else 0.1 * float(np.std(y))
    deviation = np.hypot(np.std(first), 3.0 * white_noise(y)) + moves + floor
    return float(np.median(y[:5])), float(deviation)


def _moved(trial: Trial, name: str) -> float:
    return float(np.std(trial.signals[name])) if name in trial.signals else 0.0


def _shortest_roll(length: float) -> float:
    """Period of a stiff ship of this length [s]: 8 s for 175 m, by Froude's law."""
    return 0.6 * float(np.sqrt(length))
