"""Trials held out whose rudder's zero, or a sensor's, is another than in the fitted ones."""

from typing import TYPE_CHECKING, Final

import numpy as np

from trialid.identification.trial_score import check_rows
from trialid.names.wording import with_unit

if TYPE_CHECKING:
    from trialid.identification.fit import Fit

OWN: Final = 1.5
"""Times what is left in held-out trials with sensors of their own that they leave with the others',
from which on it is told. Of zig-zags on a pond 1.7; of 64 simulated outputs whose zeros noise alone
moves 1.003 at most, so half as far beyond one tells of none; twice as far not of the pond."""

SEEN: Final = 0.002
"""Error that must go with it, as a share of what moved: nobody notices less."""


def own_sensors(fit: "Fit") -> list[str]:
    """A line for each trial held out of which one zero or delay of its own explains most.

    Whatever the verdict is: of a boat whose rudder stood at 2 deg more in the trial held out it was
    said what may be missing from her model, and not that 20.8 % are left there by that zero.
    """
    units = {x.column: x.unit for x in fit.problem.unknowns}
    said = []
    for score in fit.scores:
        if score.trial.use != "check" or (rows := check_rows(fit, score.trial)) is None:
            continue
        name, (off, left) = min(rows.alone.items(), key=lambda one: one[1][1], default=("", (0, 1)))
        gone, whole = 1.0 - left**2, np.mean(np.square(list(score.eps_rmsn.values())))
        if left * OWN < 1.0 and np.sqrt(gone * whole) >= SEEN:
            said.append(
                f"{score.trial.name}, held out: {name} of its own, {with_unit(off, units[name])} "
                f"from the others', takes {gone:.0%} of its squared error: "
                f"{_where_it_is(fit, name, off, units[name])}"
            )
    return said


def _where_it_is(fit: "Fit", name: str, off: float, unit: str) -> str:
    """Whether it is this trial that is unlike the others, or one of those.

    Of an outsider's three zig-zags the heel stood off in one that was fitted, and the faultless one
    that was held out had the blame.
    """
    found = {t: fit.estimates.get(f"{name} [{t}]") for t in _fitted(fit)}
    others = {t: x for t, x in found.items() if x is not None}
    apart = float(np.ptp([*others.values()])) if others else 0.0
    if apart <= abs(off):
        return (
            "its sensors stood otherwise, something acts there alone, or what the model lacks "
            "looks like it there"
        )
    middle = float(np.median([*others.values(), np.mean([*others.values()]) + off]))
    unlike = max(others, key=lambda t: abs(others[t] - middle))
    return (
        f"the others' are {with_unit(apart, unit)} apart themselves, that of {unlike} furthest "
        "from all the rest: rather there it stood otherwise, or what the model lacks looks like it"
    )


def _fitted(fit: "Fit") -> list[str]:
    return [t.name for t in fit.trials if t.use == "fit"]
