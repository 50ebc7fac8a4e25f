"""Which gains of thrust astern nothing has told, beside those ahead that a fit has found."""

from collections.abc import Collection, Mapping
from typing import Final

from trialid.arrays import Vector
from trialid.effects.actuators.push_kinds import PUSHES
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship

ASTERN: Final = 0.1
"""Share of the largest push ahead that one astern must reach to tell a gain of its own."""


def held_astern(model: ShipModel, found: Collection[str]) -> dict[str, str]:
    """Gains astern of a model that are not among what was `found`, each with that ahead.

    `k_astern_left` goes with `k_ahead_left`.
    """
    pairs = [kind.gains for kind in PUSHES.values() if len(kind.gains) == 2]
    return {
        name: ahead + name.removeprefix(astern)
        for name in model.parameters
        for ahead, astern in pairs
        if (name == astern or name.startswith(f"{astern}_")) and name not in found
    }


def goes_astern(ship: Ship, signals: Mapping[str, Vector]) -> bool:
    """Whether any of what drives her turns astern, as measured or as ordered."""
    drives = [one.drive for one in ship.actuators if one.drive and one.kind != "tunnel"]
    names = {n for drive in drives for n in (drive, f"{drive}_order")}
    turned = [x for n, x in signals.items() if n in names and len(x)]
    return any(bool(x.min() < -ASTERN * x.max()) for x in turned)
