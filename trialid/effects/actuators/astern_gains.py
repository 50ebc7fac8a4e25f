"""Which gains of thrust astern nothing has told, beside those ahead that a fit has found."""

from collections.abc import Collection, Iterable, Mapping
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.effects.actuators.push_kinds import PUSHES
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship

ASTERN: Final = 0.1
"""Share of the most that a drive is given ahead, which it must be given astern to tell a gain."""
USUAL: Final = (0.3, 2.0)
"""Shares of the gain ahead that one astern may be held at without a word: half of the least and
twice the most of a propeller's. Of an outsider's boat it was held at nine times."""
SCREWS: Final = ("thruster", "azimuth")
"""Kinds that a screw drives, whose thrust astern goes with that ahead; a jet's with its bucket."""


def held_astern(
    model: ShipModel, found: Collection[str], astern: Collection[str]
) -> dict[str, str]:
    """Gains astern of screws that nothing tells, each with that ahead.

    Not those that were `found`, nor those of drives that went `astern`: `k_astern_left` goes with
    `k_ahead_left` and is told by `left` alone, one that is shared by any of them.
    """
    return {
        name: ahead + name.removeprefix(behind)
        for name in model.parameters
        for ahead, behind in (PUSHES[kind].gains for kind in SCREWS)
        if (name == behind or name.startswith(f"{behind}_"))
        and name not in found
        and not (astern if name == behind else name.removeprefix(f"{behind}_") in astern)
    }


def drives_astern(ship: Ship, records: Iterable[Mapping[str, Vector]]) -> frozenset[str]:
    """Drives that turn astern in any of these records, as measured or as ordered."""
    held = list(records)
    drives = [one.drive for one in ship.actuators if one.drive and one.kind != "tunnel"]
    return frozenset(
        drive
        for drive in drives
        if any(_goes_astern([x[n] for x in held if n in x]) for n in (drive, f"{drive}_order"))
    )


def _goes_astern(given: Collection[Vector]) -> bool:
    """Whether what one drive is given goes below zero by more than its noise at rest."""
    known = [x[np.isfinite(x)] for x in given]
    every = np.concatenate([np.zeros(1), *known])
    return bool(every.min() < -ASTERN * every.max())
