"""How fast NMEA 0183 and Signal K logs are read, beside pynmeagps on the same bytes.

`PYTHONPATH=.:tests/ingest python tests/benchmarks/ingest_nmea0183.py`
"""

import io
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from pynmeagps import NMEAReader

sys.path.insert(0, str(Path(__file__).parents[1] / "ingest"))
from write_nmea0183 import OPENCPN, said, with_iso, with_opencpn, with_signal_k, with_tag_block

from trialid.ingest import read

Row = tuple[str, float, float, float]
"""What, ours [sentences/s], pynmeagps' [sentences/s], the ratio that is asked."""

START = 1_700_000_000_000_000_000
ASKED = 10.0
CONTAINERS = {
    "ISO stamps": ("", with_iso),
    "tag blocks": ("", with_tag_block),
    "OpenCPN": (OPENCPN, with_opencpn),
    "Signal K": ("", with_signal_k),
}
LIBRARY_SHARE = 10
"""pynmeagps reads one in so many of the sentences."""


def measure(scale: float = 1.0) -> list[Row]:
    """Speed of ours in four containers, pynmeagps on the bare sentences; CPU time, best of 3."""
    sentences = said(_series(round(1200 * scale))) * 4
    bare = "".join(text + "\r\n" for _, _, text in sentences[::LIBRARY_SHARE]).encode()
    library = len(sentences[::LIBRARY_SHARE]) / min(_library(bare) for _ in range(3))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, (head, around) in CONTAINERS.items():
            path = Path(folder) / "log"
            step = 10_000_000
            lines = [around(START + i * step, a, text) for i, (_, a, text) in enumerate(sentences)]
            path.write_bytes((head + "".join(lines)).encode())
            seconds = min(_ours(path) for _ in range(3))
            rows.append((name, len(sentences) / seconds, library, ASKED))
    return rows


def _series(seconds: int):
    rng = np.random.default_rng(1)
    t = START + np.arange(seconds * 10) * 100_000_000
    scales = {"delta": 0.1, "r": 0.01, "phi": 0.05, "psi": 1.0, "u": 5.0}
    return {name: (t, scale * rng.normal(size=len(t))) for name, scale in scales.items()}


def _ours(path: Path) -> float:
    start = time.process_time()
    assert len(read(path).channels) == 5
    return time.process_time() - start


def _library(data: bytes) -> float:
    start = time.process_time()
    for _ in NMEAReader(io.BytesIO(data)):
        pass
    return time.process_time() - start


if __name__ == "__main__":
    print(f"{'':12}{'ours/s':>12}{'pynmeagps/s':>14}{'ratio':>8}{'asked':>7}")
    for what, ours, library, asked in measure(float(sys.argv[1]) if len(sys.argv) > 1 else 1.0):
        print(f"{what:12}{ours:12.0f}{library:14.0f}{ours / library:8.1f}{asked:7.0f}")
