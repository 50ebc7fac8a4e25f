"""Make the shipped sea trials of the hidden-effect sample, with the project's own simulator.

    python sample_data/make_hidden_effect.py

Four 20-minute trials of the ship S175Q with an effect in it that the shipped pipeline's model does
not have. Nothing here is tuned to the pipeline: what the logs hold is the ship, the sea and the
sensors below. Same seeds, same bytes.
"""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

HERE: Final = Path(__file__).parent
Vector = NDArray[np.float64]

PERIOD: Final = 0.1  # s, of the simulation and of the fastest sensor
DURATION: Final = 1200.0  # s
APPROACH: Final = 150.0  # s with the rudder amidships before each manoeuvre
STATES: Final = ("u", "v", "p", "r", "phi", "psi")
TRUTH: Final = (
    "linear_hull", "linear_rudder", "linear_roll", "heel_roll", "heel_sway", "heel_yaw",
    "roll_rate_yaw", "sway_drag_vav", "sway_drag_var", "yaw_drag_vav", "yaw_drag_var",
    "yaw_drag_rar", "roll_drag_vav", "roll_drag_var", "centripetal_added_mass",
    "propeller_thrust", "surge_resistance", "surge_turning", "surge_rudder", "rudder_offset",
    "outer_force",
)  # fmt: skip
HIDDEN: Final = ("righting_arm_cubic", {"GM3": 3.2})  # wall sides: BM/2
OFFSET: Final = np.deg2rad(0.4)  # neutral rudder angle
SHAFT: Final = 70.0 * 2.0 * np.pi / 60.0  # rad/s
RUDDER_RATE: Final = np.deg2rad(2.5)  # rad/s


def ship_model() -> ShipModel:
    """The true ship: S175Q, its neutral rudder angle, and the hidden effect."""
    ship = read_ship(HERE / "ships" / "s175q.toml")
    name, values = HIDDEN
    effects = tuple(CATALOGUE[n] for n in (*TRUTH, name))
    return ShipModel(ship, STATES, effects, {**values, "delta_0": OFFSET, "scale_ext": 1.0})


def ramped(orders: list[tuple[float, float]], t: Vector) -> Vector:
    """Rudder angle that follows orders (time [s], angle [rad]) at the steering gear's rate."""
    at = np.zeros(len(t))
    angle = 0.0
    ordered = np.zeros(len(t))
    for start, order in orders:
        ordered[t >= start] = order
    for k in range(1, len(t)):
        step = np.clip(ordered[k] - angle, -RUDDER_RATE * PERIOD, RUDDER_RATE * PERIOD)
        angle += step
        at[k] = angle
    return at


def zigzag(angle: float, heading: float, heading_of: Callable[[Vector], Vector]) -> Vector:
    """Rudder of a zig-zag: it reverses where the simulated heading reaches the switch angle.

    One switch after the other is found by simulating what is ordered so far, which closes the loop
    on the heading with an open-loop simulator.
    """
    t = np.arange(0.0, DURATION + PERIOD / 2, PERIOD)
    orders, sign = [(APPROACH, np.deg2rad(angle))], 1.0
    while True:
        psi = heading_of(ramped(orders, t))
        course = psi[int((APPROACH - 5.0) / PERIOD)]
        reached = (sign * (psi - course) >= np.deg2rad(heading)) & (t > orders[-1][0] + 2.0)
        if not reached.any():
            return ramped(orders, t)
        sign = -sign
        orders.append((float(t[np.argmax(reached)]), sign * np.deg2rad(angle)))


def multi_frequency_binary(angle: float, seed: int) -> Vector:
    """Rudder at plus or minus one angle, by the sign of a sum of sines about the roll frequency."""
    t = np.arange(0.0, DURATION + PERIOD / 2, PERIOD)
    rng = np.random.default_rng(seed)
    length = DURATION - APPROACH
    roll_periods = length / 28.8
    shares = np.array([19.0, 33.0, 51.0, 80.0, 117.0]) / 80.0
    lines = np.unique([*np.round(shares * roll_periods), 3.0, 1.0])
    phases = rng.uniform(0.0, 2.0 * np.pi, len(lines))
    # the slow lines are the larger: they turn the ship, the fast ones roll it
    sizes = np.where(lines <= 3.0, 1.6, 0.8)
    clock = np.floor((t - APPROACH) / 2.0) * 2.0  # the helmsman switches on whole two seconds
    waves = sizes[:, None] * np.sin(2 * np.pi * lines[:, None] * clock / length + phases[:, None])
    orders, last = [], 0.0
    for time, sign in zip(t, np.sign(waves.sum(axis=0)), strict=True):
        if time >= APPROACH and sign not in (0.0, last):
            orders.append((float(time), float(sign) * np.deg2rad(angle)))
            last = sign
    return ramped(orders, t)


def coloured(rng: np.random.Generator, n: int, frequency: float, damping: float) -> Vector:
    """Unit-variance noise with a narrow band at a frequency [rad/s]: first-order waves."""
    pole = np.exp((-damping + 1j * np.sqrt(1.0 - damping**2)) * frequency * PERIOD)
    waves = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], rng.standard_normal(n + 5000))
    return np.asarray(waves[5000:] / waves[5000:].std())


def gusts(rng: np.random.Generator, n: int, memory: float) -> Vector:
    """Unit-variance noise that forgets in `memory` seconds."""
    keep = np.exp(-PERIOD / memory)
    wind = lfilter([np.sqrt(1.0 - keep**2)], [1.0, -keep], rng.standard_normal(n + 20000))
    return np.asarray(wind[20000:])


def sea(model: ShipModel, seed: int, n: int) -> dict[str, Vector]:
    """Forces of wind and waves on the ship [N, N m]."""
    rng = np.random.default_rng(seed)
    L, rho, U = (model.ship.particulars[k] for k in ("L", "rho", "U0"))
    moment = 0.5 * rho * L**3 * U**2
    zero = np.zeros(n)
    return {
        "X_ext": zero,
        "Y_ext": zero,
        "K_ext": 0.8e-6 * moment * coloured(rng, n, 0.62, 0.1),
        "N_ext": 0.8e-6 * moment * gusts(rng, n, 25.0),
    }


def run(model: ShipModel, delta: Vector, forces: dict[str, Vector]) -> dict[str, Vector]:
    """The true motion under a rudder and a sea; every state by name."""
    n = len(delta)
    signals = {"delta": delta, "n": np.full(n, SHAFT), "u": np.full(n, 7.33), **forces}
    trial = Trial("truth", "fit", PERIOD, signals, {})
    simulator = prepare(model, (), ("r", "phi"))
    response = respond(simulator, trial, {}, {}, sensitivities=False)
    assert response.departure is None, response.departure
    return dict(zip(model.all_states, response.states.T, strict=True))


def trials() -> dict[str, tuple[Vector, int]]:
    """Rudder record and seed of each trial."""
    model = ship_model()
    calm = sea(model, 0, round(DURATION / PERIOD) + 1)
    still = {k: 0.0 * f for k, f in calm.items()}

    def heading_of(delta: Vector) -> Vector:
        return run(model, delta, still)["psi"]

    return {
        "zigzag-10": (zigzag(10.0, 10.0, heading_of), 11),
        "zigzag-20": (zigzag(20.0, 20.0, heading_of), 12),
        "binary-15": (multi_frequency_binary(15.0, 3), 13),
        "zigzag-15": (zigzag(15.0, 10.0, heading_of), 14),
    }
