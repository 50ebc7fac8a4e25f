"""The changes of a fleet: its tables parted into records, each explained, and told as rows."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.fleet.changes.change_points import Found, Varies, explain
from trialid.fleet.changes.courses import Estimates
from trialid.fleet.changes.of_voyage import NORMAL, each_of_voyage
from trialid.result.fleet_rows import ChangeRow, FittedRow, RunRow

LEVEL: Final = 0.05
"""Share of fleets without any change in which one is found."""
FEWEST: Final = 6
"""Voyages from which on changes are sought: two on either side, and two for the scatter."""


def changes(runs: Iterable[RunRow], fitted: Iterable[FittedRow]) -> Iterator[ChangeRow]:
    """Every change in a fleet's records, and what varies otherwise, ship by ship."""
    records = records_of(runs, fitted)
    for rows in records:
        estimates, unit = estimates_of(rows)
        found = explain(estimates, LEVEL / len(records))
        told = [_row(rows, estimates, each) for each in found.changes]
        if found.varies and rows[0].kind == "physical":  # what is each trial's may
            told.append(_varies(rows, found.varies))
        for row in told:
            p_value = min(1.0, len(records) * row.p_value)
            yield replace(row, size=row.size * unit, p_value=p_value)


def with_a_say(runs: Iterable[RunRow]) -> list[RunRow]:
    """Runs that changes are sought in: those with a fit; where voyages are dated, no others."""
    sound = [row for row in runs if is_sound(row)]
    dated = {row.ship for row in sound if row.date is not None}
    return [row for row in sound if row.date is not None or row.ship not in dated]


def is_sound(row: RunRow) -> bool:
    """Whether a run has a fit."""
    return row.failure is None and row.verdict != "no fit"


def records_of(runs: Iterable[RunRow], fitted: Iterable[FittedRow]) -> list[list[FittedRow]]:
    """The records that are long enough: a parameter of a ship in one model, done in one way."""
    models = {row.run: row.model for row in with_a_say(runs)}
    courses: dict[tuple[object, ...], list[FittedRow]] = {}
    for row in each_of_voyage(fitted):
        known = row.value is not None and _deviation(row) > 0.0
        if row.run in models and known:
            key = (row.ship, *row.varied, models[row.run], row.parameter)
            courses.setdefault(key, []).append(row)
    return [rows for rows in courses.values() if len(rows) >= FEWEST]


def estimates_of(rows: Sequence[FittedRow]) -> tuple[Estimates, float]:
    """Estimates in units of their usual deviation, and that unit."""
    x = np.array([row.value for row in rows], dtype=float)
    deviation = np.array([_deviation(row) for row in rows])
    noise = np.array([row.standard_error or 0.0 for row in rows])
    unit = float(np.median(deviation))
    least = float(np.median((noise / deviation) ** 2))
    return Estimates(x / unit, deviation / unit, least, _days(rows)), unit


def _days(rows: Sequence[FittedRow]) -> Vector | None:
    dates = [row.date for row in rows if row.date is not None]
    if len(dates) < len(rows):
        return None
    return np.array([(each - dates[0]).days for each in dates], dtype=float)


def _deviation(row: FittedRow) -> float:
    """The standard deviation that a likely range stands for; 0 where there is none."""
    if row.likely_low is None or row.likely_high is None:
        return 0.0
    wide = 0.5 * (row.likely_high - row.likely_low) / NORMAL
    return wide if np.isfinite(wide) else 0.0


def _row(rows: Sequence[FittedRow], y: Estimates, found: Found) -> ChangeRow:
    """A change; it may have been any day after the last voyage before it."""
    form, first = found.course
    wide = NORMAL * y.deviation
    open_ = np.hypot(np.median(wide[:first]), np.median(wide[first:]))
    return ChangeRow(
        ship=rows[0].ship,
        parameter=rows[0].parameter,
        unit=rows[0].unit,
        form="step" if form == "step" else "drift",
        voyage=rows[first].voyage,
        date=rows[first].date,
        earliest=rows[found.ends[0] - 1].voyage,
        latest=rows[found.ends[1]].voyage,
        size=found.size,
        relative=found.size / found.level if found.level else None,
        p_value=found.p_value,
        beyond_likely=bool(abs(found.size) > open_),
    )


def _varies(rows: Sequence[FittedRow], found: Varies) -> ChangeRow:
    return ChangeRow(
        ship=rows[0].ship,
        parameter=rows[0].parameter,
        unit=rows[0].unit,
        form="varies",
        voyage=rows[found.voyage].voyage,
        date=rows[found.voyage].date,
        earliest=rows[0].voyage,
        latest=rows[-1].voyage,
        size=found.size,
        relative=found.size / found.level if found.level else None,
        p_value=found.p_value,
        beyond_likely=found.beyond,
    )
