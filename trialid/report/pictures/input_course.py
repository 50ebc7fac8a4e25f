"""The inputs of a trial against its time as pictures, for paper."""

from collections.abc import Iterator

from trialid.names import labels, units
from trialid.report.pictures.figures import LEFT, WIDE, clock, panel, svg
from trialid.result.series import TrialSeries

HEIGHT = 80.0


def input_courses(trial: TrialSeries) -> Iterator[str]:
    """An SVG an input, in the unit shown."""
    for name, values in trial.inputs.items():
        quantity = trial.quantity(name)
        lines = {"measured": values * units.shown_factor(quantity)}
        body = panel(trial.t, lines, 0.0, HEIGHT) + clock(trial.t, HEIGHT + 14.0)
        title = f"{trial.name}: {labels.label(name)} [{quantity.shown}]"
        drawn = f'<g class="trial">{body}</g>'
        yield svg(LEFT + WIDE + 10.0, HEIGHT + 20.0, drawn, title)
