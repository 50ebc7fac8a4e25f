"""Motion a ship model makes, as the simulator and the reader see it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from trialid.errors import EffectError, ShipError
from trialid.maths import Number, arctan, cos, sin, sqrt
from trialid.names.quantities import ACCELERATIONS, MASS_PARAMETERS, POSITION
from trialid.ship.effect import (
    SENSORS,
    Delayed,
    Effect,
    Force,
    Lagged,
    Mass,
    Measured,
    Rate,
    Steered,
)
from trialid.ship.mass_matrix import determinant, solve
from trialid.ship.model import DRIFT, KINEMATICS, STANDSTILL, ShipModel, late, slope
from trialid.ship.prime import mass_scale, prime_parameter, prime_signal
from trialid.ship.rigid_body import ROWS, Balance, rigid_body


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
    rates |= {a: rate for a, rate in _way(model, signals).items() if a in model.states}
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
    recorded |= {f"{a}_dot": rates[a] for a in POSITION if a in rates}
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
    return Readings(measured | _course(measured), delay, lags)


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


def measured_by(
    effect: Effect, recorded: Mapping[str, Number], acting: Mapping[str, Number]
) -> Mapping[str, Number]:
    """What an effect sees: steering gear and sensors the recorded rudder, forces the acting one."""
    return acting if Force in effect.forms else {**recorded, "U": acting["U"]}


def _way(model: ShipModel, signals: Mapping[str, Number]) -> dict[str, Number]:
    """Speed to the north and to the east of a ship in still water; axes stay horizontal."""
    if not {*POSITION} & {*model.states}:
        return {}
    u, v, psi = (signals[s] for s in DRIFT)
    return {"x": u * cos(psi) - v * sin(psi), "y": u * sin(psi) + v * cos(psi)}


def _course(measured: Mapping[str, Number]) -> dict[str, Number]:
    """Speed and course over ground; the course goes on with the heading beyond 180 deg.

    It has no number where she drives straight astern over the ground.
    """
    if not {"x_dot", "y_dot", "psi"} <= {*measured}:
        return {}
    north, east, psi = (measured[n] for n in ("x_dot", "y_dot", "psi"))
    sog = sqrt(north * north + east * east + STANDSTILL**2)
    ahead, aside = north * cos(psi) + east * sin(psi), east * cos(psi) - north * sin(psi)
    return {"sog": sog, "cog": psi + 2.0 * arctan(aside / (sog + ahead))}


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
        minor = determinant(matrix)
        if not (minor > 0.0 and math.isfinite(minor)):
            raise ShipError(
                f"ship {model.ship.name!r}: the mass matrix of {', '.join(part)} is not positive "
                f"(determinant {minor:.3g}); check m, I_xx, I_zz and the added masses"
            )
