"""What sensors log of a true motion, and the four logs it goes into."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.sample.log_writers import (
    Imu,
    Samples,
    write_csv,
    write_json_mcap,
    write_keelson_mcap,
    write_ros2_mcap,
)
from trialid.sample.rudder_orders import DURATION, clock

Logged = Mapping[str, Samples]
"""Stamps [ns] and values by signal, SI; (N,) each."""

KNOT: Final = 1852.0 / 3600.0
"""m/s."""
START: Final = 1_780_000_000_000_000_000
"""ns, when every recording begins."""


@dataclass(frozen=True)
class Sensor:
    """One sensor: samples a second [Hz], scatter and bias [SI], how late it is [s]."""

    rate: float
    noise: float
    bias: float = 0.0
    late: float = 0.0


_DEG: Final = np.deg2rad(1.0)
SENSORS: Final = (
    ("delta", Sensor(5.0, 0.02 * _DEG)),
    ("r", Sensor(10.0, 0.05 * _DEG, 0.01 * _DEG)),
    ("phi", Sensor(4.0, 0.1 * _DEG, 0.3 * _DEG, late=0.7)),  # the filter inside
    ("u", Sensor(1.0, 0.02)),
)
"""Signals with their sensors, in the order their noise is drawn."""


def sensors(x: Mapping[str, Vector], delta: Vector, seed: int) -> dict[str, Samples]:
    """Everything the trial's sensors log, in SI and in this project's positive directions.

    `x` is the true motion by name and `delta` the true rudder [rad]; (N,) each.
    """
    rng = np.random.default_rng(1000 + seed)
    return {name: _sample({**x, "delta": delta}[name], sensor, rng) for name, sensor in SENSORS}


def _sample(motion: Vector, sensor: Sensor, rng: np.random.Generator) -> Samples:
    """What a sensor logs, on its own clock."""
    phase = rng.uniform(0.0, 1.0 / sensor.rate)
    own = phase + np.arange(0.0, DURATION - phase, 1.0 / sensor.rate)
    noise = sensor.noise * rng.standard_normal(len(own))
    values = np.interp(own - sensor.late, clock(), motion) + sensor.bias + noise
    return START + np.round(own * 1e9).astype(np.int64), values


def _in_unit(samples: Samples, factor: float) -> Samples:
    """The same samples in another unit, rounded as a logger prints them."""
    return samples[0], np.round(samples[1] * factor, 6)


def write_keelson(path: Path, logged: Logged) -> None:
    """The harbour authority's recorder: Keelson names, degrees and knots in the subject."""
    key = "harbour/@v0/s175q/pubsub"
    deg = np.rad2deg(1.0)
    channels = {
        f"{key}/rudder_angle_deg/steering_gear": _in_unit(logged["delta"], deg),
        f"{key}/yaw_rate_degps/gyro": _in_unit(logged["r"], deg),
        f"{key}/roll_deg/motion_sensor": _in_unit(logged["phi"], deg),
        f"{key}/speed_through_water_knots/log": _in_unit(logged["u"], 1.0 / KNOT),
    }
    write_keelson_mcap(path, channels)


def write_ros(path: Path, logged: Logged) -> None:
    """A research recorder: ROS axes, in which a turn to starboard is a negative yaw rate."""
    t, r = logged["r"]
    phi = np.interp(t, *logged["phi"])
    zero = np.zeros(len(t))
    imu = Imu(
        t=t,
        roll=np.round(phi, 8),
        pitch=zero,
        yaw=zero,
        roll_rate=zero,
        pitch_rate=zero,
        yaw_rate=-np.round(r, 8),
    )
    floats = {
        "/steering/rudder": _in_unit(logged["delta"], 1.0),
        "/speed/stw": _in_unit(logged["u"], 1.0),
    }
    write_ros2_mcap(path, floats, {"/imu": imu})


def write_json(path: Path, logged: Logged) -> None:
    """An in-house logger: JSON messages, rate of turn in deg/min."""
    deg = np.rad2deg(1.0)
    channels = {
        "/rudder": _in_unit(logged["delta"], deg),
        "/rate_of_turn": _in_unit(logged["r"], 60.0 * deg),
        "/heel": _in_unit(logged["phi"], deg),
        "/stw": _in_unit(logged["u"], 1.0 / KNOT),
    }
    write_json_mcap(path, channels)


def write_table(path: Path, logged: Logged) -> None:
    """A table on one clock at 5 Hz, as a data logger exports it."""
    t = logged["delta"][0]
    deg = np.rad2deg(1.0)
    columns = {
        "rudder[deg]": np.interp(t, *logged["delta"]) * deg,
        "rot[deg/min]": np.interp(t, *logged["r"]) * 60.0 * deg,
        "heel[deg]": np.interp(t, *logged["phi"]) * deg,
        "stw[kn]": np.interp(t, *logged["u"]) / KNOT,
    }
    rounded = {n: np.asarray(np.round(c, 4), np.float64) for n, c in columns.items()}
    write_csv(path, np.asarray((t - START) * 1e-9, np.float64), rounded)


WRITERS: Final[Mapping[str, tuple[str, Callable[[Path, Logged], None]]]] = {
    "zigzag-10": ("zigzag-10.mcap", write_keelson),
    "zigzag-20": ("zigzag-20.mcap", write_ros),
    "binary-15": ("binary-15.mcap", write_json),
    "zigzag-15": ("zigzag-15.csv", write_table),
}
"""File and writer of each trial's log."""
