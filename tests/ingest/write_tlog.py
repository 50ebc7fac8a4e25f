"""Writes telemetry logs with pymavlink's own MAVLink().pack, behind a ground station's stamps."""

import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from pymavlink.dialects.v20 import all as dialect
from write_dataflash import COARSE_SIDE, FULL_DEG, SERVO, of_share
from written import Format, Series, Written

from trialid.alignment import SignalSource

LATENCY_US = 80_000
JITTER_US = 28_000


def sender(system: int = 1, component: int = 1) -> dialect.MAVLink:
    """What packs the messages of one component."""
    return dialect.MAVLink(None, srcSystem=system, srcComponent=component)


@dataclass
class Log:
    """Frames behind their receive stamps [us since 1970]."""

    rows: list[tuple[int, bytes]] = field(default_factory=list)

    def add(self, received: int, message, by: dialect.MAVLink, *, v1: bool = False) -> None:
        frame = bytes(message.pack(by, force_mavlink1=v1))
        by.seq = (by.seq + 1) % 256
        self.rows.append((received, struct.pack(">Q", received) + frame))

    def content(self) -> bytes:
        return b"".join(row for _, row in sorted(self.rows, key=lambda row: row[0]))


def servo_output(time_usec: int, *widths: int, port: int = 0) -> dialect.MAVLink_message:
    """SERVO_OUTPUT_RAW with the first outputs given; its time wraps as in the autopilot."""
    first = [*widths, *[0] * (16 - len(widths))]
    return dialect.MAVLink_servo_output_raw_message(time_usec % 2**32, port, *first)


def heartbeat(mode: int = 0, *, armed: bool = True) -> dialect.MAVLink_message:
    """Of an ArduPilot boat."""
    return dialect.MAVLink_heartbeat_message(11, 3, 65 + 128 * armed, mode, 4, 3)


def parameter(name: str, value: float) -> dialect.MAVLink_message:
    return dialect.MAVLink_param_value_message(name.encode(), value, 9, 100, 0)


def write(path: Path, series: Mapping[str, Series]) -> Written:
    """What an autopilot sends, received late over a jittering link and not in order."""
    start = min(int(t[0]) for t, _ in series.values())
    autopilot, station = sender(), sender(255, 190)
    random = np.random.default_rng(11)
    log = Log()
    first = start // 1000
    for name, value in SERVO.items():
        log.add(first, parameter(f"SERVO1_{name}", value), autopilot)
    log.add(first, heartbeat(), autopilot)
    log.add(first, dialect.MAVLink_heartbeat_message(6, 8, 192, 0, 4, 3), station)
    for name, (t, y) in series.items():
        boot = np.rint((t - start) / 1000).astype(int) + 5_000_000
        received = t // 1000 + LATENCY_US + random.integers(0, JITTER_US, len(t))
        messages = _messages(name, boot.tolist(), y)
        for at, message in zip(received.tolist(), messages, strict=True):
            log.add(at, message, autopilot)
    path.write_bytes(log.content())
    return _written(series)


def _messages(name: str, boot: list[int], y):
    degrees = np.degrees(y)
    if name == "delta":
        widths = of_share(degrees / FULL_DEG)
        return [servo_output(t, one) for t, one in zip(boot, widths, strict=True)]
    if name == "r":
        make = dialect.MAVLink_attitude_quaternion_message
        return [make(_ms(t), 1, 0, 0, 0, 0, 0, one) for t, one in zip(boot, y, strict=True)]
    if name == "phi":
        make = dialect.MAVLink_attitude_message
        return [make(_ms(t), one, 0, 0, 0, 0, 0) for t, one in zip(boot, y, strict=True)]
    if name == "psi":
        make = dialect.MAVLink_global_position_int_message
        hdg = np.rint(degrees * 100).astype(int) % 36000
        rows = zip(boot, hdg.tolist(), strict=True)
        return [make(_ms(t), 0, 0, 0, 0, 0, 0, 0, one) for t, one in rows]
    return [heartbeat()] * len(boot)


def _ms(microseconds: int) -> int:
    return round(microseconds / 1000)


def _written(series: Mapping[str, Series]) -> Written:
    widest = 1.05 * FULL_DEG / COARSE_SIDE  # the autopilot truncates, it does not round
    sources = (
        SignalSource("delta", "servo/1/1/1:deflection", "deg", "starboard", gain=FULL_DEG),
        SignalSource("r", "ATTITUDE_QUATERNION/1/1:yawspeed"),
        SignalSource("phi", "ATTITUDE/1/1:roll"),
        SignalSource("psi", "GLOBAL_POSITION_INT/1/1:hdg"),
    )
    step = np.radians(0.01)
    resolution = {"delta": np.radians(widest), "r": 1e-7, "phi": 1e-7, "psi": step}
    held = tuple(one for one in sources if one.quantity in series)
    return Written(held, {one.quantity: resolution[one.quantity] for one in held}, 1e-3)


FORMATS = (Format("tlog", write),)
