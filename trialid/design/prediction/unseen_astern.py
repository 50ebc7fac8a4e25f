"""A shaft or a thruster ordered astern that no trial held astern: what it does there is a range.

Screws are made for ahead. At rest one of the B-series gives 20 to 40 % less astern, a symmetrical
one as much; which side a shaft's race pushes the stern to, nobody knows without a trial.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import reduce
from typing import Final

from trialid.design.helm import Vessel, vessel
from trialid.design.prediction.embrace import embrace
from trialid.design.prediction.likely_spread import Range
from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.effects.actuators.astern_gains import USUAL
from trialid.effects.propulsion import propeller_astern, propeller_astern_advance
from trialid.ship.model import ShipModel

LESS: Final = (0.2, 0.0, 0.4)
"""By how much of its thrust at rest a screw is less astern: what is taken, and either end."""
REMARK: Final = (
    "no trial held the shaft astern: its thrust is taken as 60 to 100 % of that ahead, and to "
    "which side the race would push the stern is not known"
)


def gains_astern(ship: Vessel, untold: Mapping[str, str]) -> tuple[Vessel, ...]:
    """The ship with each thrust astern that hers may have, by the gains ahead; none if told.

    First as it is held, where a screw may have that.
    """
    value = ship.model.value
    known = [
        ship.model.with_values({n: (1.0 - x) * value(a) for n, a in untold.items()}) for x in LESS
    ]
    if all(USUAL[0] * value(a) < value(n) < USUAL[1] * value(a) for n, a in untold.items()):
        known.insert(0, ship.model)
    made = (vessel(one, ship.period, ship.constants, ship.rudder_rate) for one in known)
    return tuple(made) if untold else ()


def screws_astern(ship: Vessel) -> tuple[Vessel, ...]:
    """The ship with each propeller that hers may be astern; none where a trial has told it."""
    model = ship.model
    needed = {"KT0", "D_P"} <= {*model.parameters}
    told = {propeller_astern.name, propeller_astern_advance.name}
    if not needed or told & {e.name for e in model.effects}:
        return ()
    known = model + propeller_astern
    models = [known.with_values(_less(model, less)) for less in LESS]
    return tuple(vessel(m, ship.period, ship.constants, ship.rudder_rate) for m in models)


def _less(model: ShipModel, share: float) -> dict[str, float]:
    """Values of the effect that take off this share of the thrust at rest."""
    blades = model.value("KT0") * (model.value("D_P") / model.ship.particulars["L"]) ** 4
    return {"X_ast": share * 2.0 * blades / (2.0 * math.pi) ** 2, "N_ast": 0.0}


def all_of(made: Sequence[PredictedMotion], unknown: str = "", remark: str = "") -> PredictedMotion:
    """The first of several predictions, with ranges that embrace those of all, `unknown` apart."""
    first = reduce(embrace, made)
    kept = {n: x for n, (x, _) in first.numbers.items() if n != unknown}
    numbers = {n: (x, _embracing([one.numbers for one in made], n)) for n, x in kept.items()}
    return replace(first, numbers=numbers, remark=remark)


def _embracing(
    found: Sequence[Mapping[str, tuple[float, Range | None]]], name: str
) -> Range | None:
    """The range that holds all of a number's; None where one has none, or does not come so far."""
    ends = [one[name][1] if name in one else None for one in found]
    known = [e for e in ends if e is not None]
    if len(known) < len(ends):
        return None
    return min(low for low, _ in known), max(high for _, high in known)
