"""How quickly logs are read: every format beside the plain library, and what large logs cost.

    python tests/benchmarks/ingest.py [--short] [--large] [--only mcap] [--out FILE.md]

Exit status 1 where something is slower than asked: MCAP five times the official ROS 2 decoder,
dataflash ten times pymavlink's recv_match and telemetry logs three times, CAN three times nmea2000;
a log of 100 MB inspected in four seconds of CPU time; with `--large` 1 GB inspected, and read in
the channels of a fit, in less than 1 GB of memory.
"""

import argparse
import importlib
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ingest_timing import Cost

HERE = Path(__file__).parent
FORMATS = HERE / "ingest_formats"
sys.path[:0] = [str(HERE.parent / "ingest"), str(HERE), str(FORMATS)]

SHORT = 0.15
"""Share of the usual size, for CI."""
HUNDRED, LARGE = 100e6, 1e9
SECONDS, MEMORY_MB = 4.0, 1000.0
"""The first of CPU time, which other work on the machine does not lengthen; imports included."""
HUGE = ("MCAP", "dataflash", "CSV", "candump", "NMEA 0183")
"""Formats whose logs get that long."""


def modules(only: str | None) -> Iterator[ModuleType]:
    """The benchmarks of each format."""
    names = sorted(path.stem for path in FORMATS.glob("ingest_*.py"))
    for name in names:
        if name != "ingest_timing" and only in (None, name.removeprefix("ingest_")):
            yield importlib.import_module(name)


def compared(benchmarks: list[ModuleType], scale: float, say: Callable[[str], None]) -> list[str]:
    """The table beside the libraries; what falls short."""
    from ingest_timing import short, speeds

    rows = [row for one in benchmarks for row in one.measure(scale)]
    say(f"Messages, sentences or rows a second.\n\n{speeds(rows)}")
    return short(rows)


def inspected(benchmarks: list[ModuleType], size: float, say: Callable[[str], None]) -> list[str]:
    """The table of `trialid inspect` on logs of 100 MB; what takes too long."""
    from ingest_timing import alone, table

    rows, late = [], []
    for name, write in _sized(benchmarks):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "log"
            write(path, size)
            cost = alone(path, None)
            rows.append(_cells(name, path, cost))
            if cost.cpu > SECONDS:
                late.append(f"{name}: inspected in {cost.cpu:.1f} s of CPU, asked {SECONDS:g} s")
    head = ("inspect", "MB", "channels", "seconds", "CPU s", "peak MB")
    say(f"`trialid inspect`, in a process of its own.\n\n{table(head, rows)}")
    return late


def huge(benchmarks: list[ModuleType], size: float, say: Callable[[str], None]) -> list[str]:
    """The table of logs of 1 GB; what takes too much memory."""
    from ingest_timing import alone, table

    rows, over = [], []
    for name, write in _sized(benchmarks):
        if name not in HUGE:
            continue
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "log"
            wanted = write(path, size)
            for what, channels in (("inspect", None), ("read the channels of a fit", wanted)):
                cost = alone(path, channels)
                rows.append(_cells(f"{name}, {what}", path, cost))
                if cost.peak_mb > MEMORY_MB:
                    over.append(f"{name}, {what}: {cost.peak_mb:.0f} MB, asked {MEMORY_MB:g} MB")
    head = ("large logs", "MB", "channels", "seconds", "CPU s", "peak MB")
    say(f"In a process of its own.\n\n{table(head, rows)}")
    return over


def _cells(what: str, path: Path, cost: "Cost") -> tuple[str, ...]:
    size = f"{path.stat().st_size / 1e6:.0f}"
    times = f"{cost.seconds:.1f}", f"{cost.cpu:.1f}"
    return what, size, f"{cost.channels}", *times, f"{cost.peak_mb:.0f}"


def _sized(benchmarks: list[ModuleType]) -> Iterator[tuple[str, Callable[..., tuple[str, ...]]]]:
    for one in benchmarks:
        yield from getattr(one, "SIZED", {}).items()


def main() -> int:
    """Print the tables; 1 where something is short."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--short", action="store_true", help="logs of a seventh, none of 100 MB")
    parser.add_argument("--large", action="store_true", help="logs of 1 GB too")
    parser.add_argument("--only", help="one format: can, dataflash, mcap, nmea0183, tables, tlog")
    parser.add_argument("--out", type=Path, help="write the tables there too")
    given = parser.parse_args()
    parts: list[str] = []

    def say(words: str) -> None:
        parts.append(words)
        print(f"{words}\n", flush=True)
        if given.out is not None:
            text = "# Reading logs\n\n" + "\n\n".join(parts) + "\n"
            given.out.write_text(text, encoding="utf-8")

    benchmarks = list(modules(given.only))
    short = compared(benchmarks, SHORT if given.short else 1.0, say)
    if not given.short:
        short += inspected(benchmarks, HUNDRED, say)
    if given.large:
        short += huge(benchmarks, LARGE, say)
    print("\n".join(short) or "All as asked.")
    return int(bool(short))


if __name__ == "__main__":
    sys.exit(main())
