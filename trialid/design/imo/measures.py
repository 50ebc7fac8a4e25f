"""Standard measures of a manoeuvre, as MSC.137(76) asks for them."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage
from trialid.errors import DesignError

QUARTER: Final = np.pi / 2.0


@dataclass(frozen=True)
class Criterion:
    """A largest value the resolution allows, None where it sets none; `words` say for what."""

    name: str
    largest: float | None
    unit: str
    words: str


def turning(passage: Passage) -> dict[str, float]:
    """Advance, transfer and tactical diameter of a turn [m], from where the rudder was ordered.

    Advance: ahead, when the heading has changed by 90 deg; transfer: to the side, then; tactical
    diameter: to the side when it has changed by 180 deg. Also the steady speed [m/s] and rate of
    turn [rad/s] at the end.

    Raises
    ------
    DesignError
        The heading does not change by 180 deg.
    """
    begin = execute_sample(passage)
    psi = np.abs(passage.trial.signals["psi"] - passage.trial.signals["psi"][begin])
    course = float(passage.trial.signals["psi"][begin])
    x, y = passage.x - passage.x[begin], passage.y - passage.y[begin]
    ahead = x * np.cos(course) + y * np.sin(course)
    aside = np.abs(-x * np.sin(course) + y * np.cos(course))
    if psi[begin:].max() < 2.0 * QUARTER:
        raise DesignError(
            f"the turn ends at {np.rad2deg(psi[begin:].max()):.0f} deg of heading; tactical "
            "diameter needs 180 deg: give it more time"
        )
    quarter, half = (_when(psi, begin, turned) for turned in (QUARTER, 2.0 * QUARTER))
    return {
        "advance": _at(ahead, quarter),
        "transfer": _at(aside, quarter),
        "tactical diameter": _at(aside, half),
    }


def initial_turning(passage: Passage, angle: float) -> float:
    """Track run [m] from a 10 deg order until the heading has changed by `angle`, 10 deg."""
    begin = execute_sample(passage)
    psi = np.abs(passage.trial.signals["psi"] - passage.trial.signals["psi"][begin])
    if psi[begin:].max() < angle:
        raise DesignError(
            f"the heading changes by {np.rad2deg(psi[begin:].max()):.0f} deg; initial turning "
            f"needs {np.rad2deg(angle):.0f} deg: give it more time"
        )
    run = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(passage.x), np.diff(passage.y)))])
    return _at(run - run[begin], _when(psi, begin, angle))


def overshoots(passage: Passage, headings: Vector | None = None) -> list[float]:
    """Overshoot angles of a zig-zag [rad], first, second and so on; none without a reversal.

    How far the heading goes on after each reversal of the rudder, until that is ordered amidships
    or back; the last only when it has come back. `headings` (N,) are those that a reversal is
    reckoned from, where not the passage's own.
    """
    psi, order = passage.trial.signals["psi"], passage.trial.signals["delta_order"]
    reckoned = psi if headings is None else headings
    found = []
    for k in reversal_samples(order):
        over = np.flatnonzero(order[k:] * order[k] <= 0.0)
        end = k + int(over[0]) if len(over) else len(psi)
        beyond = np.sign(order[k - 1]) * (psi[k:end] - reckoned[k])
        peak = int(np.argmax(beyond))
        if not 0 < peak < len(beyond) - 1:
            break
        found.append(_peak(beyond, peak))
    return found


def reversal_samples(order: Vector) -> list[int]:
    """Samples at which the rudder is first ordered to the other side."""
    changes = np.flatnonzero(np.diff(order)) + 1
    return [int(k) for k in changes if order[k] * order[k - 1] < 0.0]


def criteria(length: float, speed: float) -> tuple[Criterion, ...]:
    """What MSC.137(76) asks of a ship of this length [m] at this test speed [m/s].

    The limits of the 10/10 zig-zag grow with the time the ship takes to run her length. The second
    overshoot of the 20/20 has none; it is asked for with the others all the same.
    """
    time = length / speed
    first = float(np.clip(5.0 + time / 2.0, 10.0, 20.0))
    second = float(np.clip(17.5 + 0.75 * time, 25.0, 40.0))
    return (
        Criterion("advance", 4.5 * length, "m", "turning circle, 35 deg"),
        Criterion("tactical diameter", 5.0 * length, "m", "turning circle, 35 deg"),
        Criterion("initial turning", 2.5 * length, "m", "track to 10 deg of heading, 10 deg"),
        Criterion("first overshoot 10/10", first, "deg", "zig-zag 10/10"),
        Criterion("second overshoot 10/10", second, "deg", "zig-zag 10/10"),
        Criterion("first overshoot 20/20", 25.0, "deg", "zig-zag 20/20"),
        Criterion("second overshoot 20/20", None, "deg", "zig-zag 20/20"),
    )


def execute_sample(passage: Passage) -> int:
    """The sample of the first order."""
    ordered = np.flatnonzero(passage.trial.signals["delta_order"])
    if not len(ordered):
        raise DesignError("no rudder is ordered in this trial; there is nothing to measure")
    return int(ordered[0])


def _when(values: Vector, begin: int, level: float) -> float:
    """Sample, with its fraction, at which rising values reach a level after `begin`."""
    k = begin + int(np.argmax(values[begin:] >= level))
    if k == 0:
        return 0.0
    return k - 1 + (level - values[k - 1]) / (values[k] - values[k - 1])


def _at(values: Vector, place: float) -> float:
    return float(np.interp(place, np.arange(len(values)), values))


def _peak(y: Vector, k: int) -> float:
    """Height of a peak between samples, by a parabola."""
    below, top, above = y[k - 1], y[k], y[k + 1]
    bend = below - 2.0 * top + above
    return float(top - (above - below) ** 2 / (8.0 * bend)) if bend < 0.0 else float(top)
