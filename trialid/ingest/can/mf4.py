"""ASAM MF4 files of a CAN bus to frames, by the reader of python-can, which takes asammdf.

Frames of all channel groups in the order of their stamps; these count from the file's start in UTC.
A file that its recorder never closed (`UnFinMF`) is read as far as asammdf gets. The reader runs in
a process of its own, within bounds of memory and time.
"""

import os
import signal
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from math import ceil
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.can.can_frames import EXTENDED_ID, STANDARD_ID, Frames, Tally
from trialid.ingest.can.mf4_child import DATA, ERROR, REMOTE
from trialid.ingest.packages import is_installed

HEADS: Final = (b"MDF     ", b"UnFinMF ")
LATEST_S: Final = 9e9
LEAST_MB, TIMES = 2_000, 40
"""Memory the reader may take: 2 GB of addresses, which it takes by being loaded, and 40 times the
file, which packs 3 to 10 times and is held as numbers and as messages."""
LEAST_S, BYTES_PER_S = 60.0, 100_000.0
"""Time of the processor it may take; a frame of 20 packed bytes takes 15 us, a tenth of that."""
LONGEST_WAIT = 10.0
"""Times as long by the clock: other processes may have the processor, or it waits for nothing."""


def is_mf4(head: bytes) -> bool:
    """The first words of MDF, finished or not."""
    return head.startswith(HEADS)


def frames(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of the file, and words for their clock; LogError when there is none."""
    del zone
    is_installed("asammdf", path, "ASAM MF4", extra="mf4")
    with path.open("rb") as file:
        version = file.read(9)[8:]
    if version != b"4":
        raise LogError(f"{path}: is MDF of a version before 4; save it as MF4, or export it as CSV")
    columns, trouble = _columns(path)
    count = len(columns["seconds"]) if columns else 0
    if trouble and not count:
        raise LogError(f"{path}: is no MF4 file that can be read ({trouble}); copy it again")
    found = _frames(columns, tally) if columns else None
    if found is None or not len(found):
        raise LogError(f"{path}: is MF4 without frames of a CAN bus; export its signals as CSV")
    if trouble:
        tally.remarks.append(f"recovered {count} frames, then the file is damaged ({trouble})")
    return found, "frame stamps (start of the file in UTC)"


def _columns(path: Path) -> tuple[Mapping[str, NDArray[Any]], str]:
    """What the reader wrote, and why it stopped early, if it did."""
    megabytes = LEAST_MB + TIMES * path.stat().st_size // 1_000_000
    seconds = ceil(LEAST_S + path.stat().st_size / BYTES_PER_S)
    with tempfile.TemporaryDirectory(prefix="trialid-mf4-") as folder:
        out = Path(folder, "frames.npz")
        module = "trialid.ingest.can.mf4_child"
        command = [sys.executable, "-P", "-W", "ignore", "-m", module]
        command += [str(path.resolve()), str(out), str(megabytes), str(seconds)]
        known = os.pathsep.join(one for one in sys.path if one)
        try:
            done = subprocess.run(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE, timeout=LONGEST_WAIT * seconds, check=False,
                env={**os.environ, "PYTHONPATH": known},
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return {}, f"the reader did not come back in {LONGEST_WAIT * seconds:.0f} s"
        except OSError as error:
            return {}, f"the reader cannot be started, {error.strerror}"
        return _written(out), _trouble(done)


def _written(out: Path) -> Mapping[str, NDArray[Any]]:
    try:
        with np.load(out, allow_pickle=False) as found:
            return dict(found)
    except (OSError, ValueError, zipfile.BadZipFile, EOFError):
        return {}


def _trouble(done: "subprocess.CompletedProcess[bytes]") -> str:
    """The last line of an error; nothing of a process that ended well."""
    if done.returncode == 0:
        return ""
    if done.returncode < 0:
        late = done.returncode == -getattr(signal, "SIGXCPU", 0)
        return "the reader did not come to an end" if late else "the reader broke down on it"
    lines = [one.strip() for one in done.stderr.decode("utf-8", "replace").splitlines()]
    told = [one for one in lines if one and ": " in one and "Exception ignored" not in one]
    return (told or ["the reader gave up"])[-1][:120]


def _frames(columns: Mapping[str, NDArray[Any]], tally: Tally) -> Frames:
    """Frames of the columns; which bus they came from is its number in the file."""
    seconds, kind, length = columns["seconds"], columns["kind"], columns["length"]
    can_id, extended = columns["can_id"], columns["extended"] > 0
    sane = (np.abs(seconds) < LATEST_S) & (can_id <= np.where(extended, EXTENDED_ID, STANDARD_ID))
    tally.lines += len(seconds)
    tally.errors += int(np.sum(kind == ERROR))
    tally.remote += int(np.sum(kind == REMOTE))
    tally.flexible += int(np.sum((kind == DATA) & (length > 8)))
    tally.strange += int(np.sum((kind == DATA) & ~sane))
    used = sane & (kind == DATA) & (length <= 8)
    bus = columns["bus"][used].astype(np.int64)
    return Frames(
        t=np.rint(seconds[used] * 1e6).astype(np.int64) * 1000,  # good to 0.2 us at 1.7e9 s
        can_id=can_id[used].astype(np.int64),
        extended=extended[used],
        table=np.ascontiguousarray(columns["table"][used]),
        length=length[used].astype(np.int64),
        bus=bus,
        buses=tuple(f"CAN{n}" for n in range(int(bus.max(initial=0)) + 1)),
    )
