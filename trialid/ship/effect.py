"""What a physical effect is: a plain function of named signals and named parameters."""

import inspect
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from importlib import import_module
from pathlib import Path
from pickle import PicklingError
from traceback import extract_tb
from typing import Any, Literal

from trialid.errors import EffectError, nearest
from trialid.maths import Number
from trialid.names.quantities import QUANTITIES
from trialid.ship.effect_checks import (
    check_own,
    check_readings,
    check_scan,
    check_states,
    check_system,
    find_forms,
    typical_parameter,
)
from trialid.ship.forms import (
    FORMS,
    SENSORS,
    Delayed,
    Force,
    Lagged,
    Mass,
    Measured,
    Rate,
    Result,
    Steered,
)
from trialid.ship.parameter import Parameter, Signal
from trialid.ship.shaping import keep_shapes

__all__ = [
    "FORMS",
    "SENSORS",
    "Delayed",
    "Effect",
    "Force",
    "Lagged",
    "Mass",
    "Measured",
    "Parameter",
    "Rate",
    "Result",
    "Signal",
    "Steered",
    "effect",
]

System = Literal["prime", "SI"]


@dataclass(frozen=True)
class Effect:
    """One named physical effect.

    Attributes
    ----------
    signals
        What it reads from the state, the record and the ship's particulars.
    parameters
        What can be identified.
    states
        States it adds, with the signal each starts from (None: from zero).
    forms
        What it returns: any of `FORMS`.
    own
        Signals that are in no dictionary, with their units.
    held
        Value of the coefficient that it frees, one of the model's; None for an effect of its own.
    corrects
        Coefficient of the model that it makes depend on more; without it there is none to correct.
    stands_for
        Motion that it stands for in a model that neither simulates nor records it: every ship has
        that motion, so that no other effect has a name where this one does as well.
    within
        Inputs of which small values show it, and below which share of the largest they have to be:
        a dead band that no order lies in is nothing but another gain.
    """

    name: str
    function: Callable[..., Any] = field(repr=False)
    signals: tuple[str, ...]
    parameters: Mapping[str, Parameter]
    states: Mapping[str, str | None]
    forms: tuple[type, ...]
    system: System
    source: str
    own: Mapping[str, Signal] = field(default_factory=dict)
    held: float | None = None
    corrects: str = ""
    stands_for: str = ""
    within: Mapping[str, float] = field(default_factory=dict)

    def __reduce__(self) -> tuple[Any, ...]:
        """By the effect in its function's module under its name, which hides the function."""
        module, name = self.function.__module__, self.function.__name__
        standing = getattr(sys.modules.get(module), name, None)
        if not isinstance(standing, Effect) or standing.function is not self.function:
            raise PicklingError(f"effect {self.name!r} stands in no module")
        own = {n: x for n, x in vars(self).items() if x is not getattr(standing, n)}
        return _standing, (module, name, own)

    @property
    def equation(self) -> str:
        """The first line of the docstring, which is the equation."""
        return next(iter((self.function.__doc__ or "").strip().splitlines()), self.name)

    @property
    def nulls(self) -> dict[str, float]:
        """Parameter values at which it is absent; what only shapes it stays typical."""
        return {n: p.start if p.null is None else p.null for n, p in self.parameters.items()}

    def of_ship(self, length: float) -> "Effect":
        """The same with typical values for a ship of this length [m]."""
        sized = {n: p.of_ship(length) for n, p in self.parameters.items()}
        return self if sized == self.parameters else replace(self, parameters=sized)

    @property
    def tried(self) -> bool:
        """Whether there are values to try: it may be too strong for its slope at the null."""
        return any(p.scan for p in self.parameters.values())

    @property
    def bound_by_meaning(self) -> bool:
        """Whether a value outside its range says that it is not this effect."""
        return any(p.by_meaning for p in self.parameters.values())

    @property
    def is_whole(self) -> bool:
        """Whether it is there or not, and never in part: reversed, exchanged."""
        return any(p.by_meaning and p.low > (p.null or 0.0) for p in self.parameters.values())

    @property
    def scanned(self) -> bool:
        """Whether it is not linear at its null, or has none, so that values have to be tried."""
        nulls = {p.null for p in self.parameters.values()}
        return self.tried and (Rate in self.forms or nulls == {None})

    def acts_on(self, *forms: type) -> tuple[str, ...]:
        """Names in its results of these forms, as the signals that it delays."""
        values = dict.fromkeys(self.signals, 0.1) | {n: p.start for n, p in self.parameters.items()}
        return tuple(n for p in self(values) if isinstance(p, forms) and p for n in dict(p))

    @property
    def measures(self) -> tuple[str, ...]:
        """Signals whose record it changes: adds to, delays or filters."""
        return self.acts_on(*SENSORS)

    @property
    def of_a_drive(self) -> bool:
        """Whether it says what an actuator of the ship's own makes of what it is given."""
        moved = {*self.acts_on(Steered)}
        return bool(moved) and moved.isdisjoint(QUANTITIES) and moved <= {*self.signals}

    @property
    def place(self) -> str:
        """The effect, its file and the line where it begins, as an error names them."""
        return self._at(self.function.__code__.co_firstlineno)

    def _at(self, line: int) -> str:
        file = Path(self.function.__code__.co_filename).name
        return f"effect {self.name!r} of {file}, line {line}"

    def _line(self, error: BaseException) -> str:
        """The place, with the line of its file that did it."""
        file = self.function.__code__.co_filename
        lines = [f.lineno for f in extract_tb(error.__traceback__) if f.filename == file]
        return self._at(lines[-1] or 0) if lines else self.place

    def __call__(self, values: Mapping[str, Number]) -> tuple[Result, ...]:
        """Evaluate from one mapping of signal and parameter values; always a tuple of forms."""
        wanted = (*self.signals, *self.parameters)
        try:
            result = self.function(**{name: values[name] for name in wanted})
        except TypeError as error:
            hint = "on a signal only + - * / ** abs and trialid.maths (sin, cos, sqrt, ...) work"
            raise EffectError(f"{self._line(error)}: {error}; {hint}") from error
        except EffectError as error:
            raise EffectError(f"{self._line(error)}: {error}") from error
        return (result,) if isinstance(result, FORMS) else tuple(result)


def _standing(module: str, name: str, own: Mapping[str, Any]) -> Effect:
    found: Effect = getattr(import_module(module), name)
    return replace(found, **own) if own else found


def effect(
    source: str,
    system: System = "prime",
    states: Mapping[str, str | None] | None = None,
    *,
    corrects: str = "",
    stands_for: str = "",
) -> Callable[[Callable[..., Any]], Effect]:
    """Turn a function into an `Effect`; its signature is the declaration.

    Positional arguments are signals, one's own written as `tow=Signal("N")`; keyword-only
    arguments are parameters, written as a typical value (a primed coefficient) or as a `Parameter`
    with its unit. In the prime system signals arrive primed (v/U, rL/U) and a Force leaves primed;
    in SI both are SI. A Mass is primed, everything else is SI.

    >>> @effect(source="textbook")
    ... def yaw_damping(r, *, Nr=-0.002):
    ...     "N' = Nr r'."
    ...     return Force(N=Nr * r)
    >>> yaw_damping.signals, yaw_damping.parameters["Nr"].start
    (('r',), -0.002)
    >>> yaw_damping({"r": 0.5, "Nr": -0.002})[0].N
    -0.001

    Raises
    ------
    EffectError
        No docstring, an unknown signal or system, a parameter without a typical value or with a
        range that does not hold it, or a result that is none of the forms.
    """

    def declare(function: Callable[..., Any]) -> Effect:
        name = function.__name__
        if __debug__ and not (function.__doc__ or "").strip():  # python -OO strips them all
            raise EffectError(f"effect {name!r} has no docstring; write its equation there")
        check_system(name, system)
        own = dict(states or {})
        asked = _own_signals(name, function)
        signals, parameters = _signature(name, function, {**own, **asked})
        forms = find_forms(name, function, signals, parameters, own)
        made: System = system if Force in forms or Mass in forms else "SI"
        check_states(name, own, made)
        check_readings(name, signals, forms)
        check_scan(name, parameters)
        check_own(name, asked, made)
        found = Effect(
            name=name,
            function=function,
            signals=signals,
            parameters=parameters,
            states=own,
            forms=forms,
            system=made,
            source=source,
            own=asked,
            corrects=corrects,
            stands_for=stands_for,
        )
        return replace(found, parameters=keep_shapes(found))

    return declare


def _own_signals(name: str, function: Callable[..., Any]) -> dict[str, Signal]:
    """Arguments written as a `Signal`."""
    arguments = inspect.signature(function).parameters.values()
    found = {a.name: a.default for a in arguments if isinstance(a.default, Signal)}
    for known in (n for n in found if n in QUANTITIES):
        raise EffectError(
            f"effect {name!r}: signal {known!r} is a quantity already "
            f"({QUANTITIES[known].meaning}); read it as it is, or choose another name"
        )
    return found


def _signature(
    name: str, function: Callable[..., Any], own: Mapping[str, Any]
) -> tuple[tuple[str, ...], dict[str, Parameter]]:
    arguments = inspect.signature(function).parameters.values()
    signals = tuple(a.name for a in arguments if a.kind is a.POSITIONAL_OR_KEYWORD)
    for signal in signals:
        if signal not in QUANTITIES and signal not in own:
            raise EffectError(
                f"effect {name!r} asks for signal {signal!r}, which is not a quantity "
                f"({nearest(signal, QUANTITIES)}); a parameter goes after the `*` with its "
                f'typical value, a signal of your own is {signal}=Signal("N"), with its unit'
            )
    given = {a.name: a.default for a in arguments if a.kind is a.KEYWORD_ONLY}
    return signals, {n: typical_parameter(name, n, start) for n, start in given.items()}
