"""Motion a ship model makes, as the simulator and the reader see it."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from trialid.errors import ShipError
from trialid.maths import Number, cos, sin
from trialid.names.quantities import MASS_PARAMETERS, POSITION
from trialid.ship.effect import (
    Effect,
    Force,
    Mass,
    Rate,
)
from trialid.ship.mass_matrix import determinant, solve
from trialid.ship.model import DRIFT, KINEMATICS, ShipModel
from trialid.ship.prime import mass_scale
from trialid.ship.rigid_body import ROWS, Balance, rigid_body
from trialid.ship.signals_now import inputs_now, measured_by, signals_now, through_gear, values_for


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
    signals = acting_signals(model, states, inputs, theta)
    force, rates = Force(), dict[str, Number]()
    for _, part in effect_parts(model, states, inputs, theta):
        if isinstance(part, Force):
            force = _add(force, part)
        else:
            rates |= dict(part)
    rates |= {a: signals[b] for a, b in KINEMATICS.items() if a in model.states}
    rates |= {a: rate for a, rate in _way(model, signals).items() if a in model.states}
    return Motion(_balance(model, signals, force, theta), rates)


def acting_signals(
    model: ShipModel,
    states: Mapping[str, Number],
    inputs: Mapping[str, Number],
    theta: Mapping[str, Number],
) -> dict[str, Number]:
    """States and inputs as they act on the ship, particulars and the speed U; SI."""
    return signals_now(model, {**model.ship.particulars, **inputs, **states}, theta)


def effect_parts(
    model: ShipModel,
    states: Mapping[str, Number],
    inputs: Mapping[str, Number],
    theta: Mapping[str, Number],
) -> Iterator[tuple[Effect, Force | Rate]]:
    """What each effect adds to the motion: forces [SI], rates of its states."""
    recorded: dict[str, Number] = {**model.ship.particulars, **inputs, **states}
    arrived = inputs_now(model, recorded, theta)
    signals = through_gear(model, arrived, theta)
    for effect in model.effects:
        if not {Force, Rate} & set(effect.forms):
            continue
        seen = measured_by(effect, arrived, signals)
        for part in effect(values_for(model, effect, seen, theta)):
            if isinstance(part, Force):
                yield effect, _to_SI(model, effect, part, signals)
            elif isinstance(part, Rate):
                yield effect, part


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


def _way(model: ShipModel, signals: Mapping[str, Number]) -> dict[str, Number]:
    """Speed to the north and to the east of a ship in still water; axes stay horizontal."""
    if not {*POSITION} & {*model.states}:
        return {}
    u, v, psi = (signals[s] for s in DRIFT)
    return {"x": u * cos(psi) - v * sin(psi), "y": u * sin(psi) + v * cos(psi)}


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
    mass = {n: x * mass_scale(n, L, rho) for n, x in masses_of(model, theta).items()}
    moves = {s: signals.get(s, 0.0) for s in ("u", "v", "p", "r", "phi")}
    full = rigid_body(moves, force, mass)
    rows = [s for s in ROWS if s in model.states]
    return Balance(
        {(a, b): x for (a, b), x in full.mass.items() if a in rows and b in rows},
        {a: full.force[a] for a in rows},
    )


def masses_of(model: ShipModel, theta: Mapping[str, Number]) -> dict[str, Number]:
    """The mass parameters by name with what effects add to them, primed; `theta` holds all."""
    masses = {n: theta[n] for n in MASS_PARAMETERS}
    particulars = {**model.ship.particulars, "U": model.ship.particulars["U0"]}
    for effect in model.effects:
        if Mass in effect.forms:
            for part in effect(values_for(model, effect, particulars, theta)):
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
