"""Channels of the real records beside the repository, read without an adapter; in SI."""

import re
from datetime import datetime
from functools import cache
from pathlib import Path

import numpy as np

from trialid.alignment.clocks import Series
from trialid.names.quantities import SIGNALS

DATA = Path(__file__).parents[3] / "shared/data"
HSVA = sorted((DATA / "kvlcc2_hsva_zigzag").glob("*.dat"))
DECAY = DATA / "kvlcc2_roll_decay/model_test_21337.csv"
BUSES = (*sorted((DATA / "canboat_n2k").glob("*")), *(DATA / "ydvr_yacht").glob("*.log"))
FRAME = re.compile(r"\((\d+\.\d+)\) \S+ ([0-9A-Fa-f]{8})#([0-9A-Fa-f]{16})$")

FIELDS = {
    127251: (("r", 1, 4, True, 3.125e-8),),
    127257: (("phi", 5, 2, True, 1e-4),),
    127245: (("delta_order", 2, 2, True, 1e-4), ("delta", 4, 2, True, 1e-4)),
    127250: (("psi", 1, 2, False, 1e-4),),
    128259: (("u", 1, 2, False, 0.01),),
    129026: (("sog", 4, 2, False, 0.01),),
}  # fmt: skip
"""PGN to quantity, first byte, bytes, signed, SI per count: the public NMEA 2000 tables."""


def series(quantity, t, y):
    """A series from stamps [ns] or [s] and values in SI."""
    t = np.asarray(t)
    stamps = t if t.dtype == np.int64 else np.rint(t * 1e9).astype(np.int64)
    return Series(SIGNALS[quantity], stamps, np.asarray(y, dtype=float), "real")


def hsva(path):
    """Columns of a zig-zag as the release names them nowhere but in its catalogue."""
    table = np.loadtxt(path, encoding="cp1252", skiprows=4).T
    names = "t", "x0", "y0", "psi", "along", "across", "r", "phi", "delta", "n", "thrust", "torque"
    return dict(zip(names, table, strict=True))


def hsva_series(path):
    """Heading, rate of turn, roll, speed and rudder of a zig-zag, rightly read."""
    c = hsva(path)
    motions = {q: np.deg2rad(c[q]) for q in ("psi", "r", "phi", "delta")}
    u = c["along"] * np.cos(motions["psi"]) + c["across"] * np.sin(motions["psi"])
    motions |= {"delta": -motions["delta"], "u": u}
    return {q: series(q, c["t"], y) for q, y in motions.items()}


def decay_series(path=DECAY):
    table = np.loadtxt(path, delimiter=",", skiprows=1).T
    return {"phi": series("phi", table[0], table[4]), "psi": series("psi", table[0], table[6])}


@cache
def bus(path):
    """(quantity, source) to stamps [ns] and values [SI] of single frames on an NMEA 2000 bus."""
    found = {}
    for stamp, pgn, source, data in _frames(path):
        for quantity, first, count, signed, scale in FIELDS.get(pgn, ()):
            word = int.from_bytes(data[first : first + count], "little", signed=signed)
            top = 2 ** (8 * count - signed)
            y = np.nan if word >= top - 3 else word * scale
            found.setdefault((quantity, source), []).append((stamp, y))
    return {
        key: (np.array([t for t, _ in rows]), np.array([y for _, y in rows]))
        for key, rows in found.items()
    }


def bus_series(path):
    """Every channel of the bus that has values, of the quantities the dictionary knows."""
    return {
        key: series(key[0], t, y)
        for key, (t, y) in bus(path).items()
        if key[0] in SIGNALS and np.isfinite(y).sum() >= 10
    }


def _frames(path):
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        frame = FRAME.match(line.strip())
        if frame:
            word = int(frame[2], 16)
            pgn = (word >> 8) & (0x3FFFF if (word >> 16) & 0xFF >= 240 else 0x3FF00)
            yield round(float(frame[1]) * 1e9), pgn, word & 0xFF, bytes.fromhex(frame[3])
            continue
        parts = line.split(",")
        if len(parts) == 14 and parts[5] == "8" and parts[2].isdigit():
            moment = datetime.fromisoformat(parts[0])
            stamp = round(moment.timestamp() * 1000) * 10**6
            yield stamp, int(parts[2]), int(parts[3]), bytes.fromhex("".join(parts[6:]))
