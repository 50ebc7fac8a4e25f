"""Fits and refits as far as their errors go."""

from types import SimpleNamespace

import numpy as np

from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.refit import Refit

BEFORE = (1.0, 1.1, 0.9, 1.0, 1.05, 0.95)
NO_ROUTE = Split("not separable", "no route")


def fit(eps, check=None, converged=True):
    return SimpleNamespace(
        eps_rmsn=eps,
        eps_of_own=eps,
        eps_check=check,
        converged=converged,
        eps_by_output={"r": eps},
        at_bounds={},
        eps_check_by_output={} if check is None else {"r": check},
        problem=SimpleNamespace(weights=np.ones(1), unknowns=(), roll=None),
        theta=np.zeros(0),
        model=SimpleNamespace(displaced_by=lambda effect: ()),
    )


def refit(name, ratio, eps, parameters=1, check=None, wobble=0.0, family=(), stands_for=""):
    """A refit that carries over so far; `wobble` makes its blocks disagree."""
    after = tuple(ratio * x * (1.0 + wobble * (-1) ** i) for i, x in enumerate(BEFORE))
    carried = Carried(BEFORE, after)
    candidate = SimpleNamespace(
        effect=SimpleNamespace(
            name=name,
            parameters={n: SimpleNamespace(unit="1", null=0.0) for n in "abcdef"[:parameters]},
            states={},
            forms=(),
            signals=(),
            bound_by_meaning=False,
            held=None,
            stands_for=stands_for,
        ),
        shown=lambda level: True,
        carried=carried,
        family=(name, *family),
        allowed=True,
        p_value=0.001,
        price=carried.price(parameters),
    )
    return Refit(candidate, fit(eps, check), carried)


def split(noise, total=0.10):
    model = float(np.sqrt(total**2 - noise**2))
    return Split(
        "quiet stretch", "", noise, model, (0.9 * noise, 1.1 * noise), (0.9 * model, model)
    )
