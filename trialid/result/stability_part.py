"""Directional stability of a fitted ship, as far as the record tells it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import reduce

import numpy as np

from trialid.accuracy.ranges import wider
from trialid.diagnosis.diagnosed import Diagnosed
from trialid.errors import EffectError
from trialid.result.fit_rows import LeversPart, StabilityPart
from trialid.ship.model import ShipModel
from trialid.ship.stability import PARTS, Stability, margin_slopes, stability

PLAIN = (*PARTS, "m", "x_G")
WITH_HEEL = (*PLAIN, "z_G", "Kv", "Kr", "GM")


def stability_part(done: Diagnosed) -> StabilityPart | None:
    """Whether a fitted ship is stable on her course, and with the heel of a slow turn.

    Her margin is likely to lie where whatever may be missing or held wrong leaves it, and where the
    other models say that her parameters' ranges hold: a hull that turns ever harder to turn looks
    stable to a model that is linear.
    """
    plain = _known(done, coupled=False)
    if plain is None:
        return None
    coupled = _known(done, coupled=True)
    heeled = None if coupled is None else _levers(coupled)
    return StabilityPart(**vars(_levers(plain)), roll_coupled=heeled)


def _known(done: Diagnosed, *, coupled: bool) -> Stability | None:
    own = _of_model(done, coupled)
    if own is None:
        return None
    others = [_of_model(one, coupled) for _, one in done.others]
    likely = reduce(wider, [one.likely for one in others if one is not None], own.likely)
    return replace(own, likely=likely)


def _of_model(done: Diagnosed, coupled: bool) -> Stability | None:
    """The margin of one model, with its likely range."""
    values = _coefficients(done.fit.model, coupled)
    if values is None or values["Yv"] == 0.0:
        return None
    accuracy, standing = done.own_accuracy, done.doubts.standing
    names = tuple(p.name for p in accuracy.parameters)
    found = stability(values, names, accuracy.covariance, coupled)
    known = margin_slopes(values, (*names, *done.doubts.held), coupled)
    missing = len(names) + standing.known.moves.shape[1] - 1 - len(known)
    averaged = standing.average(np.array([[*known, *[0.0] * missing]]))
    return replace(found, likely=averaged.range(0, found.margin, found.standard_error or 0.0))


def _coefficients(model: ShipModel, coupled: bool) -> Mapping[str, float] | None:
    """Primed coefficients of the levers; None where the model lacks one of them."""
    turning = [n for n in ("Yurm", "Kurm") if n in model.parameters]
    values = _values(model, (*(WITH_HEEL if coupled else PLAIN), *turning))
    if values is None or not coupled:
        return values
    heel = _heel(model) if model.ship.particulars["U0"] > 0.0 else {"G_phi": 0.0}
    return values | heel if heel["G_phi"] > 0.0 else None  # what does not stand upright has no heel


def _values(model: ShipModel, names: Sequence[str]) -> dict[str, float] | None:
    if any(n not in model.parameters for n in names):
        return None
    try:
        return {n: model.value(n) for n in names}
    except EffectError:
        return None


def _heel(model: ShipModel) -> dict[str, float]:
    """Heel derivatives (zero where no effect has them) and the stiffness G_phi; primed."""
    known = {n: model.value(n) if n in model.parameters else 0.0 for n in ("Yphi", "Nphi", "Kphi")}
    p = model.ship.particulars
    stiffness = 2.0 * p["g"] * p["nabla"] * model.value("GM") / (p["L"] ** 3 * p["U0"] ** 2)
    return {"Yphi": known["Yphi"], "Nphi": known["Nphi"], "G_phi": stiffness - known["Kphi"]}


def _levers(s: Stability) -> LeversPart:
    return LeversPart(
        L_r=s.L_r,
        L_v=s.L_v,
        margin=s.margin,
        standard_error=s.standard_error,
        likely=s.likely,
        stable=None if s.likely is None else s.stable,  # where nobody knows, noise decides nothing
    )
