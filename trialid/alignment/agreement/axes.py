"""Whether a velocity is along the ship's axes, as every model has it, or along the earth's.

A basin's tracking gives dx/dt and dy/dt, and calls them u and v. Along the ship u is hardly another
in a turn; to the north it goes round with the heading, and is negative on the way back.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trialid.alignment.agreement import signs
from trialid.alignment.agreement.channel_finding import Finding
from trialid.arrays import Mask, Vector
from trialid.trial import Trial

ROUND: Final = np.pi
"""[rad] How far the heading must go for u alone to tell: half a turn, to the way back."""

SWINGS: Final = np.deg2rad(30.0)
"""[rad] The same for u and v together: a zig-zag of 10 deg."""

GOES_ROUND: Final = 2.0
"""Times the steady part of u that what goes round with the heading must be: none of a ship's own,
all of a velocity to the north. A current in a speed over ground is less than her speed. A turn in
files of a basin has 9.8: half and twice tell the same of it."""

ALIKE: Final = 0.9
"""Correlation of u with what goes round with the heading, and mean cosine of a course beside it."""

NEARER: Final = 0.25
"""Share of what the course strays by itself that it may stray beside the heading: of the ship's own
velocities it strays by the drift angle, and beside the heading by all her turns. Five manoeuvres of
a basin's files have 0.003-0.144 with a cosine of 0.990-0.997, her own velocities 12-313 with
0.13-0.95: twice this tells the same of them, half of it leaves out a zig-zag of 20 deg."""


def check_axes(trial: Trial) -> Iterator[Finding]:
    """An error where u, or u and v, are of the earth."""
    heading = _heading(trial)
    if heading is None or "u" not in trial.signals:
        return
    psi, known = heading
    told = _of_both(trial, psi, known) if "v" in trial.signals else _of_one(trial, psi, known)
    if told is None:
        return
    about = ("u", "v") if "v" in trial.signals else ("u",)
    who, (what, size) = " and ".join(about), told
    words = (
        f"{who}: round with the heading ({what} {size:.2f}), as velocities to the north and to the "
        "east are, not along the ship; log u = x' cos(psi) + y' sin(psi) and v = y' cos(psi) - x' "
        "sin(psi), or leave them out and state the trial's `speed`"
    )
    yield Finding("axes", "error", about, words, {what: size})


def _heading(trial: Trial) -> tuple[Vector, Mask] | None:
    """The heading [rad], or the integral of the rate of turn, and where it is known."""
    if "psi" in trial.signals:
        return trial.signals["psi"], trial.valid["psi"]
    turning = signs.rate_of_turn(trial)
    if turning is None:
        return None
    rate, known = turning
    return np.cumsum(np.where(known, rate, 0.0)) * trial.period, known


def _of_one(trial: Trial, psi: Vector, known: Mask) -> tuple[str, float] | None:
    """What of u goes round with the heading, over what does not; None where little does."""
    both = known & trial.valid["u"]
    if not both.any() or np.ptp(psi[both]) < ROUND:
        return None
    u, angle = trial.signals["u"][both], psi[both]
    parts = np.column_stack([np.ones(len(u)), np.cos(angle), np.sin(angle)])
    steady, north, east = found = np.linalg.lstsq(parts, u, rcond=None)[0]
    left = float(np.var(u - parts @ found))
    around = float(np.hypot(north, east)) / max(abs(float(steady)), 1e-9)
    if around < GOES_ROUND or left > (1.0 - ALIKE**2) * float(np.var(u)):
        return None
    return "over its steady part", around


def _of_both(trial: Trial, psi: Vector, known: Mask) -> tuple[str, float] | None:
    """How constant the course of u and v is beside the heading, where it is far less by itself."""
    both = known & trial.valid["u"] & trial.valid["v"]
    if not both.any() or np.ptp(psi[both]) < SWINGS:
        return None
    course = np.arctan2(trial.signals["v"][both], trial.signals["u"][both])
    own, beside = (float(np.abs(np.mean(np.exp(1j * x)))) for x in (course, course - psi[both]))
    found = beside > ALIKE and 1.0 - beside < NEARER * (1.0 - own)
    return ("mean cosine beside it", beside) if found else None
