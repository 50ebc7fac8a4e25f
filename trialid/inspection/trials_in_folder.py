"""A folder of logs: files that follow one another are one trial, others a trial each."""

from collections.abc import Sequence
from itertools import combinations, pairwise
from typing import Final

from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.relations import recognise

SEAM: Final = 0.1
"""Share of the shorter file by which two files of one recording may overlap or lie apart. A
recorder that splits its log leaves a sample or two; between trials a ship turns back, for as long
as a trial or longer. Half and twice of it say the same of all folders at hand."""


def follow_one_another(files: Sequence[Sequence[ChannelInspection]]) -> bool:
    """Whether files are one recording, cut by the clock or by topic.

    Each file by its channels. Logs that each begin at zero, of the same hour, or of hours apart are
    several trials.
    """
    if not any(_alike(one, other) for one, other in combinations(files, 2)):
        return True  # a file a topic
    spans = sorted((min(c.start for c in f), max(c.end for c in f)) for f in files if f)
    return all(_meet(one, after) for one, after in pairwise(spans))


def _alike(one: Sequence[ChannelInspection], other: Sequence[ChannelInspection]) -> bool:
    """Whether two files hold the same: a channel, or two of the ship's motions and orders."""
    if {c.key for c in one} & {c.key for c in other}:
        return True
    return len(_quantities(one) & _quantities(other)) > 1


def _quantities(channels: Sequence[ChannelInspection]) -> set[str]:
    known = recognise({c.key: c for c in channels}).values()
    return {c.guess.quantity for c in known if c.guess}


def _meet(one: tuple[int, int], after: tuple[int, int]) -> bool:
    """Whether the second begins about where the first ends."""
    shorter = min(one[1] - one[0], after[1] - after[0])
    return abs(after[0] - one[1]) <= SEAM * shorter
