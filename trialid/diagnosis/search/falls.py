"""How much of the squared error goes once effects are in the model and fitted."""

from typing import Protocol

import numpy as np

from trialid.diagnosis.search.carry_over import levels
from trialid.identification.fit import Fit


class Refitted(Protocol):
    """What was fitted with more in the model."""

    @property
    def fit(self) -> Fit:
        """The fit of the larger model."""


def worse_held_out(before: Fit, after: Fit) -> bool:
    """Whether held-out trials, where there are any, become worse or are lost."""
    old, new = before.eps_check, after.eps_check
    if old is None or new is None:
        return False
    return not np.isfinite(new) or new > old


def fall(fit: Fit, refit: Refitted) -> float:
    """Share of the squared error that goes with an effect."""
    return float(1.0 - (refit.fit.eps_rmsn / fit.eps_rmsn) ** 2)


def fall_of_check(fit: Fit, refit: Refitted) -> float:
    """Share of the squared error of held-out trials that goes with an effect; 0 without any."""
    old, new = fit.eps_check, refit.fit.eps_check
    return 0.0 if old is None or new is None else float(1.0 - (new / old) ** 2)


def fall_of_all(fit: Fit, refit: Refitted) -> float:
    """Share of the squared errors, of fitted trials and of those held out, that goes with it."""
    fitted, held = fit.eps_rmsn**2, (fit.eps_check or 0.0) ** 2
    return (fitted * fall(fit, refit) + held * fall_of_check(fit, refit)) / (fitted + held)


def own_fall(fit: Fit, refit: Refitted) -> float:
    """The same with each output held against its own error."""
    weights = levels(fit) * fit.problem.weights**2
    before, after = (np.square(list(f.eps_by_output.values())) for f in (fit, refit.fit))
    return float(1.0 - weights @ after / (weights @ before))
