"""The functions an effect may call, on floats, arrays and the engine's graph nodes alike.

A value that brings its own method of the same name (a graph node, a dual number) is asked first;
everything else goes to NumPy. `abs`, `+`, `-`, `*`, `/` and whole powers need no function.
"""

from typing import Any

import numpy as np

Number = Any
"""A float, an array, or whatever the derivative engine passes through."""


def _unary(name: str, meaning: str) -> Any:
    plain = getattr(np, name)

    def function(x: Number) -> Number:
        own = getattr(x, name, None)
        return own() if own is not None else plain(x)

    function.__name__ = name
    function.__doc__ = meaning
    return function


sin = _unary("sin", "Sine of an angle [rad].")
cos = _unary("cos", "Cosine of an angle [rad].")
sqrt = _unary("sqrt", "Square root.")
exp = _unary("exp", "Exponential.")
tanh = _unary("tanh", "Hyperbolic tangent: a smooth sign or saturation.")
arctan = _unary("arctan", "Inverse tangent [rad]; give it a quotient, for example arctan(v / u).")


def clip(x: Number, limit: Number) -> Number:
    """The value of x held between -limit and +limit.

    >>> float(clip(2.0, 0.5)), float(clip(-0.1, 0.5))
    (0.5, -0.1)
    """
    own = getattr(x, "clip_to", None)
    if own is None and hasattr(limit, "clip_to"):  # a number held by a limit that is free
        own = (0.0 * limit + x).clip_to
    return own(limit) if own is not None else np.minimum(np.maximum(x, -limit), limit)
