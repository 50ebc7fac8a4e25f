"""Telemetry logs read in columns, beside pymavlink's `recv_match` in the same process.

python tests/benchmarks/ingest.py --only tlog
"""

import tempfile
from pathlib import Path

import numpy as np
import write_tlog as w
from ingest_timing import Row, SizedLogs, fastest
from pymavlink.dialects.v20 import all as dialect

from trialid.ingest.mavlink import tlog_log
from trialid.ingest.mavlink.mavlink_crc import checksums

WANTED = ("servo/1/1/1:deflection", "ATTITUDE/1/1:roll", "ATTITUDE/1/1:yawspeed")
ATTITUDE, SERVO_OUTPUT = 30, 36
TIMED = (ATTITUDE, SERVO_OUTPUT)
"""Messages that begin with a time since boot [ms, us]."""
MINUTE_US = 60_000_000
START = 1_700_000_000_000_000


def make(path: Path, seconds: int) -> int:
    """A log of so long; gives how many messages it holds."""
    autopilot = w.sender()
    random = np.random.default_rng(0)
    log = w.Log()
    for name, value in w.SERVO.items():
        log.add(START, w.parameter(f"SERVO1_{name}", value), autopilot)
    for k in range(seconds * 20):
        boot, at = 60_000 + 50 * k, START + 50_000 * k
        six = random.normal(size=6).astype(float)
        log.add(at, dialect.MAVLink_attitude_message(boot, *six), autopilot)
        log.add(at + 1, dialect.MAVLink_vfr_hud_message(1, 2, k % 360, 3, 4, 5), autopilot)
        log.add(at + 2, w.servo_output(boot * 1000, 1500), autopilot)
        if k % 20 == 0:
            log.add(at + 3, w.heartbeat(), autopilot)
    path.write_bytes(log.content())
    return len(log.rows)


def library(path: Path, wanted=WANTED) -> None:
    """The same columns by pymavlink."""
    from pymavlink import mavutil

    log = mavutil.mavlink_connection(str(path), dialect="all")
    names = ["ATTITUDE", "SERVO_OUTPUT_RAW"] if wanted else None
    columns: dict[str, list[float]] = {}
    while (message := log.recv_match(type=names)) is not None:
        kind = message.get_type()
        for name in message.get_fieldnames():
            columns.setdefault(f"{kind}.{name}", []).append(getattr(message, name))
    log.close()


def measure(scale: float = 1.0) -> list[Row]:
    """Messages of the file a second, read in the channels of a fit and in full."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.tlog"
        count = make(path, round(600 * scale))
        rows = []
        for what, wanted in (("channels of a fit", WANTED), ("all channels", None)):
            ours = fastest(lambda wanted=wanted: tlog_log.read(path, wanted))
            theirs = fastest(lambda wanted=wanted: library(path, wanted), 1)
            rows.append((f"tlog, {what}", count / ours, count / theirs, 3.0))
    return rows


def sized(path: Path, size: float) -> tuple[str, ...]:
    """A log of that size: a minute again and again, its clocks going on, its checksums renewed."""
    make(path, 60)
    block = np.frombuffer(path.read_bytes(), np.uint8).copy()
    starts, ends = _rows(block)
    stamps, crc = starts[:, None] + np.arange(8), ends[:, None] + np.arange(2)
    numbers = block[starts + 15].astype(int)
    extra = np.array([dialect.mavlink_map[one].crc_extra for one in numbers], np.uint8)
    at = starts[np.isin(numbers, TIMED), None] + 18 + np.arange(4)
    step = np.where(block[at[:, 0] - 3] == SERVO_OUTPUT, MINUTE_US, MINUTE_US // 1000)
    received = block[stamps].view(">u8")[:, 0].astype(np.uint64)
    boot = block[at].view("<u4")[:, 0].astype(np.uint64)
    with path.open("wb") as file:
        for k in range(round(size / len(block))):
            later = (received + np.uint64(k * MINUTE_US)).astype(">u8")
            block[stamps] = later.view(np.uint8).reshape(-1, 8)
            clock = (boot + (k * step).astype(np.uint64)).astype("<u4")
            block[at] = clock.view(np.uint8).reshape(-1, 4)
            renewed = checksums(block, starts + 9, ends, extra).astype("<u2")
            block[crc] = renewed.view(np.uint8).reshape(-1, 2)
            file.write(block.tobytes())
    return WANTED


def _rows(block: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where each row begins, with its stamp, and where its checksum does."""
    starts = [0]
    while starts[-1] < len(block):
        starts.append(starts[-1] + 8 + 12 + int(block[starts[-1] + 9]))
    return np.array(starts[:-1]), np.array(starts[1:]) - 2


SIZED: SizedLogs = {"tlog": sized}
