"""What a declared effect must not do: names, numbers and forms that contradict one another."""

import inspect
import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trialid.errors import EffectError, nearest
from trialid.names.quantities import ACCELERATIONS, MASS_PARAMETERS, PARTICULARS, SIGNALS
from trialid.ship.forms import FORMS, SENSORS, Force, Mass, Rate, Result
from trialid.ship.parameter import FROUDE, Parameter

if TYPE_CHECKING:
    from trialid.ship.effect import Signal, System


SIZES: Final = (0.001, 0.1, 1.0, 10.0, 1000.0)
"""Values of all signals at which an effect is tried: it may have no number at some, as at a length
of 0.1 m, but not at all."""


SYSTEMS: Final = ("prime", "SI")


def check_system(name: str, system: str) -> None:
    """Refuse a system of units that is none of the two."""
    if system not in SYSTEMS:
        raise EffectError(
            f"effect {name!r}: system={system!r}; expected {' or '.join(map(repr, SYSTEMS))}"
        )


def typical_parameter(effect: str, name: str, start: Any) -> Parameter:
    """A parameter as the signature has it: a typical value, or a `Parameter` with one."""
    if start is inspect.Parameter.empty:
        raise EffectError(
            f"effect {effect!r}: parameter {name!r} has no typical value; "
            f"write `{name}=...` in the signature"
        )
    made = start if isinstance(start, Parameter) else Parameter(start)
    number = isinstance(made.start, int | float)
    if not number or made.start == 0.0 or not math.isfinite(made.start):
        raise EffectError(
            f"effect {effect!r}: the typical value of parameter {name!r} is {made.start!r}; "
            "it sets the scale of everything relative and must be a number other than 0"
        )
    check_range(effect, name, made)
    return made


def check_range(effect: str, name: str, parameter: Parameter) -> None:
    """Refuse a range that runs backwards, is none, or leaves out the typical value."""
    low, high, start = parameter.low, parameter.high, parameter.start
    if not all(isinstance(end, int | float) for end in (low, high)) or not low < high:
        raise EffectError(
            f"effect {effect!r}: parameter {name!r} may be from low={low!r} to high={high!r}; "
            "expected two numbers, low below high"
        )
    if not low <= start <= high:
        raise EffectError(
            f"effect {effect!r}: the typical value {start!r} of parameter {name!r} is outside its "
            f"range, low={low!r} to high={high!r}; change one of them"
        )
    if parameter.of_length is not None and parameter.unit not in FROUDE:
        raise EffectError(
            f"effect {effect!r}: parameter {name!r} is typical of a ship of {parameter.of_length} "
            f"m, and a value in {parameter.unit!r} is not known to grow with her; expected "
            f"{' or '.join(FROUDE)}, or no of_length"
        )


def check_own(name: str, asked: "Mapping[str, Signal]", system: "System") -> None:
    """Refuse signals of one's own in the prime system, which has no scale for them."""
    if asked and system == "prime":
        raise EffectError(
            f"effect {name!r} reads {min(asked)!r}, a signal of one's own, which has no primed "
            'form; declare the effect with system="SI"'
        )


def check_readings(name: str, signals: tuple[str, ...], forms: tuple[type, ...]) -> None:
    """Accelerations follow from the forces, so only a sensor may read them; masses are constant."""
    early = [s for s in signals if s in ACCELERATIONS]
    if early and not set(forms) <= set(SENSORS):
        raise EffectError(
            f"effect {name!r} reads {early[0]!r}, which follows from the forces; only a sensor "
            "(Measured, Delayed, Lagged) may read an acceleration: write a Mass instead"
        )
    if Mass in forms and (forms != (Mass,) or not set(signals) <= set(PARTICULARS)):
        raise EffectError(
            f"effect {name!r} gives a Mass; masses are constant: let it read no signal and give "
            "nothing else"
        )


def check_scan(name: str, parameters: "Mapping[str, Parameter]") -> None:
    """Where one parameter is scanned the others must shape the effect or be scanned too."""
    if not any(p.scan for p in parameters.values()):
        return
    for parameter, p in parameters.items():
        if not p.scan and p.null is not None:
            raise EffectError(
                f"effect {name!r}: parameter {parameter!r} stands beside a scanned one; give it a "
                "scan too, or null=None"
            )


def check_states(name: str, own: Mapping[str, Any], system: "System") -> None:
    """Refuse states beside primed forces: a state is SI."""
    if own and system == "prime":
        raise EffectError(
            f"effect {name!r} has a force and states of its own; a state is SI, so declare the "
            'effect with system="SI"'
        )


def check_rates(name: str, rates: tuple[str, ...], own: Mapping[str, Any]) -> None:
    """Refuse rates of other states than those declared."""
    if set(rates) != set(own):
        raise EffectError(
            f"effect {name!r} gives the rate of {', '.join(rates) or 'nothing'}, and declares "
            f"the states {', '.join(own) or 'none'}; they must be the same"
        )


def check_numbers(name: str, part: Result) -> None:
    """Refuse a result that is no number."""
    for value in part if isinstance(part, Force) else part.values():
        if not isinstance(value, int | float | np.number):
            raise EffectError(
                f"effect {name!r} returns {value!r} in {type(part).__name__}; expected a number"
            )


def check_names(name: str, part: Result, signals: tuple[str, ...]) -> None:
    """Refuse results for what is no signal and no mass parameter."""
    if isinstance(part, Force):
        return
    mass = isinstance(part, Mass)
    known = {*MASS_PARAMETERS} if mass else {*SIGNALS, *signals}
    for signal in part:
        if signal not in known:
            raise EffectError(
                f"effect {name!r} returns {type(part).__name__}({signal}=...), and {signal!r} is "
                f"not a {'mass parameter' if mass else 'signal'} ({nearest(signal, known)})"
            )


def find_forms(
    name: str,
    function: Callable[..., Any],
    signals: tuple[str, ...],
    parameters: "Mapping[str, Parameter]",
    own: Mapping[str, Any],
) -> tuple[type, ...]:
    """Find out what the function returns by calling it once on small numbers."""
    values = dict.fromkeys(signals, 0.1) | {n: p.start for n, p in parameters.items()}
    try:
        result = function(**values)
    except (ArithmeticError, TypeError, NameError, AttributeError, ValueError) as error:
        raise EffectError(f"effect {name!r} cannot be evaluated: {error}") from error
    names = ", ".join(form.__name__ for form in FORMS)
    results = result if isinstance(result, tuple) and not isinstance(result, Force) else (result,)
    if not results:
        raise EffectError(f"effect {name!r} returns nothing; expected one of {names}")
    for part in results:
        if not isinstance(part, FORMS):
            raise EffectError(
                f"effect {name!r} returns {type(part).__name__}; expected one of {names}"
            )
        check_names(name, part, signals)
        check_numbers(name, part)
    if not any(_finite(function, signals, parameters, size) for size in SIZES):
        raise EffectError(
            f"effect {name!r} returns nan or inf, whatever its signals are; look for a nan, a "
            "division by zero or a root of a negative number"
        )
    check_rates(name, tuple(n for part in results if isinstance(part, Rate) for n in part), own)
    return tuple(type(part) for part in results)


def _finite(
    function: Callable[..., Any],
    signals: tuple[str, ...],
    parameters: "Mapping[str, Parameter]",
    size: float,
) -> bool:
    """Whether all it returns are numbers where every signal has this value."""
    values = dict.fromkeys(signals, size) | {n: p.start for n, p in parameters.items()}
    try:
        with np.errstate(all="ignore"):
            result = function(**values)
    except (ArithmeticError, ValueError):
        return False
    parts = (result,) if isinstance(result, FORMS) else result
    numbers = (x for p in parts for x in (p if isinstance(p, Force) else p.values()))
    return bool(np.all(np.isfinite(list(numbers))))
