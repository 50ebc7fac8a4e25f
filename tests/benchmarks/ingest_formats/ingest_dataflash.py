"""Dataflash logs read in columns, beside pymavlink's `recv_match` in the same process.

python tests/benchmarks/ingest.py --only dataflash
"""

import contextlib
import io
import tempfile
from pathlib import Path

import numpy as np
import write_dataflash as w
from ingest_timing import Row, SizedLogs, fastest

from trialid.ingest.mavlink import dataflash_log

RATES = {"IMU": (w.IMU, 200), "ATT": (w.ATT, 50), "AHR2": (w.AHR2, 25), "STER": (w.STER, 50),
         "RCOU": (w.RCOU, 20)}  # fmt: skip
WANTED = ("servo/1:deflection", "IMU/0:GyrZ", "ATT:Roll", "ATT:Yaw")
NUMPY = {"Q": "<u8", "B": "u1", "f": "<f4", "h": "<i2", "H": "<u2", "c": "<i2", "C": "<u2",
         "L": "<i4"}  # fmt: skip
MINUTE = 60_000_000


def minute(seed: int = 0) -> tuple[np.ndarray, np.ndarray, int]:
    """Messages of one minute as bytes, where the time of each lies, and how many they are."""
    random = np.random.default_rng(seed)
    rows, times = [], []
    for message, rate in RATES.values():
        for instance in range(2 if message is w.IMU else 1):
            table = _table(message, rate * 60, instance, random)
            times.append(table["TimeUS"].astype(np.int64))
            rows += list(table.view(np.uint8).reshape(len(table), -1))
    order = np.argsort(np.concatenate(times), kind="stable")
    ordered = [rows[i] for i in order]
    starts = np.cumsum([0, *(len(row) for row in ordered[:-1])])
    return np.concatenate(ordered), starts + 3, len(ordered)


def _table(message: w.Message, count: int, instance: int, random) -> np.ndarray:
    names = message.columns.split(",")
    kinds = [(name, NUMPY[code]) for name, code in zip(names, message.codes, strict=True)]
    table = np.zeros(count, [("head", "V2"), ("type", "u1"), *kinds])
    table["head"], table["type"] = np.void(w.HEAD), message.number
    table["TimeUS"] = np.arange(count) * MINUTE // count + 20 * instance + message.number
    for name, code in zip(names[1:], message.codes[1:], strict=True):
        table[name] = random.normal(size=count) if code == "f" else random.integers(0, 2000, count)
    if message is w.IMU:
        table["I"] = instance
    return table


def make(path: Path, size: int) -> int:
    """A log of about `size` bytes; gives how many messages it holds besides its description."""
    block, places, count = minute()
    opening = w.description() + w.parameters(w.servo())
    clock = block[places[:, None] + np.arange(8)].copy().view("<u8")[:, 0]
    minutes = max(1, round(size / len(block)))
    with path.open("wb") as file:
        file.write(opening)
        for k in range(minutes):
            later = (clock + k * MINUTE).view(np.uint8).reshape(-1, 8)
            block[places[:, None] + np.arange(8)] = later
            file.write(block.tobytes())
    return minutes * count


def library(path: Path, wanted=WANTED) -> None:
    """The same columns by pymavlink."""
    from pymavlink import DFReader

    log = DFReader.DFReader_binary(str(path))
    names = {"RCOU" if one.startswith("servo") else one.split(":")[0].split("/")[0]: one
             for one in wanted} if wanted else None  # fmt: skip
    columns: dict[str, list[float]] = {}
    while (message := log.recv_match(type=list(names) if names else None)) is not None:
        kind = message.get_type()
        for name in message.get_fieldnames():
            columns.setdefault(f"{kind}.{name}", []).append(getattr(message, name))


def measure(scale: float = 1.0) -> list[Row]:
    """Messages of the file a second, read in the channels of a fit and in full."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stderr(io.StringIO()):
        path = Path(folder) / "log"
        count = make(path, round(20_000_000 * scale))
        rows = []
        for what, wanted in (("channels of a fit", WANTED), ("all channels", None)):
            ours = fastest(lambda wanted=wanted: dataflash_log.read(path, wanted))
            theirs = fastest(lambda wanted=wanted: library(path, wanted), 1)
            rows.append((f"dataflash, {what}", count / ours, count / theirs, 10.0))
    return rows


def sized(path: Path, size: float) -> tuple[str, ...]:
    """A log of that size."""
    make(path, round(size))
    return WANTED


SIZED: SizedLogs = {"dataflash": sized}
