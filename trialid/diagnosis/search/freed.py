"""Coefficients that the model holds fixed, as candidates: what is there can be wrong too."""

from dataclasses import replace
from functools import partial, update_wrapper

from trialid.diagnosis.search.augment import fixed_coefficients
from trialid.identification.fit import Fit
from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel


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
    parameter = replace(owner.parameters[name], start=value, null=value, scan=())
    return replace(
        owner,
        name=name,
        function=function,
        parameters={name: parameter},
        states={},
        held=value,
    )
