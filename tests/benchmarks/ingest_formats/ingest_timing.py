"""What the benchmarks of log formats share: a row, the fastest of some runs, tables, peak memory.

Each `ingest_<format>.py` has `measure(scale) -> list[Row]`, ours beside the plain library on the
same logs in the same process, and `SIZED`, writers of logs of a size for `inspect`.
"""

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

Row = tuple[str, float, float, float]
"""What was read, messages a second by ours and by the library, and the ratio that is asked."""

Sized = Callable[[Path, float], Sequence[str]]
"""Writes a log of about so many bytes; gives the channels a fit needs of it."""


def fastest(work: Callable[[], object], repeats: int = 3) -> float:
    """Seconds of the fastest of some runs: what other work on the machine disturbs least."""
    return min(_seconds(work) for _ in range(repeats))


def race(
    ours: Callable[[], object], theirs: Callable[[], object], repeats: int = 3
) -> tuple[float, float]:
    """Seconds of the fastest run of each, run in turn, so that other work disturbs both."""
    times = [(_seconds(ours), _seconds(theirs)) for _ in range(repeats)]
    return min(own for own, _ in times), min(other for _, other in times)


def _seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def short(rows: Iterable[Row]) -> list[str]:
    """What was read slower than asked, with the figures."""
    return [
        f"{what}: {ours / theirs:.2f} times the library, asked {asked:g}"
        for what, ours, theirs, asked in rows
        if ours / theirs < asked
    ]


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown, numbers to the right."""
    body = [list(row) for row in rows]
    widths = [max(len(row[k]) for row in [head, *body]) for k in range(len(head))]
    line = [f"{'-' * (w - 1)}{':' if k else '-'}" for k, w in enumerate(widths)]
    laid = (
        [cell.ljust(w) for cell, w in zip(row[:1], widths, strict=False)]
        + [cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True)]
        for row in (head, line, *body)
    )
    return "\n".join(f"| {' | '.join(row)} |" for row in laid)


def speeds(rows: Iterable[Row]) -> str:
    """The table of `measure`."""
    head = ("read", "ours [1/s]", "library [1/s]", "ratio", "asked")
    cells = (
        (what, f"{ours:,.0f}", f"{theirs:,.0f}", f"{ours / theirs:.2f}", f"{asked:g}")
        for what, ours, theirs, asked in rows
    )
    return table(head, cells)


@dataclass(frozen=True)
class Cost:
    """What a piece of work cost in a process of its own, imports included; `cpu` in seconds too."""

    seconds: float
    cpu: float
    peak_mb: float
    channels: int


ALONE = """
import json, sys, time
from pathlib import Path
path, wanted = Path(sys.argv[1]), json.loads(sys.argv[2])
start = time.perf_counter()
if wanted is None:
    from trialid.inspection import inspect_log
    from trialid.report.terminal.log_contents import inspection
    found = inspect_log(path)
    inspection(found)
else:
    from trialid.ingest import read
    found = read(path, wanted)
seconds, cpu = time.perf_counter() - start, time.process_time()
peak = int(Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()[0]) / 1e3
print(json.dumps([seconds, cpu, peak, len(found.channels)]))
"""


def alone(path: Path, wanted: Sequence[str] | None) -> Cost:
    """Cost of reading the wanted channels; None: of what `trialid inspect` does."""
    command = [sys.executable, "-c", ALONE, str(path), json.dumps(wanted and list(wanted))]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return Cost(*json.loads(done.stdout))


def repeated(
    path: Path, lines: Sequence[str], head: Callable[[int], str], size: float, opening: str = ""
) -> None:
    """Text of about `size` bytes: the lines again and again, each behind its own head."""
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write(opening)
        at = 0
        while file.tell() < size:
            file.write("".join(f"{head(at + i)}{line}\n" for i, line in enumerate(lines)))
            at += len(lines)


SizedLogs = Mapping[str, Sized]
"""By format."""
