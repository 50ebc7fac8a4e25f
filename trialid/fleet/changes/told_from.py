"""How large a change would have to be to be told: what `no changes found` leaves open."""

from collections.abc import Iterable
from typing import Final

import numpy as np
from scipy.stats import f

from trialid.fleet.changes.change_points import WAYS
from trialid.fleet.changes.changes_of_ships import LEVEL, estimates_of, records_of
from trialid.fleet.changes.courses import (
    TINY,
    Course,
    Estimates,
    columns_of,
    courses_of,
    is_change,
    sizes_of,
    sum_of_rest,
    take_away,
)
from trialid.names import wording
from trialid.result.fleet_rows import ChangeRow, FittedRow, Remark, RunRow

NAMED: Final = 8
"""Parameters that a line names, those best known, before it only counts the others."""


def told_from(
    runs: Iterable[RunRow], fitted: Iterable[FittedRow], found: Iterable[ChangeRow]
) -> tuple[Remark, ...]:
    """For each ship the parameters without a change, and from which step on it would be told."""
    changed = {(row.ship, row.parameter) for row in found}
    records = records_of(runs, fitted)
    ships: dict[str, dict[str, float]] = {}
    for rows in records:
        first = rows[0]
        if first.kind == "physical" and (first.ship, first.parameter) not in changed:
            estimates, _ = estimates_of(rows)
            own = ships.setdefault(first.ship, {})
            least = least_step(estimates, LEVEL / len(records))
            own[first.parameter] = max(least, own.get(first.parameter, 0.0))
    return tuple(Remark(ship=ship, words=_words(own)) for ship, own in ships.items())


def least_step(y: Estimates, level: float) -> float:
    """The least step in the middle of a record that is told beside its scatter, over its level.

    The scatter is what the best change leaves, though none is told: else one that passed unseen
    would count as scatter. Of a rudder that lost 15 % in four fleets 21 to 25 % are named so, 54 to
    63 % else; 20 % lost is told of another.
    """
    middle: Course = ("step", len(y) // 2)
    column, _ = take_away(y, [], columns_of(y, [middle]))
    freedom, tried = len(y) - 2, courses_of(y.time)
    left = min(sum_of_rest(y, [one]) for one in tried if is_change(one))
    scatter = max(y.least, left / (freedom - 1), TINY)
    gain = scatter * float(f.isf(level / WAYS / len(tried), 1, freedom))
    size = float(np.sqrt(gain / max(float(np.sum(column**2)), TINY)))
    return size / max(abs(float(sizes_of(y, [])[0])), TINY)


def _words(own: dict[str, float]) -> str:
    surest = sorted((n for n in own if own[n] < 1.0), key=lambda name: own[name])
    each = [f"{wording.percent(own[name], 2)} of {name}" for name in surest[:NAMED]]
    more = len(surest) - NAMED
    listed = f"{', '.join(each)} and {more} more" if more > 0 else wording.named_together(each)
    return (
        "a change that lasts from the middle of her voyages on is as likely told as not at "
        f"{listed}; less may have passed"
        if each
        else "no parameter is known so well that losing all of it would be told"
    )
