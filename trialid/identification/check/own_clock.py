"""Trials in which an output comes later or sooner than in the others, beside what drives her."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from trialid.accuracy.parameter_table import Accuracy
from trialid.identification.nuisance.priors import time_per_length

if TYPE_CHECKING:
    from trialid.identification.fit import Fit

LEAST: Final = 0.03
"""Share of the time in which she goes her length, as of an output that is early in all trials."""

APART: Final = 3.0
"""Times the delay's standard error and the scatter of the others'. Of 59 runs of an outsider with
three trials and more the two whose rudder was logged 2 s late in one have 7.6, all others 2.5 at
most: half of it tells 23 of these, twice the same two."""

OTHERS: Final = 2
"""Trials beside it: of two nobody knows which is unlike the other."""


def own_clocks(fit: "Fit", accuracy: Accuracy) -> tuple[str, ...]:
    """A line for each trial of which an output's delay is another than in the rest.

    An outsider's rudder, logged 2 s late in one zig-zag of four, was taken up by that, and what was
    said of the fit was that nothing is missing.
    """
    known = {p.name: p.standard_error for p in accuracy.parameters}
    least = LEAST * time_per_length(fit.model, fit.problem.trials)
    names = [t.name for t in fit.problem.trials]
    steered = {"delta", "delta_order"} & {*fit.problem.simulator.equations.inputs}
    driver = "the rudder" if steered else "what drives her"
    return tuple(
        f"in {name} {c} comes {abs(off):.2g} s {'later' if off > 0.0 else 'sooner'} after {driver} "
        f"than in the others: a clock is off there, most likely that of {driver} where more than "
        f"one output does so (a `delay` of {-off:.2g} s more in it), or what the model lacks looks "
        "like it"
        for c in fit.problem.outputs
        for name, off in _apart(fit, c, names, known)
        if abs(off) >= least
    )


def _apart(
    fit: "Fit", output: str, names: list[str], known: dict[str, float]
) -> Iterator[tuple[str, float]]:
    """Trials with a delay of their own, and by how much it is another than the others' [s]."""
    rows = {t: f"tau_{output} [{t}]" for t in names}
    if (
        len(names) <= OTHERS
        or not fit.model.states
        or any(row not in fit.estimates for row in rows.values())
    ):
        return
    for name, row in rows.items():
        others = [fit.value(other) for t, other in rows.items() if t != name]
        off = fit.value(row) - float(np.median(others))
        scatter = math.hypot(known.get(row, math.inf), float(np.std(others, ddof=1)))
        if abs(off) >= APART * scatter:
            yield name, off
