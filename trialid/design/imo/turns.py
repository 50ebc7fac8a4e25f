"""Turning circles that a record with a track holds, and what reads their measures."""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage
from trialid.design.imo import measures
from trialid.design.imo.excursions import STEP, order_doubt, order_sample, rudder_of
from trialid.design.imo.recognition import Recognised
from trialid.design.imo.sailed_trial import Track
from trialid.design.imo.track_numbers import TrackReader
from trialid.trial import Trial

NEEDED: Final = ("x", "y", "psi")
ORDER: Final = (order_sample, order_doubt)
"""When a rudder was ordered over, and how well that is known."""
SAGITTA: Final = 0.005
"""Share of the turn's own size by which a straight line over a gap in its positions may be off the
arc: an eighth of the chord times the angle turned. Of 60 circles of a 175 m ship with 1 m of noise
and a gap of up to 0.3 of the turn, 8 are taken and the worst number is off by 1.5 %; by half of it
6 and 1.1 %, by twice 13 and 1.8 %."""


@dataclass(frozen=True, kw_only=True)
class Turn:
    """A turn by a held rudder, recognised: order at `t` [s], angle [rad], samples it spans.

    `course` is the mean heading before the order [rad], `doubt` the order's standard deviation
    [samples].
    """

    t: float
    rudder: float
    begin: int
    end: int
    course: float
    doubt: float = STEP


def find_turns(trial: Trial, found: Sequence[Recognised]) -> Iterator[Turn]:
    """The turning circles among what was recognised in a trial, where its track shows them."""
    rudder = rudder_of(trial)
    if rudder is None or not {*NEEDED} <= {*trial.signals}:
        return
    for one in found:
        if one.kind != "turning circle":
            continue
        t, doubt = (f(rudder[: one.end], one.execute, one.rudder) for f in ORDER)
        turn = Turn(
            t=t * trial.period,
            rudder=one.rudder,
            begin=int(t),
            end=one.end,
            course=one.course,
            doubt=doubt,
        )
        if is_seen(trial, slice(turn.begin, turn.end)):
            yield turn


def is_seen(trial: Trial, span: slice) -> bool:
    """Whether positions and heading are there in a span, but for gaps that bridge well."""
    valid = np.all([trial.valid[n][span] for n in NEEDED], axis=0)
    if not len(valid) or not valid[0]:
        return False
    x, y, psi = (trial.signals[n][span] for n in NEEDED)
    there = np.flatnonzero(valid)
    gaps = [(a, b) for a, b in itertools.pairwise(there.tolist()) if b > a + 1]
    off = [np.hypot(x[b] - x[a], y[b] - y[a]) * abs(psi[b] - psi[a]) / 8.0 for a, b in gaps]
    size = np.hypot(np.ptp(x[there]), np.ptp(y[there]))
    return bool(max(off, default=0.0) <= SAGITTA * size and there[-1] >= len(valid) - 2)


def measure(turn: Turn, t: Vector, track: Mapping[str, Vector]) -> dict[str, float]:
    """Advance, transfer and tactical diameter [m] of a track `x`, `y`, `psi`; (N,) each.

    Raises
    ------
    DesignError
        The heading does not change by 180 deg.
    """
    parts = {n: track[n][turn.begin : turn.end].copy() for n in NEEDED}
    for n in ("x", "y"):
        parts[n][0] = np.interp(turn.t, t, track[n])
    parts["psi"][0] = turn.course
    order = np.full(len(parts["x"]), turn.rudder)
    trial = Trial("turn", "fit", 1.0, {"psi": parts["psi"], "delta_order": order}, {})
    return measures.turning(Passage(trial, parts["x"], parts["y"], None))


def turn_reader(turn: Turn, before: int) -> TrackReader:
    """What reads a turn from a track, its course from so many samples before the order."""
    first = max(turn.begin + 1 - before, 0)
    near = replace(turn, begin=turn.begin - first, end=turn.end - first)

    def read(track: Track, t: Vector, late: float) -> dict[str, float]:
        course = float(np.mean(track["psi"][: near.begin + 1]))
        return measure(replace(near, t=turn.t + late, course=course), t, track)

    units = dict.fromkeys(("advance", "transfer", "tactical diameter"), "m")
    return TrackReader(slice(first, turn.end), turn.t, units, read, turn.doubt)
