"""Dataflash logs of a skid-steered boat: the Otter's motions, her orders as pulse widths.

ArduPilot Rover, SERVO1_FUNCTION 73 and SERVO3_FUNCTION 74, each output with its own MIN, TRIM, MAX
and one of them reversed. What the motors make of a share of full is k s |s| with the Otter's thrust
at full; the log knows the pulse widths only.
"""

import sys
from pathlib import Path
from typing import Final

import numpy as np
import otter

sys.path.append(str(Path(__file__).parents[1] / "ingest"))

import write_dataflash as w

LEFT: Final = {"FUNCTION": 73, "MIN": 1100, "TRIM": 1480, "MAX": 1900, "REVERSED": 0}
RIGHT: Final = {"FUNCTION": 74, "MIN": 1050, "TRIM": 1500, "MAX": 1950, "REVERSED": 1}
PERIOD: Final = 0.1
IMU: Final = (0, 0.0, 0.0)
FIX: Final = (0, 3, 1000, 2200, 9, 1.0, 59.0, 10.5, 0.0)
"""What stands before the yaw rate of a gyro, and before the speed of a receiver."""


def shares(t: np.ndarray, seed: int) -> np.ndarray:
    """Share of full ordered of both motors, more ahead than astern; (N, 2)."""
    rng = np.random.default_rng([seed, 8])
    orders, at = np.full((len(t), 2), 0.4), 4.0
    while at < t[-1]:
        orders[t >= at] = rng.uniform(-0.35, 0.95, 2)
        at += rng.uniform(3.0, 9.0)
    return orders


def revolutions(share: np.ndarray) -> np.ndarray:
    """What the motors make of their share [rad/s]."""
    return np.where(share > 0.0, share * otter.N_MAX, share * -otter.N_MIN)


def write(path: Path, seed: int, *, swapped: bool = False, duration: float = 120.0) -> None:
    """A log; `swapped`: the cables of both motors are exchanged, and the parameters are not."""
    t = np.arange(0.0, duration, PERIOD)
    ordered = shares(t, seed)
    acting = revolutions(ordered)
    sailed = otter.sail(t, acting[:, ::-1] if swapped else acting)
    rng = np.random.default_rng([seed, 3])
    r = sailed.r + 0.003 * rng.standard_normal(len(t))
    speed = np.abs(np.hypot(sailed.u, sailed.v) + 0.02 * rng.standard_normal(len(t)))
    log = w.Log()
    for k, at in enumerate((1e6 * (t + 20.0)).astype(int).tolist()):
        widths = [0] * 14
        for number, servo, share in ((0, LEFT, ordered[k, 0]), (2, RIGHT, ordered[k, 1])):
            ends = [servo[name] for name in ("MIN", "TRIM", "MAX", "REVERSED")]
            widths[number] = w.pwm(float(share), *ends)
        log.add(w.RCOU, at, *widths)
        log.add(w.IMU, at, *IMU, *(float(r[k]), 0.0, 0.0, -9.8))
        if k % 2 == 0:
            log.add(w.GPS, at, *FIX, *(float(speed[k]), 0.0, 0.0, 0.0))
    outputs = {f"SERVO1_{n}": x for n, x in LEFT.items()}
    outputs |= {f"SERVO3_{n}": x for n, x in RIGHT.items()}
    opening = w.description() + w.parameters(outputs) + w.packed(w.MSG, 3, "ArduRover V4.5.7")
    path.write_bytes(opening + w.packed(w.MODE, 3, 0, 0, 1) + log.content())
