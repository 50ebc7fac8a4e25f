"""What the ship was doing in a stretch of time, in the words of the bridge."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.diagnosis.where.leftover import Leftover

Vector = NDArray[np.float64]

REVERSAL: Final = np.deg2rad(3.0)
"""[rad] A rudder that goes from beyond this on one side to beyond it on the other is reversed."""

TURNING: Final = 0.5
"""A mean rate of turn above this share of the largest is a turn."""

STRAIGHT: Final = 0.1
"""Below this share of it the course is straight; between the two she turns slowly."""

INDICATED: Final = np.deg2rad(1.0) / 60.0
"""[rad/s] So slow a turn of a ship of 175 m is a straight course, of another by Froude's law: twice
what IMO A.526 lets a rate-of-turn indicator be off. In a trial in which she never turns the largest
rate is no measure."""

STEADY: Final = 0.2
"""A turn whose rate varies by less than this share of its mean is steady."""

ROLLING: Final = 0.5
"""Roll about its trend above this share of the roll of all trials is rolling."""

SPEEDING: Final = 0.05
"""Share of the mean speed by which it changes from one end of the stretch to the other."""


def ship_activity(left: Leftover, stretch: slice) -> str:
    """What the ship was doing in samples of one trial: rudder first, then turn, roll and speed."""
    angle, turn = left.rudder(), _seen_turn(left, stretch)
    words = _reversal(angle[stretch]) if angle is not None else ""
    if not words:
        words = _turn(turn, stretch) if turn is not None else ""
    if not words and angle is not None:
        still = float(np.ptp(angle[stretch])) < REVERSAL
        words = _rolling(left, stretch) if still else ""
    if not words:
        words = _course(turn, stretch) if turn is not None else _held(angle, stretch)
    speed = _speed(left, stretch)
    return f"{words}, {speed}" if speed else words


def _seen_turn(left: Leftover, stretch: slice) -> Vector | None:
    """The rate of turn of all trials [rad/s]; zeros where a helmsman would see none here."""
    turn = left.signal("r")
    if turn is None or abs(float(turn[stretch].mean())) * left.time_scale > INDICATED:
        return turn
    return np.zeros_like(turn)


def _reversal(angle: Vector) -> str:
    sides = np.sign(angle) * (np.abs(angle) > REVERSAL)
    sides = sides[sides != 0.0]
    changes = np.flatnonzero(np.diff(sides))
    if len(changes) == 0:
        return ""
    if len(changes) > 1:
        return "rudder reversals"
    return f"rudder reversal to {'starboard' if sides[-1] > 0.0 else 'port'}"


def _turn(turn: Vector, stretch: slice) -> str:
    here = turn[stretch]
    mean, largest = float(here.mean()), float(np.abs(turn).max())
    if largest == 0.0 or abs(mean) < TURNING * largest:
        return ""
    steady = float(np.ptp(here)) < STEADY * abs(mean)
    return f"{'steady turn' if steady else 'turning'} to {'starboard' if mean > 0.0 else 'port'}"


def _course(turn: Vector, stretch: slice) -> str:
    """What is no turn to speak of."""
    mean = float(turn[stretch].mean())
    if abs(mean) <= STRAIGHT * float(np.abs(turn).max()):
        return "straight course"
    return f"slow turn to {'starboard' if mean > 0.0 else 'port'}"


def _rolling(left: Leftover, stretch: slice) -> str:
    """A roll that goes on while the rudder rests: that is the ship's own frequency."""
    phi = left.signal("phi")
    if phi is None:
        return ""
    here = phi[stretch]
    t = np.arange(len(here)) - 0.5 * (len(here) - 1)
    swing = here - here.mean() - t * float(t @ here) / max(float(t @ t), 1e-300)
    passes = np.flatnonzero(np.diff(np.sign(swing)))
    if len(passes) < 3 or float(np.std(swing)) < ROLLING * float(np.std(phi)):
        return ""
    samples = 2.0 * float(passes[-1] - passes[0]) / (len(passes) - 1)
    period = samples * left.parts[0].trial.period
    return f"rolling at its natural frequency, period {period:.0f} s"


def _held(angle: Vector | None, stretch: slice) -> str:
    if angle is None:
        return "neither rudder nor turn recorded"
    return "rudder held" if float(np.ptp(angle[stretch])) < REVERSAL else "rudder moving"


def _speed(left: Leftover, stretch: slice) -> str:
    u = left.signal("u")
    if u is None:
        return ""
    here = u[stretch]
    tenth = max(len(here) // 10, 1)
    change = float(here[-tenth:].mean() - here[:tenth].mean())
    if abs(change) < SPEEDING * abs(float(u.mean())):
        return ""
    return "speeding up" if change > 0.0 else "slowing"
