"""Coefficients that the model holds fixed, as candidates: what is there can be wrong too."""

from dataclasses import replace
from functools import partial, update_wrapper
from typing import Final

from trialid.diagnosis.search.augment import fixed_coefficients
from trialid.identification.fit import Fit
from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel

FARTHEST: Final = 3.0
"""Deviations of the ship file's by which a coefficient may be held wrong: what lies farther off is
something else, for which this coefficient stands in."""


def candidates_to_free(fit: Fit) -> dict[str, Effect]:
    """Each coefficient that a fitted model holds at a value, as a candidate that frees it.

    Masses are none: the ship was weighed, and what she drags along only scales what she does.
    """
    names = (n for n in fixed_coefficients(fit) if n not in MASS_PARAMETERS)
    return {n: free_coefficient(fit.model, n) for n in names if n in fit.model.parameters}


def free_coefficient(model: ShipModel, name: str) -> Effect:
    """What frees a coefficient of an effect that the model has, from the value it is held at."""
    owner = next(e for e in model.effects if name in e.parameters)
    value = model.value(name)
    others = {n: model.value(n) for n in owner.parameters if n != name}
    function = update_wrapper(partial(owner.function, **others), owner.function)
    function.__doc__ = f"{name} of {owner.name}: {owner.equation}"
    known = owner.parameters[name]
    off = FARTHEST * abs(value) * model.ship.share_off(name)
    parameter = replace(
        known,
        start=value,
        null=value,
        low=max(known.low, value - off),
        high=min(known.high, value + off),
        scan=(),
        by_meaning=True,
    )
    return replace(
        owner,
        name=name,
        function=function,
        parameters={name: parameter},
        states={},
        held=value,
    )
