"""Arguments of calls from a notebook, as what they have to be, or refused in one line."""

import math
from collections.abc import Mapping, Sequence
from numbers import Real
from typing import Any

from trialid.errors import TrialidError
from trialid.ship.effect import Effect
from trialid.workflow.use.what_if import WhatIf


def effect_name(given: Any, call: str) -> str:
    """The name of an effect; TrialidError where it is none, as an effect itself is."""
    if not isinstance(given, str):
        raise TrialidError(
            f"{call}: expected an effect's name, as 'righting_arm_cubic', got {given!r}"
            + ("; save it in a file that the pipeline names" if isinstance(given, Effect) else "")
        )
    return given


def order_words(manoeuvre: Sequence[Any], others: Mapping[str, Any]) -> tuple[str, ...]:
    """A manoeuvre's name and angles as words; none where orders are given on a clock.

    Parameters
    ----------
    others
        Orders on a clock and their period by name, None where not given: they stand alone.

    Raises
    ------
    TrialidError
        One is no word and no number, or there are orders on a clock beside them.
    """
    for word in manoeuvre:
        if isinstance(word, bool) or not isinstance(word, str | Real):
            raise TrialidError(
                f"{word!r} is no part of a manoeuvre; expected its name and angles [deg], as "
                "'zigzag', 20, 20"
            )
    beside = [name for name, given in others.items() if given is not None]
    if manoeuvre and beside:
        raise TrialidError(
            f"{', '.join(beside)}: orders on a clock stand alone, and the manoeuvre "
            f"{manoeuvre[0]!r} is given too; leave out the one or the other"
        )
    return tuple(word if isinstance(word, str) else f"{word:g}" for word in manoeuvre)


def changes_of(what_if: Any, without: Any) -> WhatIf:
    """What is changed of a model; TrialidError where a value is no number, or a list none."""
    values = {} if what_if is None else what_if
    if not isinstance(values, Mapping):
        raise TrialidError(f"what_if: expected numbers by name, as {{'GM': 0.8}}, got {what_if!r}")
    for name, value in values.items():
        if not isinstance(value, Real) or not math.isfinite(value):
            raise TrialidError(f"what_if {name}: expected a finite number, got {value!r}")
    if isinstance(without, str) or not all(isinstance(name, str) for name in without):
        raise TrialidError(f"without: expected a list of effects' names, got {without!r}")
    return WhatIf(dict(values), tuple(without))


def count_of(given: Any, name: str, least: int) -> int:
    """A whole number, at least so large; TrialidError where it is none."""
    whole = hasattr(given, "__index__") and not isinstance(given, bool)  # of NumPy's, too
    if not whole or int(given) < least:
        raise TrialidError(f"{name}={given!r}: expected a whole number, at least {least}")
    return int(given)
