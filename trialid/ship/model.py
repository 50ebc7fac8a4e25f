"""A ship model: a ship, the states that are simulated, and the effects that act on it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final

from trialid.errors import EffectError, ShipError, nearest
from trialid.maths import Number, sqrt
from trialid.quantities import ACCELERATIONS, MASS_PARAMETERS, PARTICULARS
from trialid.ship.effect import (
    SENSORS,
    Delayed,
    Effect,
    Force,
    Lagged,
    Mass,
    Measured,
    Parameter,
    Rate,
    Steered,
)
from trialid.ship.particulars import Ship
from trialid.ship.prime import mass_scale, prime_parameter, prime_signal, primed_coefficient
from trialid.ship.rigid_body import ROWS, Balance, rigid_body

STATES: Final = ("u", "v", "p", "r", "phi", "psi")
KINEMATICS: Final = {"phi": "p", "psi": "r"}  # horizontal axes: the heading rate is r
NEEDED_MASS: Final = {"u": ("m",), "v": ("m",), "p": ("I_xx",), "r": ("I_zz",)}
STANDSTILL: Final = 1e-6
"""[m/s] Added to the speed in squares, so that quadratic terms keep their limit at rest."""


@dataclass(frozen=True)
class ShipModel:
    """What is simulated. `model + effect` and `model - "name"` give a new one.

    Attributes
    ----------
    states
        Subset of u, v, p, r, phi, psi; other motions come from the record.
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
        return replace(self, effects=(*self.effects, effect))

    def __sub__(self, name: str) -> "ShipModel":
        if name not in (e.name for e in self.effects):
            known = nearest(name, [e.name for e in self.effects])
            raise EffectError(f"the model has no effect {name!r}; {known}")
        kept = tuple(e for e in self.effects if e.name != name)
        gone = {p for e in self.effects if e.name == name for p in e.parameters}
        values = {n: x for n, x in self.values.items() if n not in gone}
        return replace(self, effects=kept, values=values)

    def with_values(self, values: Mapping[str, float]) -> "ShipModel":
        """The same model with other parameter values."""
        return replace(self, values={**self.values, **values})

    @cached_property
    def parameters(self) -> dict[str, Parameter]:
        """Every parameter: the masses, then those of the effects in order."""
        masses = {n: Parameter(_primed_mass(self.ship, n)) for n in MASS_PARAMETERS}
        return masses | {n: p for e in self.effects for n, p in e.parameters.items()}

    @cached_property
    def all_states(self) -> tuple[str, ...]:
        """The motions simulated and the states that effects add."""
        return (*self.states, *(s for e in self.effects for s in e.states))

    @cached_property
    def recorded(self) -> tuple[str, ...]:
        """Signals that must come from the record (u is the approach speed when it does not)."""
        wanted = {s for e in self.effects for s in e.signals} | {"u"}
        wanted |= {s for e in self.effects for s in e.acts_on(Steered)}
        wanted |= {"r"} if "psi" in self.states else set()
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
        signals = dict.fromkeys(effect.signals, 0.1)
        [there] = effect({**signals, **effect.nulls, name: effect.parameters[name].start})
        [absent] = effect({**signals, **effect.nulls})
        rows = {ROWS[s] for s in self.states if s in ROWS}
        moved = {row for row, a, b in zip(Force._fields, there, absent, strict=True) if a != b}
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


@dataclass(frozen=True)
class Motion:
    """The equations of motion at one instant, on any kind of number.

    Attributes
    ----------
    balance
        Mass matrix and right-hand sides of the simulated force equations.
    rates
        Time derivatives of the other states: kinematics, actuators, sensors.
    """

    balance: Balance
    rates: Mapping[str, Number]


def motion(
    model: ShipModel,
    states: Mapping[str, Number],
    inputs: Mapping[str, Number],
    theta: Mapping[str, Number],
) -> Motion:
    """All equations of motion at one instant.

    Parameters
    ----------
    states, inputs
        Values of `model.all_states` and `model.recorded` [SI].
    theta
        Values of `model.parameters`: primed, or in the parameter's unit.
    """
    recorded: dict[str, Number] = {**model.ship.particulars, **inputs, **states}
    signals = _signals(model, recorded, theta)
    force, rates = Force(), dict[str, Number]()
    for effect in model.effects:
        if not {Force, Rate} & set(effect.forms):
            continue
        seen = measured_by(effect, recorded, signals)
        for part in effect(_values(model, effect, seen, theta)):
            if isinstance(part, Force):
                force = _add(force, _to_SI(model, effect, part, signals))
            elif isinstance(part, Rate):
                rates |= dict(part)
    rates |= {a: signals[b] for a, b in KINEMATICS.items() if a in model.states}
    return Motion(_balance(model, signals, force, theta), rates)


@dataclass(frozen=True)
class Readings:
    """What the sensors make of a motion, on any kind of number.

    Attributes
    ----------
    measured
        Signal to what is recorded of it, before delay and low-pass.
    delay
        Output to its delay [s].
    lags
        Output to the time constants of its sensor's low-passes [s].
    """

    measured: Mapping[str, Number]
    delay: Mapping[str, Number]
    lags: Mapping[str, tuple[Number, ...]]


def readings(
    model: ShipModel,
    states: Mapping[str, Number],
    inputs: Mapping[str, Number],
    theta: Mapping[str, Number],
    rates: Mapping[str, Number],
) -> Readings:
    """What is recorded of one instant; `rates` are the time derivatives of the states."""
    recorded: dict[str, Number] = {**model.ship.particulars, **inputs, **states}
    recorded |= {a: rates.get(a[0], 0.0) for a in ACCELERATIONS}
    signals = _signals(model, recorded, theta)
    measured = {**recorded, "U": signals["U"]} | dict.fromkeys(_from_reference(model), 0.0)
    delay, lags = dict[str, Number](), dict[str, tuple[Number, ...]]()
    for effect in model.effects:
        if not set(SENSORS) & set(effect.forms):
            continue
        seen = measured_by(effect, recorded, signals)
        for part in effect(_values(model, effect, seen, theta)):
            match part:
                case Measured():
                    _check_known(effect, part, measured)
                    measured |= {n: measured[n] + x for n, x in part.items()}
                case Delayed():
                    delay |= {n: delay.get(n, 0.0) + x for n, x in part.items()}
                case Lagged():
                    lags |= {n: (*lags.get(n, ()), x) for n, x in part.items()}
    return Readings(measured, delay, lags)


def measured_by(
    effect: Effect, recorded: Mapping[str, Number], acting: Mapping[str, Number]
) -> Mapping[str, Number]:
    """What an effect sees: steering gear and sensors the recorded rudder, forces the acting one."""
    return acting if Force in effect.forms else {**recorded, "U": acting["U"]}


def _from_reference(model: ShipModel) -> tuple[str, ...]:
    """Signals that a reference sensor gives alone: their record is what is to be explained."""
    return tuple(
        n
        for e in model.effects
        for n in e.acts_on(Measured)
        if f"{n}_ref" in e.signals and n not in model.all_states
    )


def _check_known(effect: Effect, part: Measured, measured: Mapping[str, Number]) -> None:
    """Refuse what is added to a record that nothing gives."""
    for name in part:
        if name not in measured:
            raise EffectError(
                f"{effect.place} adds to the measurement of {name!r}, which the model neither "
                f"simulates nor reads; leave the effect out, or simulate {name!r}"
            )


def _balance(
    model: ShipModel, signals: Mapping[str, Number], force: Force, theta: Mapping[str, Number]
) -> Balance:
    """The rigid-body balance of the simulated rows; a motion that is not simulated keeps still."""
    L, rho = model.ship.particulars["L"], model.ship.particulars["rho"]
    mass = {n: x * mass_scale(n, L, rho) for n, x in _masses(model, theta).items()}
    moves = {s: signals.get(s, 0.0) for s in ("u", "v", "p", "r", "phi")}
    full = rigid_body(moves, force, mass)
    rows = [s for s in ROWS if s in model.states]
    return Balance(
        {(a, b): x for (a, b), x in full.mass.items() if a in rows and b in rows},
        {a: full.force[a] for a in rows},
    )


def _masses(model: ShipModel, theta: Mapping[str, Number]) -> dict[str, Number]:
    """The mass parameters with what effects add to them, primed."""
    masses = {n: theta[n] for n in MASS_PARAMETERS}
    particulars = {**model.ship.particulars, "U": model.ship.particulars["U0"]}
    for effect in model.effects:
        if Mass in effect.forms:
            for part in effect(_values(model, effect, particulars, theta)):
                masses |= {n: masses[n] + x for n, x in dict(part).items()}
    return masses


def _signals(
    model: ShipModel, recorded: Mapping[str, Number], theta: Mapping[str, Number]
) -> dict[str, Number]:
    """States and inputs as they act on the ship, particulars and the speed U; SI."""
    signals = dict(recorded)
    for name, tau in _late_by(model, signals, theta).items():
        # the record comes shifted by the current delay: the value stands, and so does the slope
        signals[name] = signals[name] + (tau - signals[late(name)]) * signals[slope(name)]
    for effect in model.effects:
        if Steered in effect.forms:
            for part in effect({**signals, **theta}):
                if isinstance(part, Steered):
                    signals |= {n: signals[n] + x for n, x in part.items()}
    u, v = signals["u"], signals.get("v", 0.0)
    signals["U"] = sqrt(u * u + v * v + STANDSTILL**2)
    return signals


def _late_by(
    model: ShipModel, signals: Mapping[str, Number], theta: Mapping[str, Number]
) -> dict[str, Number]:
    """By how much each late input is late [s]."""
    total: dict[str, Number] = {}
    for effect in model.effects if model.late_inputs else ():
        if Delayed in effect.forms and set(effect.acts_on(Delayed)) & set(model.late_inputs):
            for part in effect({**signals, **theta}):
                if isinstance(part, Delayed):
                    total |= {n: total.get(n, 0.0) + x for n, x in part.items()}
    return {n: x for n, x in total.items() if n in model.late_inputs}


def _values(
    model: ShipModel, effect: Effect, signals: Mapping[str, Number], theta: Mapping[str, Number]
) -> dict[str, Number]:
    """Signals and parameters in the effect's own system."""
    if effect.system == "SI":
        return {**signals, **theta}
    L, U = model.ship.particulars["L"], signals["U"]
    values = {s: prime_signal(s, signals[s], L, U) for s in effect.signals}
    return values | {n: prime_parameter(effect, n, theta[n], L, U) for n in effect.parameters}


def _to_SI(model: ShipModel, effect: Effect, force: Force, signals: Mapping[str, Number]) -> Force:
    if effect.system == "SI":
        return force
    L, rho, U = model.ship.particulars["L"], model.ship.particulars["rho"], signals["U"]
    pressure = 0.5 * rho * L * L * (U * U)
    return Force(
        force.X * pressure, force.Y * pressure, force.K * pressure * L, force.N * pressure * L
    )


def _add(a: Force, b: Force) -> Force:
    return Force(a.X + b.X, a.Y + b.Y, a.K + b.K, a.N + b.N)


def solve(balance: Balance, rows: tuple[str, ...]) -> dict[tuple[str, str], Number]:
    """Inverse of the mass matrix of the simulated rows, by cofactors (surge stands alone)."""
    inverse: dict[tuple[str, str], Number] = {}
    if "u" in rows:
        inverse["u", "u"] = 1.0 / balance.mass["u", "u"]
    lateral = tuple(s for s in rows if s != "u")
    matrix = [[balance.mass.get((a, b), 0.0) for b in lateral] for a in lateral]
    for i, a in enumerate(lateral):
        for j, b in enumerate(lateral):
            cofactor = _determinant(_minor(matrix, j, i)) * (-1.0) ** (i + j)
            inverse[a, b] = cofactor
    if lateral:
        over = 1.0 / _determinant(matrix)
        inverse |= {k: x * over for k, x in inverse.items() if k != ("u", "u")}
    return inverse


def _minor(matrix: list[list[Number]], row: int, column: int) -> list[list[Number]]:
    return [
        [x for j, x in enumerate(line) if j != column] for i, line in enumerate(matrix) if i != row
    ]


def _determinant(matrix: list[list[Number]]) -> Number:
    if not matrix:
        return 1.0
    total: Number = 0.0
    for j, x in enumerate(matrix[0]):
        total = total + x * _determinant(_minor(matrix, 0, j)) * (-1.0) ** j
    return total


def derivatives(
    model: ShipModel,
    states: Mapping[str, Number],
    inputs: Mapping[str, Number],
    theta: Mapping[str, Number],
) -> dict[str, Number]:
    """Time derivative of every state at one instant, on any kind of number [SI]."""
    now = motion(model, states, inputs, theta)
    rows = tuple(now.balance.force)
    inverse = solve(now.balance, rows)
    rates = dict(now.rates)
    for a in rows:
        total: Number = 0.0
        for b in rows:
            if (a, b) in inverse:
                total = total + inverse[a, b] * now.balance.force[b]
        rates[a] = total
    return {s: rates[s] for s in model.all_states}


def check_mass(model: ShipModel, theta: Mapping[str, float]) -> None:
    """Refuse a mass matrix that is not symmetric-positive enough to invert.

    Raises
    ------
    ShipError
        A leading minor of the (symmetrised) sway-roll-yaw matrix is not positive.
    """
    still = {s: 0.0 for s in ("v", "p", "r", "phi")} | {"u": 1.0}
    nulls = {n: x for e in model.effects for n, x in e.nulls.items()}
    balance = _balance(model, still, Force(), {**nulls, **theta})
    rows = [s for s in ("v", "p", "r") if s in model.states]
    for size in range(1, len(rows) + 1):
        part = rows[:size]
        matrix = [
            [0.5 * (balance.mass.get((a, b), 0.0) + balance.mass.get((b, a), 0.0)) for b in part]
            for a in part
        ]
        minor = _determinant(matrix)
        if not (minor > 0.0 and math.isfinite(minor)):
            raise ShipError(
                f"ship {model.ship.name!r}: the mass matrix of {', '.join(part)} is not positive "
                f"(determinant {minor:.3g}); check m, I_xx, I_zz and the added masses"
            )
