"""What several runs predicted of one trial, laid over what was measured: panels for the plots.

Runs are laid over one another only where they saw the same samples: one clock, and the same
measured values wherever both compared them.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from trialid.names import labels
from trialid.report.pictures import panels
from trialid.result.series import OutputSeries, TrialSeries

RunSeries = Mapping[str, Sequence[TrialSeries]]
"""The series of each run by the label it has on the page."""


@dataclass(frozen=True)
class Overlay:
    """A trial of several runs: what is drawn of it, whose it is, and who saw other samples."""

    name: str
    labels: tuple[str, ...]
    elsewhere: tuple[str, ...]
    panels: dict[str, Any]


def overlays(runs: RunSeries) -> list[Overlay]:
    """Every trial that at least two runs saw alike, in the order of the first run that has it."""
    names = dict.fromkeys(trial.name for series in runs.values() for trial in series)
    made = (_overlay(name, _by_run(name, runs)) for name in names)
    return [each for each in made if each is not None]


def _by_run(name: str, runs: RunSeries) -> dict[str, TrialSeries]:
    found = {
        label: [trial for trial in series if trial.name == name] for label, series in runs.items()
    }
    return {label: trials[0] for label, trials in found.items() if trials}


def _overlay(name: str, trials: Mapping[str, TrialSeries]) -> Overlay | None:
    """The trial as its first run saw it, with the others that saw the same."""
    first = next(iter(trials.values()))
    alike = {label: trial for label, trial in trials.items() if _is_alike(first, trial)}
    drawn = [*panels.input_panels(first), *_outputs(alike)]
    if len(alike) < 2 or len(drawn) == len(list(panels.input_panels(first))):
        return None
    elsewhere = tuple(label for label in trials if label not in alike)
    data = {"name": name, "t": panels.clock(first.t), "panels": drawn}
    return Overlay(name, tuple(alike), elsewhere, data)


def _is_alike(one: TrialSeries, other: TrialSeries) -> bool:
    """Whether two runs hold the same samples of a trial: clock, and what both compared."""
    if len(one.t) != len(other.t) or not np.allclose(one.t, other.t, rtol=0.0, atol=1e-6):
        return False
    theirs = {output.name: output for output in other.outputs}
    shared = [(each, theirs[each.name]) for each in one.outputs if each.name in theirs]
    return bool(shared) and all(_is_measured_alike(a, b) for a, b in shared)


def _is_measured_alike(one: OutputSeries, other: OutputSeries) -> bool:
    both = one.compared & other.compared
    return bool(both.any()) and np.allclose(one.measured[both], other.measured[both], rtol=1e-6)


def _outputs(trials: Mapping[str, TrialSeries]) -> Iterator[panels.Panel]:
    """A panel for each output that two runs predicted."""
    names = dict.fromkeys(o.name for trial in trials.values() for o in trial.outputs)
    for name in names:
        found = {
            label: output
            for label, trial in trials.items()
            for output in trial.outputs
            if output.name == name
        }
        if len(found) < 2:
            continue
        factor = labels.shown_factor(name)
        first = next(iter(found.values()))
        yield {
            "kind": "overlay",
            "title": labels.meaning(name),
            "symbol": labels.symbol(name),
            "unit": labels.shown_unit(name),
            "measured": panels.encode_floats(first.observed * factor),
            "runs": [
                {"label": label, "data": panels.encode_floats(output.predicted * factor)}
                for label, output in found.items()
            ],
        }
