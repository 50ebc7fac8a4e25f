"""Standard measures of manoeuvring as plain data."""

from collections.abc import Sequence

from trialid.design.standard import Measure
from trialid.result.finding_rows import MeasureRow


def measure_rows(measures: Sequence[Measure]) -> tuple[MeasureRow, ...]:
    """The standard measures beside what is allowed."""
    return tuple(
        MeasureRow(
            name=m.criterion.name,
            unit=m.criterion.unit,
            value=m.value,
            interval=m.interval,
            allowed=m.criterion.largest,
            kept=m.kept,
            manoeuvre=m.criterion.words,
        )
        for m in measures
    )
