"""Revolutions and the depth of the water: read where each trial has them, not always the same."""

import dataclasses
from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.inspection.usual_units import to_si
from trialid.names.quantities import SIGNALS
from trialid.workflow.first_pipeline.choice import plain_signal
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Signal

SHAFTS: Final = (("n",), ("n_p", "n_s"))
SOUGHT: Final = "the run seeks what the screw does"
SHALLOW: Final = "the run seeks what shallow water does"
BELOW: Final = ("keel", "transducer", "below")
"""Words of a depth that is not of the water: it lacks her draught, or part of it."""

CHANGES: Final = 0.05
"""Share of the largest by which they must differ, within a trial or between two. By reason, not by
count: what the screw does goes with their square, so that 5 % are 10 % of the rudder's force in its
race, and a governor holds them closer than that. Twelve trials of a model at 8 to 17 revolutions a
second are read with half and with twice of it, too."""

MOST: Final = (0.05, 0.95)
"""Of the time: a shaft that is started within a trial has stood still before."""


def with_revolutions(trials: Sequence[Chosen]) -> list[Chosen]:
    """The trials with revolutions among their signals, else as they are.

    At revolutions that are always the same nothing shows what the screw does; a trial that has none
    lets nobody ask. A shaft that stands still in one trial may be the other speed of another.
    """
    read = (_with_what_changes(trials, names, SOUGHT) for names in SHAFTS)
    return next(filter(None, read), [*trials])


def with_depth(trials: Sequence[Chosen]) -> list[Chosen]:
    """The trials with the depth of the water among their signals, else as they are.

    Of a barge in 4 and in 200 m it was the trial in deep water that contradicted the others.
    """
    named = [one.key.lower() for trial in trials for one in trial.survey.sources("h")]
    if any(word in name for name in named for word in BELOW):
        return [*trials]
    return _with_what_changes(trials, ("h",), SHALLOW) or [*trials]


def _with_what_changes(
    trials: Sequence[Chosen], names: Sequence[str], why: str
) -> list[Chosen] | None:
    """The trials with these signals; None where one has them not, or they are always the same."""
    found = [_logged(trial, names, why) for trial in trials]
    if not (all(found) and any(map(_changes, zip(*found, strict=True)))):
        return None
    return [_read(*both) for both in zip(trials, found, strict=True)]


def _logged(trial: Chosen, names: Sequence[str], why: str) -> tuple[Signal, ...]:
    """Signals of these names; none where one is not there with its unit, or drives a boat."""
    used = {one.source.key for one in trial.signals}
    live = {
        name: tuple(
            one for one in trial.survey.sources(name) if one.mostly_there and one.key not in used
        )
        for name in names
        if name not in trial.quantities
    }
    found = tuple(plain_signal(name, live, why) for name in names if live.get(name))
    whole = len(found) == len(names) and not any(one.unit == OPEN for one in found)
    return found if whole else ()


def _changes(signal: Sequence[Signal]) -> bool:
    """Whether one shaft's revolutions, or the depth, differ over all trials."""
    parts = [
        np.quantile(one.source.sketch.y, MOST)
        * (to_si(one.unit or "", SIGNALS[one.quantity].unit) or np.nan)
        for one in signal
        if len(one.source.sketch.y)
    ]
    if len(parts) < len(signal):
        return False
    every = np.concatenate(parts)
    return bool(np.ptp(every) > CHANGES * np.max(np.abs(every)))


def _read(trial: Chosen, signals: tuple[Signal, ...]) -> Chosen:
    names = {one.quantity for one in signals}
    beside = tuple(one for one in trial.beside if one[0].quantity not in names)
    return dataclasses.replace(trial, signals=(*trial.signals, *signals), beside=beside)
