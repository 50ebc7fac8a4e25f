"""Trials of a ship of `worlds` as logged, with noise in her sensors and on her hull."""

from collections.abc import Mapping
from typing import Final

import numpy as np
from hidden_truth import DEG, OUTPUTS, SHAFT, Manoeuvre, coloured, generator, gusts
from worlds import World

from trialid.arrays import Mask, Vector
from trialid.simulation.integrate import respond
from trialid.trial import Trial

ORDERS: Final = (
    Manoeuvre("zigzag-20", 20.0, 20.0, 0.5),
    Manoeuvre("zigzag-10", 10.0, 10.0, 2.1),
    Manoeuvre("binary", 15.0, None, -1.0),
    Manoeuvre("zigzag-15", 15.0, 15.0, 1.5, use="check"),
)
"""What is sailed; where there is one trial, the first."""


class NoPassage(RuntimeError):
    """What is hidden takes this ship out of what her model describes."""


def record(world: World, seed: int) -> tuple[Trial, ...]:
    """The trials as logged: two zig-zags and a binary, one more held out; or one zig-zag."""
    length = world.conditions.minutes * 60.0 * world.unit
    told = ORDERS[:1] if world.conditions.single else ORDERS
    return tuple(_trial(world, seed, told_one, length) for told_one in told)


def _trial(world: World, seed: int, told: Manoeuvre, length: float) -> Trial:
    rng = generator(seed, repr(world.conditions), world.hidden, told.name)
    n = round(length * (0.5 if told.use == "check" else 1.0) / world.step) + 1
    forces = _forces(world, n, rng)
    if told.heading is None:
        delta = _ramped(world, _binary(world, rng, n), n)
    else:
        delta = _zigzag(world, told, forces, n)
    y, states = _sailed(world, delta, told.course, forces)
    return Trial(told.name, told.use, world.period, *_logged(world, delta, y, states, rng))


def _forces(world: World, n: int, rng: np.random.Generator) -> dict[str, Vector]:
    forces = dict.fromkeys(("X_ext", "Y_ext", "K_ext", "N_ext"), np.zeros(n))
    if world.conditions.noise == "process":
        p, T, dt = world.known.ship.particulars, world.unit, world.step
        moment = 2e-6 * 0.5 * p["rho"] * p["L"] ** 3 * p["U0"] ** 2
        forces["K_ext"] = moment * coloured(rng, n, 0.55 / T, dt)
        forces["N_ext"] = moment * gusts(rng, n, 40.0 * T, dt)
    return forces


def _sailed(
    world: World, delta: Vector, course: float, forces: Mapping[str, Vector]
) -> tuple[Vector, dict[str, Vector]]:
    speed = world.known.ship.particulars["U0"]
    signals = {"delta": delta, "n": np.full(len(delta), SHAFT / world.unit), **forces}
    start = {"psi": course}
    if "u" in world.known.states:
        start["u"] = speed
    else:
        signals["u"] = np.full(len(delta), speed)
    trial = Trial("true", "fit", world.step, signals, {})
    response = respond(world.true, trial, {}, start, sensitivities=False)
    if response.departure is not None:
        raise NoPassage(f"{world.hidden}: {response.departure}")
    states = dict(zip(world.true.model.all_states, response.states.T, strict=True))
    return response.y, {"u": np.full(len(delta), speed), **states}


def _ramped(world: World, orders: list[tuple[float, float]], n: int) -> Vector:
    """A rudder that follows its orders (time [s], angle [rad]) at 2.5 deg/s of full scale."""
    t, most = np.arange(n) * world.step, 2.5 * DEG / world.unit * world.step
    delta, angle, began = np.zeros(n), 0.0, 0
    for i, (at, order) in enumerate(orders):
        first = int(np.searchsorted(t, at - 1e-9))
        last = int(np.searchsorted(t, orders[i + 1][0] - 1e-9)) if i + 1 < len(orders) else n
        delta[began:first] = angle
        path = np.minimum(most * np.arange(last - first), abs(order - angle))
        delta[first:last] = angle + np.sign(order - angle) * path
        angle, began = (float(delta[last - 1]), last) if last > first else (angle, began)
    return delta


def _binary(world: World, rng: np.random.Generator, n: int) -> list[tuple[float, float]]:
    T, at, orders = world.unit, 60.0 * world.unit, []
    sign = float(rng.choice([-1.0, 1.0]))
    while at < n * world.step:
        orders.append((at, sign * float(rng.choice([5.0, 10.0, 15.0])) * DEG))
        at += world.period * round(rng.uniform(10.0, 60.0) * T / world.period)
        sign = -sign
    return orders


def _zigzag(world: World, told: Manoeuvre, forces: Mapping[str, Vector], n: int) -> Vector:
    """The rudder goes over where the heading has changed by its angle."""
    angle, course = told.angle * DEG, told.course
    T, t = world.unit, np.arange(n) * world.step
    orders, sign = [(60.0 * T, angle)], 1.0
    while True:
        delta = _ramped(world, orders, n)
        _, states = _sailed(world, delta, course, forces)
        turned = states["psi"] - states["psi"][round(60.0 * T / world.step)]
        reached = (sign * turned >= angle) & (t > orders[-1][0] + 2.0 * T)
        if not reached.any():
            return delta
        sign = -sign
        at = np.ceil(t[np.argmax(reached)] / world.period) * world.period
        orders.append((float(at), sign * angle))


def _logged(
    world: World,
    delta: Vector,
    y: Vector,
    states: Mapping[str, Vector],
    rng: np.random.Generator,
) -> tuple[dict[str, Vector], dict[str, Mask]]:
    """What the sensors log, and where it is valid."""
    T, each = world.unit, round(world.period / world.step)
    n = len(y[::each])
    speed = world.known.ship.particulars["U0"]
    signals = {
        "delta": delta[::each].copy(),
        "n": np.full(n, SHAFT / T),
        "u": states["u"][::each] + 0.02 / 7.33 * speed * rng.standard_normal(n),
        "psi": states["psi"][::each] + 0.1 * DEG * rng.standard_normal(n),
    }
    white, wave = (0.05 * DEG / T, 0.1 * DEG), (0.03 * DEG / T, 0.3 * DEG)
    for i, c in enumerate(OUTPUTS):
        sea = wave[i] * coloured(rng, n, 0.6 / T, world.period)
        signals[c] = y[::each, i] + white[i] * rng.standard_normal(n) + sea
    return signals, {c: np.ones(n, dtype=bool) for c in signals}
