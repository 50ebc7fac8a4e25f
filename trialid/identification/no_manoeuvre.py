"""Whether she ever manoeuvres: the rudder of a whole record, and where in a voyage it is used."""

from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.identification.explained import of_use
from trialid.identification.fit import Fit
from trialid.identification.inadequate import Inadequate
from trialid.identification.trial_score import Score
from trialid.simulation.integrate import record_for

RUDDER_RANGE: Final = 0.035
"""[rad] From the 5th to the 95th percentile, 2 deg: less keeps a course, and is no manoeuvre; a
zig-zag of 2 deg has 4. Half lets a helm pass that corrects by a degree, twice turns that zig-zag
away, which does identify a ship."""

OFTEN: Final = (0.05, 0.95)
SELDOM: Final = (0.005, 0.995)
"""Of a day, seven minutes: a manoeuvre of a small ship. Outliers are fewer."""

AROUND: Final = 60.0
"""[s] Before and after the rudder is used: the ship has come to rest, and shows her bias."""

STRAIGHT: Final = 0.1
"""Share of how fast she turns below which she goes straight on, and shows where amidships is: of
circles to either side, and of voyages with one turn in them, half and twice say the same."""

MOST_TOLD: Final = 8
"""Of a day more are seldom; each takes sixteen letters of one line."""

STEERING: Final = ("delta", "delta_order")
OTHER_HANDS: Final = frozenset({"n_p", "n_s", "X_ext", "Y_ext", "K_ext", "N_ext"})
TURNING: Final = frozenset({"r", "psi", "v"})


def no_manoeuvre(fit: Fit) -> Inadequate | None:
    """The rudder is never used, where nothing else could turn the ship."""
    inputs = {*fit.problem.simulator.equations.inputs}
    steered = [n for n in STEERING if n in inputs]
    if not steered or not TURNING & {*fit.problem.outputs} or inputs & OTHER_HANDS:
        return None
    rudders = [(s, n) for s in of_use(fit, "fit") for n in steered]
    moved = max(_range(s, n, OFTEN) for s, n in rudders)
    if moved > RUDDER_RANGE or any(_is_held_over(s, n) for s, n in rudders):
        return None
    score, name = max(rudders, key=lambda one: _range(one[0], one[1], SELDOM))
    if _range(score, name, SELDOM) > RUDDER_RANGE:
        return _manoeuvres_seldom(score, name, moved)
    return Inadequate(
        f"she never manoeuvres: the rudder moves by {np.rad2deg(moved):.2g} deg, and a manoeuvre "
        f"takes more than {np.rad2deg(RUDDER_RANGE):.2g} deg",
        "fit a zig-zag or a turn, or check which channel is the rudder and in what unit",
    )


def _is_held_over(score: Score, name: str) -> bool:
    """Whether the rudder is held over for more than a tenth, as in a turning circle."""
    signals = score.trial.signals
    if not {"r", "psi"} & signals.keys():
        return False
    turning = np.abs(signals["r"] if "r" in signals else np.gradient(np.unwrap(signals["psi"])))
    straight = turning < STRAIGHT * np.quantile(turning, OFTEN[1])
    if not straight.any():
        return False
    rudder = _rudder(score, name)
    off = np.abs(rudder - np.median(rudder[straight]))
    return bool(np.mean(off > 0.5 * RUDDER_RANGE) > 1.0 - (OFTEN[1] - OFTEN[0]))


def _manoeuvres_seldom(score: Score, name: str, moved: float) -> Inadequate:
    """A voyage with manoeuvres in it: where they are, for a trial each."""
    found = _stretches(score, name)
    windows = ", ".join(f"[{begin:.0f}, {end:.0f}]" for begin, end in found[:MOST_TOLD])
    more = f" and {len(found) - MOST_TOLD} more" if len(found) > MOST_TOLD else ""
    return Inadequate(
        f"she manoeuvres in less than a tenth of {score.trial.name}: in the rest the rudder moves "
        f"by {np.rad2deg(moved):.2g} deg, and counts for most",
        f"cut out the manoeuvres, a trial each: about window = {windows} s from where "
        f"its logs begin{more}",
    )


def _stretches(score: Score, name: str) -> list[tuple[float, float]]:
    """Where the rudder is used, with what comes before and after; (begin, end) each [s]."""
    t, rudder = score.trial.opening + score.trial.t, _rudder(score, name)
    used = t[np.abs(rudder - np.median(rudder)) > 0.5 * RUDDER_RANGE]
    apart = np.flatnonzero(np.diff(used) > 2.0 * AROUND) + 1
    found = [
        (max(float(part[0]) - AROUND, float(t[0])), min(float(part[-1]) + AROUND, float(t[-1])))
        for part in np.split(used, apart)
        if part[-1] - part[0] > score.trial.period
    ]
    return [(a, b) for a, b in found if np.ptp(rudder[(a <= t) & (t <= b)]) > RUDDER_RANGE]


def _rudder(score: Score, name: str) -> Vector:
    source = record_for(score.trial, name)
    assert source is not None  # a trial without it has been refused
    return score.trial.signals[source]


def _range(score: Score, name: str, between: tuple[float, float]) -> float:
    low, high = np.quantile(_rudder(score, name), between)
    return float(high - low)
