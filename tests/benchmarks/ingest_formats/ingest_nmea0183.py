"""How fast NMEA 0183 and Signal K logs are read, beside pynmeagps on the same bytes.

python tests/benchmarks/ingest.py --only nmea0183
"""

import io
import tempfile
from pathlib import Path

import numpy as np
from ingest_timing import Row, SizedLogs, fastest, repeated
from pynmeagps import NMEAReader
from write_nmea0183 import OPENCPN, said, with_iso, with_opencpn, with_signal_k, with_tag_block

from trialid.ingest import read

START = 1_700_000_000_000_000_000
ASKED = 5.0
CONTAINERS = {
    "ISO stamps": ("", with_iso),
    "tag blocks": ("", with_tag_block),
    "OpenCPN": (OPENCPN, with_opencpn),
    "Signal K": ("", with_signal_k),
}
LIBRARY_SHARE = 10
"""pynmeagps reads one in so many of the sentences."""


def measure(scale: float = 1.0) -> list[Row]:
    """Speed of ours in four containers, pynmeagps on the bare sentences."""
    sentences = said(_series(round(1200 * scale))) * 4
    bare = "".join(text + "\r\n" for _, _, text in sentences[::LIBRARY_SHARE]).encode()
    library = len(sentences[::LIBRARY_SHARE]) / fastest(lambda: _library(bare))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, (head, around) in CONTAINERS.items():
            path = Path(folder) / "log"
            step = 10_000_000
            lines = [around(START + i * step, a, text) for i, (_, a, text) in enumerate(sentences)]
            path.write_bytes((head + "".join(lines)).encode())
            seconds = fastest(lambda path=path: _ours(path))
            rows.append((f"NMEA 0183, {name}", len(sentences) / seconds, library, ASKED))
    return rows


def _series(seconds: int):
    rng = np.random.default_rng(1)
    t = START + np.arange(seconds * 10) * 100_000_000
    scales = {"delta": 0.1, "r": 0.01, "phi": 0.05, "psi": 1.0, "u": 5.0}
    return {name: (t, scale * rng.normal(size=len(t))) for name, scale in scales.items()}


def _ours(path: Path) -> None:
    assert len(read(path).channels) == 5


def _library(data: bytes) -> None:
    for _ in NMEAReader(io.BytesIO(data)):
        pass


def sized(path: Path, size: float) -> tuple[str, ...]:
    """A log of that size, each sentence behind its stamp."""
    lines = [text for _, _, text in said(_series(600))]
    repeated(path, lines, lambda i: f"{np.datetime64(START // 10**6 + i * 10, 'ms')}Z ", size)
    return "RSA/AG:starboard", "ROT/TI:rate", "XDR/II/ROLL:angle"


SIZED: SizedLogs = {"NMEA 0183": sized}
