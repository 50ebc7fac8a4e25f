"""What a run says of delays and of the rudder's zero, one number for the voyage.

Each trial has its own. A trim that changed, or a gyro that was replaced, is in all trials of a
voyage, and nowhere else: where they are estimated nothing of the hull takes them up. The zeros of
other sensors go with wind, list and temperature from trial to trial, and are no ship's.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from scipy.stats import norm

from trialid.result.fleet_rows import FittedRow

TRIAL: Final = " ["
"""Begins the name of the trial behind that of a parameter: `tau_r [zz10]`."""
STAYS: Final = ("tau_", "delta_0")
"""Begin the names of what stays from trial to trial."""
NORMAL: Final = float(norm.ppf(0.975))
"""Half of a range that holds 95 %, in standard deviations."""


def each_of_voyage(fitted: Iterable[FittedRow]) -> Iterator[FittedRow]:
    """The ship's own parameters, and of delays and the rudder's zero the mean over the trials.

    That is known as well as noise and the scatter over the trials say.
    """
    trials: dict[tuple[str, str], list[FittedRow]] = {}
    for row in fitted:
        name, of_trial, _ = row.parameter.partition(TRIAL)
        if row.kind == "physical":
            yield row
        elif of_trial and name.startswith(STAYS) and row.value is not None:
            trials.setdefault((row.run, name), []).append(row)
    for (_, name), rows in trials.items():
        yield _mean(name, rows)


def _mean(name: str, rows: Sequence[FittedRow]) -> FittedRow:
    values = np.array([row.value for row in rows], dtype=float)
    errors = np.array([row.standard_error or 0.0 for row in rows])
    apart = np.var(values, ddof=1) if len(values) > 1 else 0.0
    value, wide = values.mean(), NORMAL * np.sqrt((np.mean(errors**2) + apart) / len(values))
    return replace(
        rows[0],
        parameter=name,
        value=float(value),
        standard_error=float(np.sqrt(np.mean(errors**2) / len(values))),
        likely_low=float(value - wide),
        likely_high=float(value + wide),
    )
