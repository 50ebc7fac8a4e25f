"""Where the rudder keeps the ship on her course: it answers what the model does not know.

A gust turns the ship, and her autopilot takes the rudder against it. To a model that knows of the
rudder alone its small angles then do less than they should, or nothing, and what the model lacks
looks like a dead band (Söderström & Stoica 1989, System Identification, ch. 10: of a record of a
closed loop the error of the output is not without bias). In 5 of 8 missions of a boat without one
a `rudder_deadband` of 0.3 to 0.6 deg was named, once by p = 0.008; with the same rudder and other
gusts in none of 4. Which way round cause and effect are, the rate says: a rudder that turns the
ship comes before it and has its sign, one that stops her turning has the other.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.diagnosis.records.rudder_jumps import own_time
from trialid.identification.explained import of_use
from trialid.identification.fit import Fit
from trialid.identification.inadequate import Inadequate
from trialid.identification.output_error import stretches
from trialid.ship.effect import Effect
from trialid.trial import Trial

SMALL: Final = 0.3
"""Share of the rudder's large angles, their mean weighed by their squares, up to which an angle is
small. Of 15 records of strangers' autopilots 14 are found, in more than a tenth of their time, of
16 missions of a boat all; half of it finds 11, twice 11, all of the missions both. What 5 % of the
angles exceed found 10 of the 15: where turns are rare it is small itself, and in 4 of 4 such
records in gusts a dead band was named that the ship did not have."""

SPAN: Final = 7.0
"""Times in which the ship goes her length that a window lasts: within it the course is one. Half of
it finds 15 of the 16, twice all."""

OVERLAP: Final = 5
"""Windows that each sample lies in, so that what is kept is found to its ends; 2, 10: the same."""

STEP: Final = 0.25
"""The same time of a step, over which noise is averaged; half and twice find all."""

FOLLOWS: Final = 0.5
"""Share of a small rudder's motion within such windows that heading and rate explain from which on
it follows them: 0.84 to 0.96 in those 16, so that half finds the same and twice none. Of 36 sets
of zig-zags, circles and random tests none is taken for one, as the rate has the other sign."""

MOSTLY: Final = 0.5
"""Part of what an effect of the rudder takes off that lies in such windows from which on it is of
what the rudder answers there: 0.81 and more in those 16, so that half says the same; twice asks for
all of it, which three of them have."""


ON_COURSE: Final = 0.3
"""Share of the time from which on a record is of her course. Of the strangers' 15 records those
without a fit have 0.34 to 0.95, of 24 that no autopilot sailed one has 0.22, the others 0.1 at
most: half of it would tell it of that one, twice of two of the four."""


def by_the_rudder(effect: Effect) -> bool:
    """Whether what an effect does goes by the angle of the rudder."""
    return "delta" in effect.signals


def gained_on_course(before: Fit, after: Fit) -> bool:
    """Whether an effect takes off most of what it does while the rudder keeps her on her course."""
    gained = np.square(before.residual), np.square(after.residual)
    if len(gained[0]) != len(gained[1]):  # a delay compares other samples
        return False
    kept = stretches_on_course(before.problem.trials, own_time(before))
    fall = gained[0] - gained[1]
    parts = stretches(before.problem)
    inside = sum(float(fall[p.rows] @ kept[p.trial][p.compared]) for p in parts)
    return inside > MOSTLY * float(fall.sum()) > 0.0


def zigzag_first(fit: Fit, failed: Inadequate) -> Inadequate:
    """Why there is no fit, with a zig-zag to sail where mostly the rudder keeps her on her course.

    First where the search failed: of four missions of an outsider's boat in waves 59 % of the rate
    was left, and what was advised was to free fewer parameters.
    """
    kept = _kept(fit)
    if not kept > ON_COURSE:
        return failed
    zigzag = f"fit a zig-zag, {_told(kept)}, which tells little of her rudder"
    ways = (failed.advice, zigzag) if fit.converged else (zigzag, failed.advice)
    return replace(failed, advice="; or ".join(ways))


def mostly_on_course(fit: Fit) -> tuple[str, ...]:
    """What to read beside the numbers of a fit to records that are mostly of her course.

    Of an outsider's three voyages, 93 % of whose time is, the likely range of Ndelta ended at a
    quarter of what it is: an error that the rudder itself answers is none of noise.
    """
    if not {"delta", "delta_order"} & {*fit.problem.simulator.equations.inputs}:
        return ()
    kept = _kept(fit)
    said = (
        f"{_told(kept)}: her rudder answers there what the model does not know, and the likely "
        "ranges of numbers are too narrow for what that does; fit a zig-zag, or rudders put over "
        "and held"
    )
    return (said,) if kept > ON_COURSE else ()


def _told(kept: float) -> str:
    return f"for {kept:.0%} of the time an autopilot keeps her on her course"


def _kept(fit: Fit) -> float:
    """Share of the time of fitted trials in which she is kept on her course."""
    fitted = [score.trial for score in of_use(fit, "fit")]
    return float(np.concatenate(stretches_on_course(fitted, own_time(fit))).mean())


def stretches_on_course(trials: Sequence[Trial], own_time: float) -> tuple[Mask, ...]:
    """Samples in which a small rudder follows heading and rate; (N,) for each trial.

    Parameters
    ----------
    own_time
        Time in which the ship goes her own length [s].
    """
    none = tuple(np.zeros(t.samples, dtype=bool) for t in trials)
    able = [i for i, t in enumerate(trials) if {"delta", "r"} <= {*t.signals}]
    if not able:
        return none
    small = SMALL * _large(np.concatenate([np.abs(trials[i].signals["delta"]) for i in able]))
    found = [(i, at, rows) for i in able for at, rows in _windows(trials[i], own_time, small)]
    if not found or not _follows(np.concatenate([rows for _, _, rows in found])):
        return none
    for i, at, _ in found:
        none[i][at] = True
    return none


def _large(angles: Vector) -> float:
    """The angle at which most of what the rudder does is done, however rarely; 0 where it rests."""
    return float((angles**3).sum() / max((angles**2).sum(), 1e-300))


def _windows(trial: Trial, own_time: float, small: float) -> list[tuple[slice, Vector]]:
    """Windows in which the rudder is small all along, with their rows.

    The rows are heading, rate and rudder, in steps, each less its mean and its trend; (n, 3).
    """
    step = max(round(STEP * own_time / trial.period), 1)
    count = max(round(SPAN * own_time / (step * trial.period)), 8)
    length, known = count * step, trial.valid["delta"] & trial.valid["r"]
    made = []
    for start in range(0, trial.samples - length + 1, max(length // OVERLAP, 1)):
        at = slice(start, start + length)
        if not known[at].all() or np.abs(trial.signals["delta"][at]).max() > 2.0 * small:
            continue
        r, delta = (trial.signals[n][at].reshape(count, step).mean(axis=1) for n in ("r", "delta"))
        if np.abs(delta).max() <= small:
            made.append((at, _plain(np.column_stack([np.cumsum(r), r, delta]))))
    return made


def _plain(columns: Vector) -> Vector:
    """Columns less their means and trends."""
    along = np.linspace(-1.0, 1.0, len(columns))
    known = np.column_stack([np.ones_like(along), along])
    return np.asarray(columns - known @ np.linalg.lstsq(known, columns, rcond=None)[0])


def _follows(rows: Vector) -> bool:
    """Whether the rudder goes against heading and rate, and mostly by them."""
    motion, delta = rows[:, :2], rows[:, 2]
    gains = np.linalg.lstsq(motion, delta, rcond=None)[0]
    left = delta - motion @ gains
    return bool(np.all(gains < 0.0) and left @ left < (1.0 - FOLLOWS) * (delta @ delta))
