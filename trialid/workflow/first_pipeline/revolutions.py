"""Revolutions of her screws: read where every trial has them and they are not always the same."""

import dataclasses
from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.inspection.usual_units import to_si
from trialid.workflow.first_pipeline.choice import plain_signal
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Signal

SHAFTS: Final = (("n",), ("n_p", "n_s"))
SOUGHT: Final = "the run seeks what the screw does"

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
    for names in SHAFTS:
        shafts = [_shafts(trial, names) for trial in trials]
        if all(shafts) and any(map(_changes, zip(*shafts, strict=True))):
            return [_read(*both) for both in zip(trials, shafts, strict=True)]
    return list(trials)


def _shafts(trial: Chosen, names: Sequence[str]) -> tuple[Signal, ...]:
    """Signals of all these shafts; none where one is not there with its unit, or drives a boat."""
    used = {one.source.key for one in trial.signals}
    live = {
        name: tuple(
            one for one in trial.survey.sources(name) if one.mostly_there and one.key not in used
        )
        for name in names
        if name not in trial.quantities
    }
    found = tuple(plain_signal(name, live, SOUGHT) for name in names if live.get(name))
    whole = len(found) == len(names) and not any(one.unit == OPEN for one in found)
    return found if whole else ()


def _changes(shaft: Sequence[Signal]) -> bool:
    """Whether one shaft's revolutions differ, over all trials."""
    parts = [
        np.quantile(one.source.sketch.y, MOST) * (to_si(one.unit or "", "rad/s") or np.nan)
        for one in shaft
        if len(one.source.sketch.y)
    ]
    if len(parts) < len(shaft):
        return False
    every = np.concatenate(parts)
    return bool(np.ptp(every) > CHANGES * np.max(np.abs(every)))


def _read(trial: Chosen, shafts: tuple[Signal, ...]) -> Chosen:
    names = {one.quantity for one in shafts}
    beside = tuple(one for one in trial.beside if one[0].quantity not in names)
    return dataclasses.replace(trial, signals=(*trial.signals, *shafts), beside=beside)
