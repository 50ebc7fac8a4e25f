"""Speed ahead and to starboard from what is recorded over the ground, and the heading."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError, list_names
from trialid.trial import Trial
from trialid.white_noise import white_noise_of_most

SCATTER: Final = 0.03
"""Share of her usual speed that the noise of positions may be in a slope of them; the slope is of
as many samples as that takes. Of three simulated boats of 2 to 12 m in three manoeuvres, fixes of 2
cm at 5 and 10 Hz told u to 3 to 23 % and v to 6 to 36 % of what they move, of 30 cm, where she
turns little enough, to 9 to 31 and 17 to 54 %. Half of it refuses the boat of 2 m at 5 Hz, and that
of 5 m in 30 cm; with twice of it what 30 cm leave is 16 to 58 and 25 to 115 %."""

LONGEST: Final = 0.05
"""Share of a trial that the slope of a position may be of. Twice of it lets a boat of 5 m in fixes
of 1 m pass, u off by 60 % and v by 127 %; half of it refuses one of 12 m, 14 to 23 and 35 to 52 %.
"""

TURNED: Final = 1.2
"""[rad] What she may turn through within a slope, nine times in ten: it is a chord then, shorter
than her way. Of those boats what stayed below was off as said; half of it refuses one of 2 m by
fixes of 2 cm, twice lets v of 30 cm be off by 69 %."""

FEWEST: Final = 5
"""Samples of a slope."""


@dataclass(frozen=True)
class Velocity:
    """To the north and to the east [m/s], where it is known, (N,) each; and what tells it."""

    north: Vector
    east: Vector
    known: Mask
    told: str


def with_velocity(trial: Trial) -> Trial:
    """The trial with `u` and `v`, her velocity over the ground in her own axes.

    Of speed and course over ground, or else of positions, by the heading. A current is in it.

    Raises
    ------
    AlignmentError
        There is a `u` or `v` already, no heading, or nothing that tells a velocity.
    """
    there = {*trial.signals}
    if clash := {"u", "v"} & there:
        raise AlignmentError(
            f"trial {trial.name!r}: over_ground = true makes u and v, and a signal is mapped to "
            f"{list_names(sorted(clash))}; take one of them out"
        )
    if "psi" not in there:
        raise AlignmentError(
            f"trial {trial.name!r}: over_ground = true turns a velocity by her heading; map psi, "
            "or take it out"
        )
    made, psi = _velocity(trial), trial.signals["psi"]
    known = made.known & trial.valid["psi"]
    own = {
        "u": made.north * np.cos(psi) + made.east * np.sin(psi),
        "v": made.east * np.cos(psi) - made.north * np.sin(psi),
    }
    remark = f"u, v: her velocity over the ground by {made.told}, ahead and to starboard by psi"
    return replace(
        trial,
        signals={**trial.signals, **own},
        valid={**trial.valid, "u": known, "v": known},
        remarks=(*trial.remarks, remark),
    )


def _velocity(trial: Trial) -> Velocity:
    s, valid = trial.signals, trial.valid
    if {"sog", "cog"} <= {*s}:
        north, east = s["sog"] * np.cos(s["cog"]), s["sog"] * np.sin(s["cog"])
        return Velocity(north, east, valid["sog"] & valid["cog"], "sog and cog")
    if {"x", "y"} <= {*s}:
        return _by_positions(trial)
    raise AlignmentError(
        f"trial {trial.name!r}: over_ground = true needs sog and cog, or a position; it has "
        f"{', '.join(sorted(s))}"
    )


def _by_positions(trial: Trial) -> Velocity:
    """By the slope of positions; AlignmentError where they are too coarse for her speed."""
    north, east = (trial.signals[n] for n in ("x", "y"))
    known = trial.valid["x"] & trial.valid["y"]
    made = slope_of_positions(north, east, trial.signals["psi"], known, trial.period)
    if made is None:
        raise AlignmentError(
            f"trial {trial.name!r}: her positions scatter too much, or are too few, to tell a "
            "speed before she has turned on; map a speed, or take over_ground out"
        )
    return made


def slope_of_positions(
    north: Vector, east: Vector, psi: Vector, known: Mask, period: float
) -> Velocity | None:
    """The slope of a parabola through as many positions as their noise asks for.

    None where those are a twentieth of the trial and more, or she turns too far meanwhile. A
    position that the log repeats until the next is one. At its ends half a slope is not known.

    Parameters
    ----------
    north, east, psi
        Positions [m] and headings [rad]; (N,).
    known
        Where they were measured; (N,).
    period
        Time between samples [s].
    """
    told = np.flatnonzero(known & np.isfinite(north) & np.isfinite(east))
    if len(told) < FEWEST:
        return None
    fresh = told[np.flatnonzero(_moves(north[told]) | _moves(east[told]))]
    every = round(float(np.median(np.diff(fresh)))) if len(fresh) > FEWEST else 1
    if every < 2:
        return _slope(north, east, psi, known, period)
    made = _slope(north[fresh], east[fresh], psi[fresh], known[fresh], every * period)
    if made is None:
        return None
    on = np.arange(len(north))
    inside = np.interp(on, fresh, made.known.astype(float), left=0.0, right=0.0) > 1.0 - 1e-9
    to_north, to_east = (np.interp(on, fresh, one) for one in (made.north, made.east))
    return Velocity(to_north, to_east, inside & known, made.told)


def slope(y: Vector, count: int) -> Vector:
    """The slope of a parabola, or a line, through an odd count of samples about each, a sample.

    Within half of them of an end it is none.

    >>> slope(np.array([0.0, 2.0, 4.0, 6.0, 8.0]), 3)[1:-1].round(9).tolist()
    [2.0, 2.0, 2.0]
    """
    away = np.arange(count) - count // 2
    return np.convolve(y, -away / float(away @ away), mode="same")


def _moves(one: Vector) -> Mask:
    """Which values are others than those before."""
    return np.diff(one, prepend=np.nan) != 0.0


def _slope(north: Vector, east: Vector, psi: Vector, known: Mask, period: float) -> Velocity | None:
    """The same of positions each of which is measured anew."""
    count = _samples_of_slope(north, east, known, period)
    if not 0 < count <= max(LONGEST * len(north), FEWEST):
        return None
    turned = np.abs(psi[count:] - psi[:-count])[known[count:] & known[:-count]]
    if not len(turned) or np.quantile(turned, 0.9) > TURNED:
        return None
    filled = (np.interp(np.arange(len(x)), np.flatnonzero(known), x[known]) for x in (north, east))
    half = count // 2
    inner = (slope(one, count)[half:-half] / period for one in filled)
    by = [np.pad(one, half, mode="edge") for one in inner]  # a speed goes on, though not known
    whole = np.convolve(known, np.ones(count), mode="same") > count - 0.5
    return Velocity(by[0], by[1], whole, f"positions, over {count * period:.2g} s")


def _samples_of_slope(north: Vector, east: Vector, known: Mask, period: float) -> int:
    """Fewest samples, an odd number, whose slope has no more noise than `SCATTER`; 0 for none."""
    noise = max(white_noise_of_most(one, known) for one in (north, east))
    for count in range(FEWEST, len(north), 2):
        both = known[count:] & known[:-count]
        moved = np.hypot(*(one[count:] - one[:-count] for one in (north, east)))[both]
        speed = float(np.median(moved)) / (count * period) if len(moved) else 0.0
        # an even slope over n samples has the variance 12 noise^2 / (n^3 period^2)
        if speed and noise * np.sqrt(12.0 / count**3) / period <= SCATTER * speed:
            return count
    return 0
