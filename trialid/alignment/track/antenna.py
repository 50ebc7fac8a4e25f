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
    """The trial with what its receiver tells moved from the antenna to the ship's origin.

    `x` and `y` by heading and roll; `sog` and `cog` by the rate of turn, too.

    Parameters
    ----------
    antenna
        `x` ahead, `y` to starboard and `z` below the origin [m]; missing ones are zero.

    Raises
    ------
    AlignmentError
        No heading is recorded, or of speed and course but one.
    """
    pairs = (("x", "y"), ("sog",), ("cog",))
    told = [n for names in pairs if {*names} <= {*trial.signals} for n in names]
    if not any(antenna.values()) or not told:
        return trial
    if "psi" not in trial.signals:
        raise AlignmentError(
            f"trial {trial.name!r}: the ship file has an [antenna], and without a heading nobody "
            f"knows where it was, which {', '.join(told)} needs; map psi, or take the section out"
        )
    ahead, aside = arm(antenna, trial.signals.get("phi", np.zeros(trial.samples)))
    moved = _position(trial, ahead, aside) if "x" in told else {}
    moved |= _velocity(trial, ahead, aside) if {"sog", "cog"} & {*told} else {}
    moved = {n: x for n, x in moved.items() if n in told}
    known = trial.valid["psi"] & trial.valid.get("r", True)
    valid = {**trial.valid, **{n: trial.valid[n] & known for n in moved}}
    names = ", ".join(moved)
    remark = f"{names}: moved from the antenna to the origin by the ship file's [antenna]"
    signals = {**trial.signals, **moved}
    return replace(trial, signals=signals, valid=valid, remarks=(*trial.remarks, remark))


def _position(trial: Trial, ahead: Vector, aside: Vector) -> dict[str, Vector]:
    psi = trial.signals["psi"]
    north = ahead * np.cos(psi) - aside * np.sin(psi)
    east = ahead * np.sin(psi) + aside * np.cos(psi)
    return {"x": trial.signals["x"] - north, "y": trial.signals["y"] - east}


def _velocity(trial: Trial, ahead: Vector, aside: Vector) -> dict[str, Vector]:
    """Speed and course of the origin: what turning and rolling do at the antenna taken off.

    A course alone is moved by the recorded speed u, of a speed alone nobody knows the direction.
    """
    s = trial.signals
    speed = s.get("sog", s.get("u"))
    if "cog" not in s or speed is None:
        lacks = "cog" if "cog" not in s else "sog"
        raise AlignmentError(
            f"trial {trial.name!r}: the ship file has an [antenna], and what turning adds to speed "
            f"and course there needs both; map {lacks} too, or take the section out"
        )
    r = s.get("r", np.gradient(s["psi"], trial.period))
    drift = s["cog"] - s["psi"]
    u = np.abs(speed) * np.cos(drift) + r * aside
    v = np.abs(speed) * np.sin(drift) - r * ahead - np.gradient(aside, trial.period)
    turned = np.angle(np.exp(1j * (np.arctan2(v, u) - drift)))
    return {"sog": np.hypot(u, v), "cog": s["cog"] + turned}


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
