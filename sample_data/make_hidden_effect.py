"""Make the shipped sea trials of the hidden-effect sample, with the project's own simulator.

    python sample_data/make_hidden_effect.py

Four 20-minute trials of the ship S175Q with an effect in it that the shipped pipeline's model does
not have. Nothing here is tuned to the pipeline: what the logs hold is the ship, the sea and the
sensors below. Same seeds, same bytes.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter
from write_logs import (
    Imu,
    write_csv,
    write_json_mcap,
    write_keelson_mcap,
    write_ros2_mcap,
)

from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

HERE: Final = Path(__file__).parent
Vector = NDArray[np.float64]
Samples = tuple[NDArray[np.int64], Vector]

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
KNOT: Final = 1852.0 / 3600.0  # m/s
ROLL_DELAY: Final = 0.7  # s, the filter inside the motion sensor
START: Final = 1_780_000_000_000_000_000  # ns, when every recording begins
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


def sampled(
    motion: Vector, rate: float, rng: np.random.Generator, noise: float, bias: float = 0.0,
    late: float = 0.0,
) -> Samples:  # fmt: skip
    """What a sensor logs: its own clock at `rate` [Hz], white noise, a bias, and what is late."""
    t = np.arange(0.0, DURATION + PERIOD / 2, PERIOD)
    phase = rng.uniform(0.0, 1.0 / rate)
    clock = phase + np.arange(0.0, DURATION - phase, 1.0 / rate)
    values = np.interp(clock - late, t, motion) + bias + noise * rng.standard_normal(len(clock))
    return START + np.round(clock * 1e9).astype(np.int64), values


def sensors(x: dict[str, Vector], delta: Vector, seed: int) -> dict[str, Samples]:
    """Everything the trial's sensors log, in SI and in this project's positive directions."""
    rng = np.random.default_rng(1000 + seed)
    deg = np.deg2rad(1.0)
    return {
        "delta": sampled(delta, 5.0, rng, 0.02 * deg),
        "r": sampled(x["r"], 10.0, rng, 0.05 * deg, 0.01 * deg),
        "phi": sampled(x["phi"], 4.0, rng, 0.1 * deg, 0.3 * deg, ROLL_DELAY),
        "u": sampled(x["u"], 1.0, rng, 0.02),
    }


def scaled(samples: Samples, factor: float) -> Samples:
    """The same samples in another unit, rounded as a logger prints them."""
    return samples[0], np.round(samples[1] * factor, 6)


def write_keelson(path: Path, logged: dict[str, Samples]) -> None:
    """The harbour authority's recorder: Keelson names, degrees and knots in the subject."""
    key = "harbour/@v0/s175q/pubsub"
    deg = np.rad2deg(1.0)
    write_keelson_mcap(path, {
        f"{key}/rudder_angle_deg/steering_gear": scaled(logged["delta"], deg),
        f"{key}/yaw_rate_degps/gyro": scaled(logged["r"], deg),
        f"{key}/roll_deg/motion_sensor": scaled(logged["phi"], deg),
        f"{key}/speed_through_water_knots/log": scaled(logged["u"], 1.0 / KNOT),
    })  # fmt: skip


def write_ros(path: Path, logged: dict[str, Samples]) -> None:
    """A research recorder: ROS axes, in which a turn to starboard is a negative yaw rate."""
    t, r = logged["r"]
    phi = np.interp(t, *logged["phi"])
    zero = np.zeros(len(t))
    imu = Imu(t, np.round(phi, 8), zero, zero, zero, zero, -np.round(r, 8))
    floats = {
        "/steering/rudder": scaled(logged["delta"], 1.0),
        "/speed/stw": scaled(logged["u"], 1.0),
    }
    write_ros2_mcap(path, floats, {"/imu": imu})


def write_json(path: Path, logged: dict[str, Samples]) -> None:
    """An in-house logger: JSON messages, rate of turn in deg/min."""
    deg = np.rad2deg(1.0)
    write_json_mcap(path, {
        "/rudder": scaled(logged["delta"], deg),
        "/rate_of_turn": scaled(logged["r"], 60.0 * deg),
        "/heel": scaled(logged["phi"], deg),
        "/stw": scaled(logged["u"], 1.0 / KNOT),
    })  # fmt: skip


def write_table(path: Path, logged: dict[str, Samples]) -> None:
    """A table on one clock at 5 Hz, as a data logger exports it."""
    t = logged["delta"][0]
    deg = np.rad2deg(1.0)
    columns = {
        "rudder[deg]": np.interp(t, *logged["delta"]) * deg,
        "rot[deg/min]": np.interp(t, *logged["r"]) * 60.0 * deg,
        "heel[deg]": np.interp(t, *logged["phi"]) * deg,
        "stw[kn]": np.interp(t, *logged["u"]) / KNOT,
    }
    write_csv(path, (t - START) * 1e-9, {n: np.round(c, 4) for n, c in columns.items()})


WRITERS: Final = {
    "zigzag-10": ("zigzag-10.mcap", write_keelson),
    "zigzag-20": ("zigzag-20.mcap", write_ros),
    "binary-15": ("binary-15.mcap", write_json),
    "zigzag-15": ("zigzag-15.csv", write_table),
}


def main() -> None:
    """Write the four logs."""
    folder = HERE / "hidden_effect"
    folder.mkdir(exist_ok=True)
    model = ship_model()
    for name, (delta, seed) in trials().items():
        motion = run(model, delta, sea(model, seed, len(delta)))
        file, writer = WRITERS[name]
        writer(folder / file, sensors(motion, delta, seed))
        print(f"{file}: {(folder / file).stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
