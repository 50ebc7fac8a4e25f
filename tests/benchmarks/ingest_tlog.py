"""Telemetry logs read in columns, beside pymavlink's `recv_match` in the same process.

`python tests/benchmarks/ingest_tlog.py` prints a table.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "ingest"))
import write_tlog as w
from pymavlink.dialects.v20 import all as dialect

from trialid.ingest import tlog_log

Row = tuple[str, float, float, float]
"""What, messages a second of ours and of the library, ratio that is asked."""

WANTED = ("servo/1/1/1:deflection", "ATTITUDE/1/1:roll", "ATTITUDE/1/1:yawspeed")
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


def ours(path: Path, wanted=WANTED) -> float:
    """Seconds for a reading."""
    start = time.perf_counter()
    tlog_log.read(path, wanted)
    return time.perf_counter() - start


def library(path: Path, wanted=WANTED) -> float:
    """Seconds for the same columns by pymavlink."""
    from pymavlink import mavutil

    start = time.perf_counter()
    log = mavutil.mavlink_connection(str(path), dialect="all")
    names = ["ATTITUDE", "SERVO_OUTPUT_RAW"] if wanted else None
    columns: dict[str, list[float]] = {}
    while (message := log.recv_match(type=names)) is not None:
        kind = message.get_type()
        for name in message.get_fieldnames():
            columns.setdefault(f"{kind}.{name}", []).append(getattr(message, name))
    log.close()
    return time.perf_counter() - start


def measure(scale: float = 1.0) -> list[Row]:
    """Messages of the file a second, read in the channels of a fit and in full."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.tlog"
        count = make(path, round(600 * scale))
        ours(path)
        rows = []
        for what, wanted in (("channels of a fit", WANTED), ("all channels", None)):
            fast = min(ours(path, wanted) for _ in range(3))
            rows.append((f"tlog, {what}", count / fast, count / library(path, wanted), 3.0))
    return rows


def main() -> None:
    """Print the table."""
    for what, fast, slow, ratio in measure():
        print(f"{what:32} {fast:12,.0f} {slow:12,.0f} messages/s  {fast / slow:6.1f} (>= {ratio})")


if __name__ == "__main__":
    main()
