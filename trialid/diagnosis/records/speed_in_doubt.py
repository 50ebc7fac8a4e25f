"""Whether the log of her speed can be believed: one that stands still while she turns, or her U0.

A speed that is logged drives the model, and no output shows that it is wrong: of one dead in one
trial of four `rudder_stall` was named, of knots that are called m/s in all of them whatever stands
in for half of her turns.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.diagnosis.records.unit_in_doubt import ABOUT, too_large
from trialid.identification.approach import approach_speed, logged_speed
from trialid.identification.fit import Fit
from trialid.trial import Trial

VALUES: Final = 4
"""Values that a log takes where it is alive: at half of it a coarse one that stands between two is.
Of 73 sets of an outsider's the same one, dead in a trial, is told at half and at ten times."""

FASTER: Final = (("kn", "m/s"), ("km/h", "kn"), ("km/h", "m/s"))
"""Units of a speed too large, and what they are called: half of what a file says she may well do,
twice of it no ship does."""


def speed_in_doubt(fit: Fit) -> str | None:
    """What speaks against the log of her speed, and in which trials; None where nothing does."""
    logged = [t for t in fit.trials if len(logged_speed(t))]
    return _stands_still(logged) or _another_unit(fit, logged)


def _stands_still(logged: Sequence[Trial]) -> str | None:
    """That it does not move in a trial, and does in another in which she turns no more."""
    turning = [t for t in logged if "r" in t.signals]
    moving = [t for t in turning if len(np.unique(logged_speed(t))) >= VALUES]
    least = min((_turn(t) for t in moving), default=np.inf)
    dead = [t for t in turning if np.ptp(logged_speed(t)) == 0.0 and _turn(t) >= least]
    if not dead:
        return None
    names, lively = ", ".join(t.name for t in dead), min(moving, key=_turn)
    stands, moves = logged_speed(dead[0])[0], np.ptp(logged_speed(lively))
    return (
        f"the speed stands at {stands:.4g} m/s throughout {names}, and moves by {moves:.2g} m/s in "
        f"{lively.name}, in which she turns no more: the log is dead there; mend that, or leave "
        "the trial out"
    )


def _turn(trial: Trial) -> float:
    """Rate of turn that she seldom exceeds in the trial [rad/s]."""
    return float(np.quantile(np.abs(trial.signals["r"]), 0.99))


def _another_unit(fit: Fit, logged: Sequence[Trial]) -> str | None:
    """That she is as much faster in all trials than her file says as a unit is larger.

    Not of a boat with drives of her own, whose orders make her speed: of the Otter at 1.84 m/s
    under steps of both thrusters, with U0 of 1 m/s in her file, a weak one was not named.
    """
    stated = fit.model.ship.particulars["U0"]
    speeds = [speed for t in logged if (speed := approach_speed(t)) is not None]
    driven = any(a.kind != "rudder" for a in fit.model.ship.actuators)
    if not speeds or stated <= 0.0 or driven:
        return None
    times = np.array(speeds) / stated
    units = [
        f"in {one} and called {called}"
        for one, called in FASTER
        if np.all(np.abs(times / too_large(one, called) - 1.0) < ABOUT)
    ]
    if not units:
        return None
    return (
        f"she sails at {np.median(speeds):.3g} m/s in all trials, {np.median(times):.3g} times the "
        "U0 of her file: either that is another ship's or another draught's, or the log is "
        f"{', or '.join(units)}"
    )
