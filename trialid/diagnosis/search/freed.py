"""Coefficients that the model holds fixed, as candidates: what is there can be wrong too."""

from dataclasses import replace
from functools import partial, update_wrapper

from trialid.diagnosis.search.augment import fixed_coefficients
from trialid.identification.fit import Fit
from trialid.names.quantities import MASS_PARAMETERS
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.ship.parameter import Parameter


def candidates_to_free(fit: Fit) -> dict[str, Effect]:
    """Each coefficient that a fitted model holds at a value, as a candidate that frees it.

    Masses are none: the ship was weighed, and what she drags along only scales what she does.
    """
    names = (n for n in fixed_coefficients(fit) if n not in MASS_PARAMETERS)
    return {n: free_coefficient(fit.model, n) for n in names if n in fit.model.parameters}


def free_coefficient(model: ShipModel, name: str) -> Effect:
    """What frees a coefficient of an effect that the model has, from the value it is held at.

    One of the ship's file keeps its sign, which is the least that a file says: what turns round
    stands in for something else. On a pond in wind that nobody logged `Yv` was named, -0.0205 freed
    to +0.0033, a hull that her drift drives on.
    """
    owner = next(e for e in model.effects if name in e.parameters)
    value = model.value(name)
    others = {n: model.value(n) for n in owner.parameters if n != name}
    function = update_wrapper(partial(owner.function, **others), owner.function)
    function.__doc__ = f"{name} of {owner.name}: {owner.equation}"
    parameter = replace(owner.parameters[name], start=value, null=value, scan=())
    if model.ship.coefficients.get(name):
        parameter = _of_one_sign(parameter)
    return replace(
        owner,
        name=name,
        function=function,
        parameters={name: parameter},
        states={},
        held=value,
    )


def _of_one_sign(parameter: Parameter) -> Parameter:
    """The range on the side of zero where it starts."""
    if parameter.start > 0.0:
        return replace(parameter, low=max(parameter.low, 0.0))
    return replace(parameter, high=min(parameter.high, 0.0))
