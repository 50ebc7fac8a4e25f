"""The frames of an MF4 file by python-can's reader, in a process of its own.

asammdf, which that reader takes, unpacks blocks by what they state of themselves: on a damaged file
it may end the process, fill the memory or never come back. So it runs where that harms nobody.

python -m trialid.ingest.can.mf4_child LOG.mf4 FRAMES.npz MEGABYTES SECONDS
"""

import sys
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import can

BLOCK = 1 << 16
COLUMNS = ("seconds", "can_id", "extended", "length", "bus", "kind")
DATA, ERROR, REMOTE = 0, 1, 2
"""What a frame is."""


def main(log: Path, out: Path, megabytes: int, seconds: int) -> None:
    """Write the frames there are, also those before the place where the file is damaged."""
    _bound(megabytes, seconds)
    import can

    parts = [_of(())]
    try:
        messages = iter(can.MF4Reader(log))
        while block := tuple(islice(messages, BLOCK)):
            parts.append(_of(block))
    finally:
        columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        np.savez(out, allow_pickle=False, **columns)


def _bound(megabytes: int, seconds: int) -> None:
    """No more memory and time of the processor than this, where the system can refuse it."""
    if sys.platform != "win32":
        import resource

        limits = ((resource.RLIMIT_AS, megabytes * 1_000_000), (resource.RLIMIT_CPU, seconds))
        for what, most in limits:
            _, hard = resource.getrlimit(what)
            resource.setrlimit(what, (most, hard))


def _of(block: "tuple[can.Message, ...]") -> dict[str, NDArray[Any]]:
    """Columns of messages; the data of each in eight bytes, of a longer one the first."""
    flat = b"".join(bytes(one.data)[:8].ljust(8, b"\0") for one in block)
    rows = [
        (
            one.timestamp,
            one.arbitration_id,
            one.is_extended_id,
            len(one.data),
            _bus(one),
            _kind(one),
        )
        for one in block
    ]
    table = np.array(rows, np.float64).reshape(-1, len(COLUMNS))
    columns = {name: table[:, i] for i, name in enumerate(COLUMNS)}
    return {**columns, "table": np.frombuffer(flat, np.uint8).reshape(-1, 8)}


def _bus(message: "can.Message") -> int:
    return min(message.channel, 255) if isinstance(message.channel, int) else 0


def _kind(message: "can.Message") -> int:
    return ERROR if message.is_error_frame else REMOTE if message.is_remote_frame else DATA


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]))
