"""A speed without a sign, where course and heading tell that the ship goes astern."""

from dataclasses import replace
from typing import Final

import numpy as np

from trialid.alignment.track.antenna import MOVING
from trialid.arrays import Mask, Vector
from trialid.trial import Trial

ALONG: Final = 0.8
"""Mean cosine, ahead or astern, from which a course is one of this heading: 37 deg of drift. A boat
that spins between two runs has 0.9, a course by another clock or in other axes about 0.6."""

LEAST: Final = 0.01
"""Share of what she moves from which on she is said to go astern: the course of a boat that
goes ahead alone is off by 90 deg in none of it, and one that backs has 0.05 and more."""


def astern(speed: Vector, course: Vector, heading: Vector, known: Mask) -> Mask | None:
    """Where course and heading [rad] are more than 90 deg apart; None where she never goes astern.

    None too where the course does not follow the heading, or mostly against it: then the heading
    may be off by half a turn.
    """
    if not moves_along(speed, course, heading, known):
        return None
    back = np.cos(course - heading) < 0.0
    return back if LEAST <= float(np.mean(back[_moving(speed, known)])) < 0.5 else None


def moves_along(speed: Vector, course: Vector, heading: Vector, known: Mask) -> bool:
    """Whether she moves ahead or astern of this heading [rad], and not across it, in the mean."""
    moving = _moving(speed, known)
    along = np.abs(np.cos(course - heading))[moving]
    return bool(moving.any()) and float(np.mean(along)) >= ALONG


def _moving(speed: Vector, known: Mask) -> Mask:
    return known & (speed > MOVING * np.median(speed[known])) if known.any() else known


def with_sign(trial: Trial) -> Trial:
    """The trial, its speed u negative where she goes astern and it was recorded without a sign.

    Only where `cog` and `psi` are given beside it, and it is nowhere negative; it is remarked.
    """
    if not {"u", "cog", "psi"} <= {*trial.signals}:
        return trial
    u = trial.signals["u"]
    known = trial.valid["u"] & trial.valid["cog"] & trial.valid["psi"]
    if not known.any() or u[known].min() < 0.0:
        return trial
    back = astern(u, trial.signals["cog"], trial.signals["psi"], known)
    if back is None:
        return trial
    seconds = float(back.sum()) * trial.period
    remark = (
        f"u: read as negative in {seconds:.3g} s, where course and heading "
        "are more than 90 deg apart: she goes astern there, and the record has no sign"
    )
    signals = {**trial.signals, "u": np.where(back, -u, u)}
    return replace(trial, signals=signals, remarks=(*trial.remarks, remark))
