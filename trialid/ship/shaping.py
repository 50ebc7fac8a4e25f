"""Parameters that are no coefficient: where what they multiply is absent they do nothing.

`N = x_hook k_tow tow` beside `Y = k_tow tow` is linear in `k_tow`, and the place of the hook only
shapes it: at zero of both it has no slope, by which it could be scored.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, Protocol

import numpy as np

from trialid.errors import EffectError
from trialid.maths import Number
from trialid.ship.forms import Force, Result
from trialid.ship.parameter import Parameter

AT: Final = (0.13, 0.37, 0.61)
"""Values that its signals are given, each another one of them in turn."""


class Made(Protocol):
    """An effect as its function declares it."""

    @property
    def signals(self) -> tuple[str, ...]:
        """What it reads."""

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """What can be identified."""

    def __call__(self, values: Mapping[str, Number]) -> tuple[Result, ...]:
        """What it gives, of values of both."""


def keep_shapes(made: Made) -> dict[str, Parameter]:
    """The parameters of an effect; what only shapes a product has no value where it is absent.

    As they are where a product has nothing else in it: which of two factors shapes the other then
    only who wrote it knows.
    """
    parameters = made.parameters
    ends = {n: p.start if p.null is None else p.null for n, p in parameters.items()}
    moving = [n for n, p in parameters.items() if p.null is not None and not p.scan]
    try:
        with np.errstate(all="ignore"):
            dead = [n for n in moving if not _moves(made, ends, n, parameters[n].start)]
            alive = ends | {n: parameters[n].start for n in moving if n not in dead}
            shapes = [n for n in dead if _moves(made, alive, n, parameters[n].start)]
    except (EffectError, ArithmeticError, ValueError):  # of such signals it is no number
        return dict(parameters)
    return {n: replace(p, null=None) if n in shapes else p for n, p in parameters.items()}


def _moves(made: Made, values: Mapping[str, float], name: str, to: float) -> bool:
    """Whether a parameter that takes another value changes any force."""
    for k in range(len(AT)):
        known = {s: AT[(i + k) % len(AT)] for i, s in enumerate(made.signals)} | dict(values)
        if _forces(made(known)) != _forces(made(known | {name: to})):
            return True
    return False


def _forces(parts: Sequence[Result]) -> tuple[object, ...]:
    return tuple(tuple(p) if isinstance(p, Force) else tuple(p.items()) for p in parts)
