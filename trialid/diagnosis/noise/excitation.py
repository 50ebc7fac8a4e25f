"""What drives and steers a ship, as a trial has it: whether it rests, repeats itself, or is one.

The rudder of a ship with one; of any other boat the record of every actuator she has.
"""

from collections.abc import Iterable, Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.ship.actuators import Actuator
from trialid.ship.particulars import Ship
from trialid.simulation.integrate import record_for
from trialid.trial import Trial

Vector = NDArray[np.float64]

QUIET_ANGLE: Final = np.deg2rad(0.5)
QUIET_SHARE: Final = 0.02
"""Of the most that is driven in a trial: what half a degree is of a usual rudder's 25."""

QUIET_SECONDS: Final = 60.0
"""How long rest has to be; of boats without a rudder of their own, by Froude's law from 175 m."""

SAME: Final = 0.02
"""Mean square difference over variance below which two records are the same."""

SHORT: Final = 256
"""Samples in which most rest of a moving ship ends: what follows is only looked at where not."""


def rudder(trial: Trial) -> Vector | None:
    """The rudder's record, the measured angle before the order; None where there is neither."""
    return _recorded(trial, "delta")


def what_drives(ship: Ship) -> str:
    """What a trial's rest and repetition go by, in a word."""
    return "actuator" if ship.actuators else "rudder"


def quiet_seconds(ship: Ship) -> float:
    """How long rest has to be for its error to tell the noise [s]."""
    particulars = ship.particulars
    froude = np.sqrt(particulars["L"] / 175.0 * 9.81 / particulars["g"])
    return QUIET_SECONDS * (float(froude) if ship.actuators else 1.0)


def excitation(ship: Ship, trial: Trial) -> Vector | None:
    """All that drives and steers her, in units of what is a move; (N, m), None where nothing is."""
    delta = rudder(trial)
    columns = [] if delta is None else [delta / QUIET_ANGLE]
    columns += [x for one in ship.actuators for x in _moves(one, trial)]
    return np.column_stack(columns) if columns else None


def is_driven(inputs: Iterable[str], trials: Iterable[Trial]) -> bool:
    """Whether anything moves that a model reads, beside the speed she had, which drives none.

    What is left of a ship let go depends on where she began, and on nothing that comes again.
    """
    asked = [n for n in dict.fromkeys(inputs) if n != "u"]
    recorded = ((t, record_for(t, n)) for t in trials for n in asked)
    return any(float(np.ptp(t.signals[n])) > 0.0 for t, n in recorded if n is not None)


def _moves(one: Actuator, trial: Trial) -> Iterator[Vector]:
    """What is recorded of an actuator, each in units of what is a move."""
    for signal in (*one.signals, one.bucket):
        x = _recorded(trial, signal)
        if x is not None:
            most = float(np.abs(x).max())
            yield x / (QUIET_ANGLE if signal == one.angle else QUIET_SHARE * most or 1.0)


def _recorded(trial: Trial, signal: str) -> Vector | None:
    """A signal as fed back, else as ordered."""
    return next((trial.signals[n] for n in (signal, f"{signal}_order") if n in trial.signals), None)


def are_same(one: Vector | None, other: Vector | None) -> bool:
    """Whether two trials were driven and steered alike; (N, m) each."""
    if one is None or other is None or one.shape[1] != other.shape[1]:
        return False
    if min(len(one), len(other)) < 0.8 * max(len(one), len(other)):
        return False
    n = min(len(one), len(other))
    spread, apart = np.var(one[:n], axis=0), np.mean((one[:n] - other[:n]) ** 2, axis=0)
    return bool(np.any(spread > 0.0) and np.all(apart <= SAME * spread))


def period_of(moves: Vector) -> tuple[int, int] | None:
    """Start and length [samples] of what, (N, m), repeats itself at least once after its start."""
    away = np.flatnonzero(np.abs(moves - moves[0]).max(axis=1) > 1.0)
    if len(away) == 0:
        return None
    start = int(away[0])
    active = moves[start:] - moves[start:].mean(axis=0)
    size = np.mean(active**2, axis=0)
    if not size.any():  # laid over once and held: nothing comes again
        return None
    gap = np.max([_gaps(x) / s for x, s in zip(active.T, size, strict=True) if s > 0.0], axis=0)
    apart = np.flatnonzero(gap > 1.0)
    if len(apart) == 0:
        return None
    # a rudder is like itself a moment before; it repeats where it has been unlike in between
    alike = gap < SAME
    alike[: apart[0]] = False
    if not alike.any():
        return None
    first = int(np.argmax(alike))
    end = first + int(np.argmin(np.append(alike[first:], False)))
    return start, first + int(np.argmin(gap[first:end]))


def _gaps(x: Vector) -> Vector:
    """Mean square of what a record differs by from itself so many samples later, up to half."""
    n = len(x)
    lags = np.arange(n // 2 + 1)
    spectrum = np.fft.rfft(x, 1 << (2 * n - 1).bit_length())
    products = np.fft.irfft(np.abs(spectrum) ** 2)[: len(lags)]
    before = np.concatenate([[0.0], np.cumsum(x**2)])
    squares = (before[n] - before[lags]) + before[n - lags]
    return np.asarray((squares - 2.0 * products) / (n - lags))


def rest_ends(moves: Vector, start: int) -> int:
    """Where rest of all that drives and steers, (N, m), ends that begins at `start`."""
    length = SHORT
    while True:
        broken = np.flatnonzero(_range(moves[start : start + length]).max(axis=1) > 1.0)
        if len(broken):
            return start + int(broken[0])
        if start + length >= len(moves):
            return len(moves)
        length *= 2


def _range(x: Vector) -> Vector:
    """Largest less least of each column up to every row."""
    return np.maximum.accumulate(x, axis=0) - np.minimum.accumulate(x, axis=0)
