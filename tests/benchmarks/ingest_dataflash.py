"""Dataflash logs read in columns, beside pymavlink's `recv_match` in the same process.

`python tests/benchmarks/ingest_dataflash.py` prints a table; with `--large` a log of 1 GB is made,
looked through by `batches` and read in the channels of a fit, and the peak memory of each printed.
"""

import argparse
import contextlib
import io
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "ingest"))
import write_dataflash as w

from trialid.ingest import dataflash_log

Row = tuple[str, float, float, float]
"""What, messages a second of ours and of the library, ratio that is asked."""

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


def ours(path: Path, wanted=WANTED) -> float:
    """Seconds for a reading."""
    start = time.perf_counter()
    dataflash_log.read(path, wanted)
    return time.perf_counter() - start


def library(path: Path, wanted=WANTED) -> float:
    """Seconds for the same columns by pymavlink."""
    from pymavlink import DFReader

    start = time.perf_counter()
    log = DFReader.DFReader_binary(str(path))
    names = {"RCOU" if one.startswith("servo") else one.split(":")[0].split("/")[0]: one
             for one in wanted} if wanted else None  # fmt: skip
    columns: dict[str, list[float]] = {}
    while (message := log.recv_match(type=list(names) if names else None)) is not None:
        kind = message.get_type()
        for name in message.get_fieldnames():
            columns.setdefault(f"{kind}.{name}", []).append(getattr(message, name))
    return time.perf_counter() - start


def measure(scale: float = 1.0) -> list[Row]:
    """Messages of the file a second, read in the channels of a fit and in full."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stderr(io.StringIO()):
        path = Path(folder) / "log"
        count = make(path, round(20_000_000 * scale))
        ours(path)
        rows = []
        for what, wanted in (("channels of a fit", WANTED), ("all channels", None)):
            fast = min(ours(path, wanted) for _ in range(3))
            rows.append((f"dataflash, {what}", count / fast, count / library(path, wanted), 10.0))
    return rows


LARGE = """
import sys, time
from pathlib import Path
from trialid.ingest import dataflash_log
path, what = Path(sys.argv[1]), sys.argv[2]
start, channels = time.perf_counter(), 0
for wanted in dataflash_log.batches(path) if what == "all" else [what.split(",")]:
    channels += len(dataflash_log.read(path, wanted).channels)
seconds = time.perf_counter() - start
words = Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()
print(f"{channels} channels, {seconds:.1f} s, peak {int(words[0]) / 1e6:.2f} GB")
"""


def large(size: int = 1_000_000_000) -> None:
    """Print time and peak memory of a reading of a large log, each in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log"
        count = make(path, size)
        print(f"{path.stat().st_size / 1e9:.2f} GB, {count / 1e6:.1f} million messages")
        for what in (",".join(WANTED), "all"):
            command = [sys.executable, "-c", LARGE, str(path), what]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            print(f"{what}: {done.stdout.strip()}")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--large", action="store_true")
    if parser.parse_args().large:
        large()
        return
    for what, fast, slow, ratio in measure():
        print(f"{what:32} {fast:12,.0f} {slow:12,.0f} messages/s  {fast / slow:6.1f} (>= {ratio})")


if __name__ == "__main__":
    main()
