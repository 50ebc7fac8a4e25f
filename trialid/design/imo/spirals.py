"""Spirals in a record: angles that go down by steps from one side to the other."""

import itertools
import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from trialid.design.imo.excursions import MIDSHIPS, SteeredRecord
from trialid.design.imo.recognition import Recognised

RECENT: Final = 200
"""Samples that tell where a rudder is held."""
STEPS: Final = 5
"""Angles of a spiral at least, of both sides."""


def find_spirals(record: SteeredRecord) -> Iterator[Recognised]:
    """Angles held one after another that go down by steps through midships to the other side."""
    levels = list(_levels(record))
    place = 0
    while place < len(levels):
        run = [levels[place]]
        for begin, end, angle in levels[place + 1 :]:
            down = (run[-1][2] - angle) * np.sign(run[0][2])
            if down <= MIDSHIPS / 3.0 or begin - run[-1][1] > record.clock:
                break
            run.append((begin, end, angle))
        if len(run) >= STEPS and run[0][2] * run[-1][2] < 0.0:
            first = _left_midships(record, run[0][0])
            yield Recognised(
                kind="spiral",
                execute=first,
                end=run[-1][1],
                rudder=run[0][2],
                course=float(record.psi[first]),
            )
            place += len(run)
        else:
            place += 1


def _left_midships(record: SteeredRecord, k: int) -> int:
    """The sample after which the rudder went over to where it is at a later one."""
    side = np.sign(record.rudder[k])
    while k > 0 and record.rudder[k - 1] * side > MIDSHIPS / 2.0:
        k -= 1
    return k


def _levels(record: SteeredRecord) -> Iterator[tuple[int, int, float]]:
    """Stretches of at least two ship lengths in which the rudder stays within a degree."""
    angles, begin = record.rudder.tolist(), 0
    summed = [0.0, *itertools.accumulate(angles)]
    for k, angle in enumerate([*angles, math.inf]):
        first = max(begin, k - RECENT)
        if k == begin or abs(angle - (summed[k] - summed[first]) / (k - first)) <= MIDSHIPS / 3.0:
            continue
        if k - begin >= 2 * record.clock:
            yield begin, k, float(np.median(record.rudder[begin:k]))
        begin = k
