"""The track of the ship's origin from that of her antenna, and what else needs her heading."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError
from trialid.trial import Trial

FOLLOWS: Final = 0.5
"""Mean cosine between course over ground and heading below which a track is not of that heading:
drift in a hard turn is 20 deg (0.94), and a swapped or mirrored track of a full turn has 0."""

MOVING: Final = 0.3
"""Share of the usual speed below which a course says nothing."""

MINUTES: Final = 0.6
"""What becomes of a distance where dd.mmmm, degrees and minutes, is read as degrees: 60 for 100."""

WAY: Final = 30.0
"""m, on which a receiver of 1 m tells a speed to 5 %."""


def at_origin(trial: Trial, antenna: Mapping[str, float]) -> Trial:
    """The trial with `x` and `y` moved from the antenna to the ship's origin, by heading and roll.

    Parameters
    ----------
    antenna
        `x` ahead, `y` to starboard and `z` below the origin [m]; missing ones are zero.

    Raises
    ------
    AlignmentError
        No heading is recorded.
    """
    if not antenna or not {"x", "y"} <= {*trial.signals}:
        return trial
    if "psi" not in trial.signals:
        raise AlignmentError(
            f"trial {trial.name!r}: the ship file has an [antenna], and without a heading nobody "
            "knows where it was; map psi, or take the section out"
        )
    psi, phi = trial.signals["psi"], trial.signals.get("phi", np.zeros(trial.samples))
    ahead, aside = arm(antenna, phi)
    north = ahead * np.cos(psi) - aside * np.sin(psi)
    east = ahead * np.sin(psi) + aside * np.cos(psi)
    moved = {"x": trial.signals["x"] - north, "y": trial.signals["y"] - east}
    valid = {n: trial.valid[n] & trial.valid["psi"] for n in moved}
    signals, valid = {**trial.signals, **moved}, {**trial.valid, **valid}
    remark = "x, y: moved from the antenna to the origin by the ship file's [antenna]"
    return replace(trial, signals=signals, valid=valid, remarks=(*trial.remarks, remark))


def arm(antenna: Mapping[str, float], phi: Vector) -> tuple[Vector, Vector]:
    """Where the antenna is ahead and to starboard of the origin [m] at roll angles [rad]; (N,)."""
    ahead = np.full(len(phi), antenna.get("x", 0.0))
    return ahead, antenna.get("y", 0.0) * np.cos(phi) - antenna.get("z", 0.0) * np.sin(phi)


def with_course(trial: Trial) -> Trial:
    """The trial with its course over ground in the turn of its heading, not one turn off."""
    if not {"cog", "psi"} <= {*trial.signals}:
        return trial
    both = np.flatnonzero(trial.valid["cog"] & trial.valid["psi"])
    if not len(both):
        return trial
    off = float(np.median((trial.signals["cog"] - trial.signals["psi"])[both]))
    turns = 2.0 * np.pi * round(off / (2.0 * np.pi))
    signals = {**trial.signals, "cog": trial.signals["cog"] - turns}
    return replace(trial, signals=signals)


def check_track(trial: Trial) -> tuple[str, ...]:
    """Remarks where a track contradicts the heading or the speed of the same trial.

    Raises
    ------
    AlignmentError
        It follows the heading only with north and east exchanged.
    """
    if not {"x", "y"} <= {*trial.signals}:
        return ()
    valid = trial.valid["x"] & trial.valid["y"]
    if valid.sum() < 10:
        return ()
    north, east = (np.gradient(trial.signals[n], trial.period) for n in ("x", "y"))
    return (*_against_heading(trial, north, east, valid), *_against_speed(trial, north, east))


def _against_heading(trial: Trial, north: Vector, east: Vector, valid: Mask) -> tuple[str, ...]:
    if "psi" not in trial.signals:
        return ()
    sog = np.hypot(north, east)
    used = valid & trial.valid["psi"] & (sog > MOVING * np.median(sog[valid]))
    psi = trial.signals["psi"][used]

    def agreement(a: Vector, b: Vector) -> float:
        return float(np.mean((a[used] * np.cos(psi) + b[used] * np.sin(psi)) / sog[used]))

    if not used.any() or (found := agreement(north, east)) > FOLLOWS:
        return ()
    if (swapped := agreement(east, north)) > 1.5 * FOLLOWS:
        raise AlignmentError(
            f"trial {trial.name!r}: the track follows the heading (cosine {swapped:.2f}, as it is "
            f"{found:.2f}) only with north and east exchanged: exchange the channels of the "
            "position"
        )
    return (
        f"the track does not follow the heading (mean cosine {found:.2f}): a heading off by a "
        "constant, of another ship, or drifting in a current faster than the ship",
    )


def _against_speed(trial: Trial, north: Vector, east: Vector) -> tuple[str, ...]:
    u = trial.signals.get("u")
    if u is None or not float(np.median(np.abs(u))) > 0.5:
        return ()
    ratio = float(np.median(np.hypot(north, east)) / np.median(np.abs(u)))
    return speeds_apart(ratio, f"the track is sailed at {ratio:.2f} times the recorded speed u")


def check_stated_speed(trial: Trial, speed: float) -> tuple[str, ...]:
    """A remark where a track is not sailed at the approach speed that was stated [m/s].

    At its fastest, for turns cost speed: what nine tenths of the ways of `WAY` do not exceed.
    """
    if not {"x", "y"} <= {*trial.signals} or not speed > 0.5:
        return ()
    steps = max(round(WAY / (speed * trial.period)), 1)
    both = trial.valid["x"] & trial.valid["y"]
    known = both[steps:] & both[:-steps]
    if known.sum() < 10:
        return ()
    x, y = (trial.signals[n][steps:] - trial.signals[n][:-steps] for n in ("x", "y"))
    sog = np.hypot(x, y)[known] / (steps * trial.period)
    ratio = float(np.quantile(sog, 0.9)) / speed
    return speeds_apart(ratio, f"the track is sailed at up to {ratio:.2f} times the stated speed")


def speeds_apart(ratio: float, words: str) -> tuple[str, ...]:
    """A remark where a track and a speed are further apart than a current explains; or none."""
    if 0.7 < ratio < 1.5:
        return ()
    if abs(ratio - MINUTES) < 0.05:
        return (f"{words}: dd.mmmm, degrees and minutes, read as degrees gives {MINUTES:g}",)
    return (f"{words}: a strong current along it, or a wrong unit of one of them",)
