"""The sample's four sea trials: the ship S175Q with an effect that the shipped pipeline lacks.

Nothing here is tuned to the pipeline: what the logs hold is the ship, the sea and the sensors
below. Same seeds, same bytes.
"""

from pathlib import Path
from typing import Final

import numpy as np
from scipy.signal import lfilter

from trialid.arrays import Vector
from trialid.effects import CATALOGUE
from trialid.sample.rudder_orders import DURATION, PERIOD, multi_frequency_binary, zigzag
from trialid.sample.sample_sensors import WRITERS, sensors
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

STATES: Final = ("u", "v", "p", "r", "phi", "psi")
TRUTH: Final = (
    "linear_hull",
    "linear_rudder",
    "linear_roll",
    "heel_roll",
    "heel_sway",
    "heel_yaw",
    "roll_rate_yaw",
    "sway_drag_vav",
    "sway_drag_var",
    "yaw_drag_vav",
    "yaw_drag_var",
    "yaw_drag_rar",
    "roll_drag_vav",
    "roll_drag_var",
    "centripetal_added_mass",
    "propeller_thrust",
    "surge_resistance",
    "surge_turning",
    "surge_rudder",
    "rudder_offset",
    "outer_force",
)
"""Effects that the true ship has besides the hidden one."""
HIDDEN: Final = ("righting_arm_cubic", {"GM3": 3.2})
"""What no pipeline is told; GM3 [m] is that of wall sides, BM/2."""
OFFSET: Final = np.deg2rad(0.4)
"""Neutral rudder angle [rad]."""
SHAFT: Final = 70.0 * 2.0 * np.pi / 60.0
"""rad/s."""


def write_logs(folder: Path, ship_file: Path) -> None:
    """Make the four trials with the ship of a file, and write their logs into a folder."""
    model = ship_model(ship_file)
    for name, (delta, seed) in rudders(model).items():
        motion = sail(model, delta, sea(model, seed, len(delta)))
        file, write = WRITERS[name]
        write(folder / file, sensors(motion, delta, seed))


def ship_model(ship_file: Path) -> ShipModel:
    """The true ship: S175Q, its neutral rudder angle, and the hidden effect."""
    name, values = HIDDEN
    effects = tuple(CATALOGUE[n] for n in (*TRUTH, name))
    given = {**values, "delta_0": OFFSET, "scale_ext": 1.0}
    return ShipModel(read_ship(ship_file), STATES, effects, given)


def wave_noise(rng: np.random.Generator, n: int, frequency: float, damping: float) -> Vector:
    """Unit-variance noise with a narrow band at a frequency [rad/s]: first-order waves; (n,)."""
    pole = np.exp((-damping + 1j * np.sqrt(1.0 - damping**2)) * frequency * PERIOD)
    waves = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], rng.standard_normal(n + 5000))
    return np.asarray(waves[5000:] / waves[5000:].std())


def gusts(rng: np.random.Generator, n: int, memory: float) -> Vector:
    """Unit-variance noise that forgets in `memory` [s]; (n,)."""
    keep = np.exp(-PERIOD / memory)
    wind = lfilter([np.sqrt(1.0 - keep**2)], [1.0, -keep], rng.standard_normal(n + 20000))
    return np.asarray(wind[20000:])


def sea(model: ShipModel, seed: int, n: int) -> dict[str, Vector]:
    """Forces of wind and waves on the ship [N, N m]; (n,) each."""
    rng = np.random.default_rng(seed)
    L, rho, U = (model.ship.particulars[k] for k in ("L", "rho", "U0"))
    moment = 0.5 * rho * L**3 * U**2
    zero = np.zeros(n)
    return {
        "X_ext": zero,
        "Y_ext": zero,
        "K_ext": 0.8e-6 * moment * wave_noise(rng, n, 0.62, 0.1),
        "N_ext": 0.8e-6 * moment * gusts(rng, n, 25.0),
    }


def sail(model: ShipModel, delta: Vector, forces: dict[str, Vector]) -> dict[str, Vector]:
    """The true motion under a rudder [rad] and a sea; every state by name, (N,) each."""
    n = len(delta)
    signals = {"delta": delta, "n": np.full(n, SHAFT), "u": np.full(n, 7.33), **forces}
    trial = Trial("truth", "fit", PERIOD, signals, {})
    simulator = prepare(model, (), ("r", "phi"))
    response = respond(simulator, trial, {}, {}, sensitivities=False)
    assert response.departure is None, response.departure
    return dict(zip(model.all_states, response.states.T, strict=True))


def rudders(model: ShipModel) -> dict[str, tuple[Vector, int]]:
    """Rudder record [rad] and seed of each trial."""
    calm = sea(model, 0, round(DURATION / PERIOD) + 1)
    still = {k: 0.0 * f for k, f in calm.items()}

    def heading_of(delta: Vector) -> Vector:
        return sail(model, delta, still)["psi"]

    return {
        "zigzag-10": (zigzag(10.0, 10.0, heading_of), 11),
        "zigzag-20": (zigzag(20.0, 20.0, heading_of), 12),
        "binary-15": (multi_frequency_binary(15.0, 3), 13),
        "zigzag-15": (zigzag(15.0, 10.0, heading_of), 14),
    }
