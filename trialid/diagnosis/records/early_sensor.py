"""Whether a sensor is taken to be early: none is, and what the fit makes early the hull did.

A hull that answers sooner than the model lets it, as with a sway of her file that is another, fits
with a gyro ahead of the ship. What is predicted of her is then without that lead, and turns late.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from trialid.errors import TrialidError
from trialid.identification.fit import Fit, identify
from trialid.identification.remarks import in_all_trials
from trialid.threads import one_thread

T = TypeVar("T")


@one_thread
def beside_in_time(fit: Fit, examine: Callable[[Fit], T]) -> tuple[T, ...]:
    """What is found of the same model with its sensors in time, where one is early; else nothing.

    Nothing either where that fit does not arrive.
    """
    if not any(late < 0.0 for late in in_all_trials(fit).values()):
        return ()
    nuisance = tuple(n for n in fit.settings.nuisance if n != "delay")
    settings = replace(fit.settings, nuisance=nuisance)
    try:
        found = identify(fit.trials, fit.model, settings, near=fit.estimates)
    except TrialidError:
        return ()
    return (examine(found),) if found.converged else ()
