"""A recorded rudder that is at its place at once: an order, which the steering gear follows later.

Logs call both `rudder`. A gear takes seconds to move the rudder of a ship and a good part of one
that of a model; who takes the order for the angle finds the gear's lag in the gyro.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Vector
from trialid.identification.fit import Fit
from trialid.identification.nuisance.priors import time_per_length
from trialid.trial import Trial

FAST: Final = np.deg2rad(200.0)
"""[rad] What moves by more than this while the ship goes her own length is no rudder. SOLAS asks
for 23 to 90 deg in that time, that of a model in a basin had 160 with its noise. Of 45 sets of
trials half of it takes the gears of five for orders, four of them ships at one sample a second;
twice misses the orders of a boat of 8 m at ten."""

LEAST: Final = np.deg2rad(2.0)
"""[rad] Jumps less than this are noise."""

MOST: Final = 0.5
"""Share of all that a rudder moves that it jumps. Measured rudders have 0, zig-zags of a model on a
pond 0.61 to 0.83 and her rudder at random 0.97. Her four turning tests, held by small corrections,
have 0.18 to 0.31 and are not told; half of it tells two or three of them, twice tells nothing."""

Course = tuple[Vector, Vector]
"""Times [s] and rudder angles [rad], NaN where it was not measured; (n,) each."""


Steps = NDArray[np.bool_]
"""Which steps from one sample to the next are made at once; (n - 1,)."""


@dataclass(frozen=True)
class Jump:
    """How far a rudder [rad], or a drive [1], goes between two samples, and the time [s]."""

    size: float
    time: float
    shown: str = "deg"

    def __str__(self) -> str:
        """In words, for a sentence."""
        size = np.rad2deg(self.size) if self.shown == "deg" else 100.0 * self.size
        return f"jumps by up to {size:.0f} {self.shown} within {self.time:.2g} s"


def jump_of(courses: Iterable[Course], own_time: float) -> Jump | None:
    """How the rudder of these trials jumps; None where it takes its time, or that cannot be told.

    Parameters
    ----------
    courses
        One for each trial.
    own_time
        Time in which the ship goes her own length [s].
    """
    return jump_where(
        courses, lambda t, y: np.abs(np.diff(y)) * own_time > FAST * np.diff(t), LEAST
    )


def jump_where(
    courses: Iterable[Course], at_once: Callable[[Vector, Vector], Steps], least: float
) -> Jump | None:
    """The largest jump, where most that is moved is moved `at_once`, in steps of more than `least`.

    `at_once` is given times and values.
    """
    jumps, times, moved = list[Vector](), list[Vector](), 0.0
    for t, y in courses:
        steps, between, quick = np.abs(np.diff(y)), np.diff(t), at_once(t, y)
        known = np.isfinite(steps) & (between > 0.0)
        steps, between, quick = steps[known], between[known], quick[known]
        if not len(steps):
            continue
        moves = steps > 3.0 * np.median(steps)
        taken = moves & (steps > least) & quick
        moved += float(steps[moves].sum())
        jumps.append(steps[taken])
        times.append(between[taken])
    every = np.concatenate(jumps or [np.zeros(0)])
    if not len(every) or every.sum() < MOST * moved:
        return None
    return Jump(float(every.max()), float(np.median(np.concatenate(times))))


def rudder_jump(trials: Iterable[Trial], own_time: float) -> Jump | None:
    """How the recorded rudder of these trials jumps; None where it does not, or there is none."""
    return jump_of((_course(t) for t in trials if "delta" in t.signals), own_time)


def jump_in(fit: Fit) -> Jump | None:
    """The same of a fit's trials."""
    steered = any("delta" in t.signals for t in fit.trials)
    return rudder_jump(fit.trials, own_time(fit)) if steered else None


def own_time(fit: Fit) -> float:
    """Time in which the ship goes her own length [s]."""
    return time_per_length(fit.model, fit.problem.trials)


def said_of(jump: Jump) -> str:
    """What to do about it, in a clause."""
    return f"delta {jump}, which no ship's gear does: where it is the order, call it delta_order"


def _course(trial: Trial) -> Course:
    y = np.array(trial.signals["delta"], dtype=np.float64)
    y[~trial.valid["delta"]] = np.nan
    return trial.t, y
