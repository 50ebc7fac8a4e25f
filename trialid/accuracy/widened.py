"""The table of parameters with the likely range of each, and as wide as other models say."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from trialid.accuracy.likely import Averaged
from trialid.accuracy.parameter_table import Accuracy, ParameterAccuracy
from trialid.accuracy.ranges import (
    ANOTHER_GM,
    Range,
    by_share,
    cut_to_ends,
    share_off,
    wider,
)


def with_ranges(accuracy: Accuracy, averaged: Averaged) -> Accuracy:
    """The same with the likely range of every parameter, from what may be missing."""
    rows = tuple(_with_range(row, i, averaged) for i, row in enumerate(accuracy.parameters))
    return replace(accuracy, parameters=rows)


def _with_range(row: ParameterAccuracy, place: int, averaged: Averaged) -> ParameterAccuracy:
    """The row with its likely range; what belongs to a trial or a sensor has none."""
    if row.kind != "physical":
        return row
    likely = averaged.range(place, row.value, row.standard_error, row.freedom)
    likely = by_share(row.value, likely)
    return replace(row, likely=cut_to_ends(likely, row.ends), widened_by=averaged.widest[place])


def embrace(accuracy: Accuracy, others: Sequence[tuple[str, Accuracy]]) -> Accuracy:
    """The same with ranges that hold what other models of the ship say of each parameter.

    By slopes a fit far off foretells half of the way that its parameters go when what is missing is
    added.

    Parameters
    ----------
    others
        What each has besides, which widens a range that it reaches furthest of, and its table.
    """
    said = [(what, {row.name: row.likely for row in there.parameters}) for what, there in others]
    rows = (
        _embraced(row, [(what, there.get(row.name)) for what, there in said])
        for row in accuracy.parameters
    )
    return replace(accuracy, parameters=tuple(rows))


def _embraced(
    row: ParameterAccuracy, others: Sequence[tuple[str, Range | None]]
) -> ParameterAccuracy:
    likely, widened_by = row.likely, row.widened_by
    for what, there in others:
        further = wider(likely, there)
        if (share_off(row.value, further) or 0.0) > (share_off(row.value, likely) or 0.0):
            widened_by = what
        likely = further
    return replace(row, likely=likely, widened_by=widened_by)


def with_rivals(accuracy: Accuracy, rivals: Sequence[Mapping[str, float]]) -> Accuracy:
    """The same with ranges that reach about each rival by the share they reach about the fit.

    Parameters
    ----------
    rivals
        Values of the unknowns by name that fit as well or hardly worse.
    """
    rows = tuple(
        _with_rivals(row, [values[row.name] for values in rivals if row.name in values])
        for row in accuracy.parameters
    )
    return replace(accuracy, parameters=rows)


def _with_rivals(row: ParameterAccuracy, rivals: Sequence[float]) -> ParameterAccuracy:
    if row.likely is None or not rivals or not row.value:
        return row
    low, high = row.likely
    reached = [(low, high)]
    for rival in rivals:
        share = max(1.0, abs(rival / row.value))
        reached.append((rival - share * (row.value - low), rival + share * (high - row.value)))
    whole = (min(x for x, _ in reached), max(x for _, x in reached))
    much = whole[1] - whole[0] > 2.0 * (high - low)
    widened_by = ANOTHER_GM if much else row.widened_by
    return replace(row, likely=cut_to_ends(whole, row.ends), widened_by=widened_by)
