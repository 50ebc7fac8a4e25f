"""Williamson turns in a record: out to one side, round by the other, steady on the old track.

After the IAMSAR manual, vol. III: hard over until the heading has changed by 60 deg, hard over to
the other side until 20 deg before the reciprocal course, and there she is steadied.
"""

import itertools
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.excursions import (
    STRAIGHT,
    Excursion,
    SteeredRecord,
    given_back,
    is_held,
    reverses,
)
from trialid.design.imo.recognition import Recognised

QUARTER: Final = np.pi / 2.0
AWAY: Final = float(np.deg2rad(30.0))
"""Heading away from the old course, at least, at which the rudder is put over, and at most a right
angle: half of the manual's 60 deg and half as much again. Crews know their own ship's figure. Half
changes nothing on the days that `excursions` speaks of, by twice 4 of 65 manoeuvres are lost."""
NEAR: Final = float(np.deg2rad(30.0))
"""From the reciprocal course within which she is steadied; from further off it is another turn.
Half and twice change nothing on those days."""
SETTLES: Final = 10.0
"""Ship lengths, of time at approach speed, in which she is steady after the rudder was eased. By
half of it one turn of those days is lost, by twice none is added."""


KEPT: Final = 3.0
"""Ship lengths, of time at approach speed, for which she keeps the new course: coming round she has
lost half of her speed, and one length of it is soon over. It is where such a turn ends."""


def find_williamson_turns(record: SteeredRecord, free: Sequence[Excursion]) -> Iterator[Recognised]:
    """Two held rudders of one angle, out and round, and a steady course back."""
    for out, back in itertools.pairwise(free):
        if not (is_held(out) and is_held(back) and reverses(record, out, back, out.angle)):
            continue
        course = record.straight(out.begin)
        if course is None:
            continue
        side = float(np.sign(out.angle))
        over, eased = given_back(record, out, back.begin), given_back(record, back, back.end)
        goal = course - side * np.pi
        last = min(eased, len(record.psi) - 1)
        away, round_ = (side * (record.psi[k] - course) for k in (over, last))
        if not AWAY <= away <= QUARTER or round_ > -QUARTER:
            continue
        steady = _steady_sample(record.psi, eased, record.clock, goal)
        ends = eased + round(KEPT * record.clock) > len(record.psi)
        if steady is None and not ends:
            continue
        yield Recognised(
            kind="Williamson turn",
            execute=out.begin,
            end=len(record.psi) if steady is None else steady + round(KEPT * record.clock),
            rudder=out.angle,
            course=course,
            reversals=(over,),
            steady=steady,
            remark="the record ends before she was steady" if steady is None else "",
        )


def _steady_sample(psi: Vector, eased: int, clock: int, goal: float) -> int | None:
    """The first sample from which she keeps the course that she has `KEPT` ship lengths later.

    It is near `goal` [rad].
    """
    span = round(KEPT * clock)
    part = psi[eased : eased + round(SETTLES * clock) + span]
    if len(part) < span:
        return None
    windows = np.lib.stride_tricks.sliding_window_view(part, span)
    course = windows[:, -clock:].mean(axis=1)
    kept = np.abs(windows - course[:, None]).max(axis=1) <= STRAIGHT
    found = np.flatnonzero(kept & (np.abs(course - goal) <= NEAR))
    return eased + int(found[0]) if len(found) else None
