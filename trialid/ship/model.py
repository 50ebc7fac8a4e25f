"""A ship model: a ship, the states that are simulated, and the effects that act on it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final

from trialid.errors import EffectError, ShipError, nearest
from trialid.names.quantities import ACCELERATIONS, MASS_PARAMETERS, PARTICULARS, POSITION
from trialid.ship.actuators import actuator_quantities
from trialid.ship.effect import (
    SENSORS,
    Delayed,
    Effect,
    Force,
    Mass,
    Parameter,
    Steered,
)
from trialid.ship.particulars import Ship
from trialid.ship.prime import mass_scale, primed_coefficient
from trialid.ship.rigid_body import ROWS

STATES: Final = ("u", "v", "p", "r", "phi", "psi", "x", "y")
KINEMATICS: Final = {"phi": "p", "psi": "r"}  # horizontal axes: the heading rate is r
DRIFT: Final = ("u", "v", "psi")
"""Motions that carry the ship along, simulated or recorded where her position is simulated."""
NEEDED_MASS: Final = {"u": ("m",), "v": ("m",), "p": ("I_xx",), "r": ("I_zz",)}
WEIGHS: Final = ("m", "I_xx", "I_zz")
ADDED: Final = ("Xudot", "Yvdot", "Kpdot", "Nrdot")
"""Masses that are above zero, and what water adds on the diagonal, which is never a help."""
STANDSTILL: Final = 1e-6
"""[m/s] Added to the speed in squares, so that quadratic terms keep their limit at rest."""


@dataclass(frozen=True)
class ShipModel:
    """What is simulated. `model + effect` and `model - "name"` give a new one.

    An effect that gives a state which another gave takes its place.

    Attributes
    ----------
    states
        Subset of `STATES`; other motions come from the record.
    effects
        Physical effects in the order they were added.
    values
        Parameter values that replace those of the ship file.
    """

    ship: Ship
    states: tuple[str, ...]
    effects: tuple[Effect, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        _check_kinds(self)
        _check_states(self.states)
        _check_unique(self.effects)
        _check_signals(self)
        for name in self.values:
            if name not in self.parameters:
                raise EffectError(
                    f"value for parameter {name!r}, which no effect of the model has "
                    f"({nearest(name, self.parameters)})"
                )

    def __add__(self, effect: Effect) -> "ShipModel":
        if not isinstance(effect, Effect):
            raise EffectError(
                f'{effect!r} is no effect; a function is one by @effect(source="...")'
            )
        if effect.held is not None:  # its coefficient is there
            return self
        model = self
        for name in self.displaced_by(effect):
            model = model - name
        return replace(model, effects=(*model.effects, effect))

    def __sub__(self, name: str) -> "ShipModel":
        if name not in (e.name for e in self.effects):
            known = nearest(name, [e.name for e in self.effects])
            raise EffectError(f"the model has no effect {name!r}; {known}")
        kept = tuple(e for e in self.effects if e.name != name)
        gone = {p for e in self.effects if e.name == name for p in e.parameters}
        values = {n: x for n, x in self.values.items() if n not in gone}
        return replace(self, effects=kept, values=values)

    def displaced_by(self, effect: Effect) -> tuple[str, ...]:
        """Effects whose place another takes."""
        return tuple(e.name for e in self.effects if takes_place(effect, e))

    def lost_to(self, effect: Effect) -> frozenset[str]:
        """Parameters that go where an effect takes another's place."""
        gone = (e for e in self.effects if takes_place(effect, e))
        return frozenset(p for e in gone for p in e.parameters)

    def with_values(self, values: Mapping[str, float]) -> "ShipModel":
        """The same model with other parameter values."""
        return replace(self, values={**self.values, **values})

    @cached_property
    def parameters(self) -> dict[str, Parameter]:
        """Every parameter, of this ship's size: the masses, then those of the effects in order."""
        masses = {n: _mass_parameter(self.ship, n) for n in MASS_PARAMETERS}
        own = {n: p for e in self.effects for n, p in e.parameters.items()}
        length = self.ship.particulars["L"]
        return masses | {n: p.of_ship(length) for n, p in own.items()}

    @cached_property
    def all_states(self) -> tuple[str, ...]:
        """The motions simulated and the states that effects add."""
        return (*self.states, *(s for e in self.effects for s in e.states))

    @cached_property
    def own_units(self) -> dict[str, str]:
        """Units of signals that no dictionary has: of the ship's actuators, of one's own."""
        own = {n: signal.unit for e in self.effects for n, signal in e.own.items()}
        return {n: q.unit for n, q in actuator_quantities(self.ship.actuators).items()} | own

    @cached_property
    def recorded(self) -> tuple[str, ...]:
        """Signals that must come from the record (u is the approach speed when it does not)."""
        wanted = {s for e in self.effects for s in e.signals} | {"u"}
        wanted |= {s for e in self.effects for s in e.acts_on(Steered)}
        wanted |= {"r"} if "psi" in self.states else set()
        wanted |= {*DRIFT} if {*POSITION} & {*self.states} else set()
        wanted |= {n for s in self.late_inputs for n in (s, late(s), slope(s))}
        known = {*self.all_states, *PARTICULARS, *ACCELERATIONS, "U"}
        return tuple(sorted(wanted - known))

    @cached_property
    def late_inputs(self) -> tuple[str, ...]:
        """Inputs that act later than they are recorded."""
        delayed = {s for e in self.effects for s in e.acts_on(Delayed)}
        return tuple(sorted(delayed - {*STATES, *self.all_states}))

    def value(self, name: str) -> float:
        """A parameter's value in the prime system or its unit: stated, the ship's, or typical.

        Raises
        ------
        EffectError
            Neither the pipeline nor the ship file gives it.
        """
        found = self.stated(name)
        if found is None and not self._acts(name):
            return 0.0
        if found is None:
            raise EffectError(
                f"parameter {name!r} has no value: ship {self.ship.name!r} gives none; "
                f"free it, or write [model.values] {name} = ..."
            )
        return found

    def _acts(self, name: str) -> bool:
        """Whether a parameter reaches anything that is simulated: Kv does not where roll is not."""
        effect = next(e for e in self.effects if name in e.parameters)
        if effect.forms != (Force,):
            return True
        typical = {n: p.start for n, p in effect.parameters.items()}
        values = dict.fromkeys(effect.signals, 0.1) | typical
        [whole], [half] = (effect({**values, name: x * typical[name]}) for x in (1.0, 0.5))
        rows = {ROWS[s] for s in self.states if s in ROWS}
        moved = {row for row, a, b in zip(Force._fields, whole, half, strict=True) if a != b}
        return bool(rows & moved) or not moved

    def stated(self, name: str) -> float | None:
        """A parameter's value if the pipeline or the ship file gives one."""
        if name in self.values:
            return self.values[name]
        if name in MASS_PARAMETERS:
            return _primed_mass(self.ship, name)
        for effect in self.effects:
            if name in effect.parameters and name in self.ship.coefficients:
                return primed_coefficient(self.ship, effect, name)
        return None


def _primed_mass(ship: Ship, name: str) -> float:
    value = ship.mass.get(name, 0.0)
    if ship.system == "prime":
        return value
    return value / mass_scale(name, ship.particulars["L"], ship.particulars["rho"])


def _mass_parameter(ship: Ship, name: str) -> Parameter:
    """A mass of the ship, above zero where it is one, and where water adds to one below.

    As far as its file has it so: what is stated beyond is left to whoever stated it.
    """
    value = _primed_mass(ship, name)
    low = 0.0 if name in WEIGHS and value > 0.0 else -math.inf
    high = 0.0 if name in ADDED and value < 0.0 else math.inf
    return Parameter(value, low=low, high=high)


def takes_place(effect: Effect, other: Effect) -> bool:
    """Whether both give one state: it has one equation, and a rudder one gear."""
    return other.name != effect.name and bool({*effect.states} & {*other.states})


def _check_kinds(model: ShipModel) -> None:
    """Refuse names in the place of what they name."""
    if not isinstance(model.ship, Ship):
        raise ShipError(f"ShipModel: expected a ship, as ti.read_ship gives, got {model.ship!r}")
    if isinstance(model.states, str):
        raise EffectError(f"ShipModel: expected a list of states, got {model.states!r}")
    for effect in model.effects:
        if not isinstance(effect, Effect):
            raise EffectError(
                f"ShipModel: expected effects, got {effect!r}; of the catalogue they are "
                "ti.CATALOGUE[name]"
            )


def _check_states(states: tuple[str, ...]) -> None:
    for state in states:
        if state not in STATES:
            raise EffectError(f"state {state!r} cannot be simulated; {nearest(state, STATES)}")
    for angle, rate in KINEMATICS.items():
        if angle in states and rate not in states and angle != "psi":
            raise EffectError(f"state {angle!r} needs state {rate!r} beside it")


def _check_unique(effects: tuple[Effect, ...]) -> None:
    seen: dict[str, str] = dict.fromkeys(MASS_PARAMETERS, "the rigid body")
    names: set[str] = set()
    for effect in effects:
        if effect.name in names:
            raise EffectError(f"effect {effect.name!r} is in the model twice")
        names.add(effect.name)
        for parameter in (*effect.parameters, *effect.states):
            if parameter in seen:
                raise EffectError(
                    f"effect {effect.name!r} and {seen[parameter]} both have {parameter!r}; "
                    "rename one"
                )
            seen[parameter] = f"effect {effect.name!r}"


def _check_signals(model: ShipModel) -> None:
    for state in model.states:
        for name in NEEDED_MASS.get(state, ()):
            if _primed_mass(model.ship, name) <= 0.0 and name not in model.values:
                raise ShipError(
                    f"ship {model.ship.name!r}: [mass] {name} is missing or not positive; "
                    f"state {state!r} needs it"
                )
    for effect in model.effects:
        for name in effect.signals:
            if name in PARTICULARS and name not in model.ship.particulars:
                raise ShipError(
                    f"ship {model.ship.name!r}: [particulars] lacks {name}; effect "
                    f"{effect.name!r} needs it"
                )


def needs_ship(effect: Effect) -> bool:
    """Whether an effect pushes a ship, adds to her mass or reads her particulars."""
    return bool({Force, Mass} & set(effect.forms) or set(effect.signals) & set(PARTICULARS))


def late(signal: str) -> str:
    """The input that holds by how much a late input was shifted [s]."""
    return f"{signal} late"


def slope(signal: str) -> str:
    """The input that holds the derivative of a late input by its delay [unit/s]."""
    return f"{signal} slope"


def moves_her(effect: Effect) -> bool:
    """Whether an effect moves a ship, and does not only change what is logged of her.

    An input that acts late does: a record of the rudder that is early is no worse told from a gear
    that is late.
    """
    return bool({*effect.forms} - {*SENSORS}) or bool({*effect.acts_on(Delayed)} - {*STATES})


def without_sensors(model: ShipModel) -> ShipModel:
    """The model of what she does, whatever her sensors make of it."""
    for effect in (e for e in model.effects if not moves_her(e)):
        model = model - effect.name
    return model
