"""Which of two numbered drives is to port, where only another log of the boat shows it."""

import dataclasses
from collections.abc import Mapping, Sequence

from trialid.inspection.drives import NUMBERS
from trialid.workflow.first_pipeline.boats.boat_choice import PORT, STARBOARD
from trialid.workflow.first_pipeline.boats.unit_of_drive import unit_of_drive
from trialid.workflow.first_pipeline.by_other_logs import as_in
from trialid.workflow.first_pipeline.chosen import Chosen, Signal

Place = tuple[str, str]
"""The signal of a drive, and the log that shows it."""


def with_ports(trials: Sequence[Chosen]) -> list[Chosen]:
    """The trials, drives placed as the turns of others place those of the same name.

    Where these contradict each other all stay open.
    """
    known = _shown(trials)
    return [dataclasses.replace(one, signals=_placed(one.signals, known)) for one in trials]


def _shown(trials: Sequence[Chosen]) -> Mapping[str, Place]:
    """Where drives are, by their names."""
    found: dict[str, dict[str, str]] = {}
    for one in trials:
        for s in one.signals:
            if s.quantity in (PORT, STARBOARD) and s.of_side.rests_on("measured"):
                found.setdefault(s.source.name, {}).setdefault(s.quantity, one.path.name)
    return {
        name: place
        for name, places in found.items()
        if len(places) == 1
        for place in places.items()
    }


def _placed(signals: tuple[Signal, ...], known: Mapping[str, Place]) -> tuple[Signal, ...]:
    asked = [s for s in signals if _asks(s) and s.source.name in known]
    if len({known[s.source.name][0] for s in asked}) != len(NUMBERS):
        return signals
    told = sorted((_told(s, *known[s.source.name]) for s in asked), key=lambda s: s.quantity)
    return (*told, *(s for s in signals if s not in asked))


def _asks(signal: Signal) -> bool:
    return signal.quantity in (PORT, STARBOARD) and signal.of_side.rests_on("asked", "alike")


def _told(signal: Signal, quantity: str, log: str) -> Signal:
    unit, _ = unit_of_drive(signal.source)
    return dataclasses.replace(signal, quantity=quantity, unit=unit, of_side=as_in(log))
