"""What is ordered of a boat's drives, in words for whoever drives her."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from trialid.arrays import Vector
from trialid.design.helm import Passage
from trialid.names import labels, units
from trialid.ship.actuators import SHOWN, actuator_quantities

HEADING = "psi"
STEADY = 1e-9
"""Share of the largest order by which one may differ and still be the same."""


@dataclass(frozen=True)
class DriveOrder:
    """One order: when, what of each drive [SI], the heading expected then [rad], in words."""

    t: float
    drives: Mapping[str, float]
    heading: float
    words: str


def orders(passage: Passage) -> list[DriveOrder]:
    """What is held from the start, and every change of it, in time."""
    given = [passage.trial.signals[f"{one.name}_order"] for one in passage.driven]
    both = np.array(given)
    small = STEADY * max(float(np.abs(both).max()), STEADY)
    changes = np.flatnonzero((np.abs(np.diff(both)) > small).any(axis=0)) + 1
    return [_order(passage, int(k)) for k in (0, *changes)]


def _order(passage: Passage, k: int) -> DriveOrder:
    signals = passage.trial.signals
    drives = {one.name: float(signals[f"{one.name}_order"][k]) for one in passage.driven}
    known = actuator_quantities(passage.driven)
    words = ", ".join(f"{n} {labels.command_text(known[n], x)}" for n, x in drives.items())
    return DriveOrder(float(passage.trial.t[k]), drives, float(signals[HEADING][k]), words)


def courses(passage: Passage) -> Iterator[tuple[str, Vector]]:
    """What is ordered of each drive over time, in the unit shown, with a title."""
    for one in passage.driven:
        unit = SHOWN[one.unit]
        values = passage.trial.signals[f"{one.name}_order"] * units.factor(one.unit, unit)
        yield f"order of {one.name} [{'share of full' if unit == '1' else unit}]", values
