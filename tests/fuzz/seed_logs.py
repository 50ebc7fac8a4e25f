"""Small logs of every format, as the writers of the adapters' tests write them.

What a checksum covers is stated by format. `pairs`: values and stamps, as in chunks of MCAP, in
Excel's archive, in the packed variables of MATLAB and the packed containers of BLF. `values`: the
line stamps of NMEA 0183 and the receive stamps of a telemetry log stand outside of the checksum.
"""

import io
import re
import sys
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "ingest"))

import can  # noqa: E402
import write_can  # noqa: E402
import write_dataflash  # noqa: E402
import write_mcap  # noqa: E402
import write_nmea0183  # noqa: E402
import write_tables  # noqa: E402
import write_tlog  # noqa: E402
from sample_writers import write_logs  # noqa: E402
from written import Format, Series, Written  # noqa: E402

from trialid.alignment import SignalSource  # noqa: E402
from trialid.ingest.adapter import NO_AIDS, Aids  # noqa: E402

START = 1_700_000_000_000_000_000
SECONDS = 12.0
RATES = {"delta": 5, "r": 10, "phi": 5, "u": 2, "psi": 5}
MOTIONS = {
    "delta": lambda t: np.radians(20) * np.sin(0.6 * t),
    "r": lambda t: 0.01 * np.sin(0.6 * t - 0.9),
    "phi": lambda t: 0.05 * np.sin(0.5 * t),
    "u": lambda t: 7.0 + 0.01 * t,
    "psi": lambda t: np.radians(350 + 20 * np.sin(0.5 * t)),
}
CHUNK = 4096
"""Bytes of a chunk or container, so that a small log has several."""

BLF_HEADER = 144

Covered = Literal["nothing", "values", "pairs"]
File = Literal["log", "template", "dbc"]

DBC = """VERSION ""
BU_: A
BO_ 2314276107 Rudder: 8 A
 SG_ Position : 32|16@1- (0.0001,0) [0|0] "rad" A
BO_ 2314277643 Rate: 8 A
 SG_ Rate : 8|32@1- (3.125E-08,0) [0|0] "rad/s" A
VAL_ 2314277643 Rate 1 "one" ;
"""
LIKENESS = {
    "dataflash": write_dataflash.packed(write_dataflash.FMT, 100, 255, "ATT", "Q", "TimeUS"),
    "tlog": b"\xfd\xff\x01" + bytes(8),
    "NMEA": b"$HEHDT,1.0,T*00\r\n",
    "can": b"(1700000000.000000) can0 09F10D0B#00FFFFFFFFFFFFFF\n",
    "mcap": b"\x05\xff\xff\xff\xff\xff\xff\xff\x7f",
    "xlsx": b"PK\x03\x04",
}


@dataclass(frozen=True)
class SeedLog:
    """A log that is sound, what of it a checksum covers, and which file of it gets damaged."""

    name: str
    log: bytes
    sources: tuple[SignalSource, ...]
    aids: Aids = NO_AIDS
    covered: Covered = "nothing"
    harmed: File = "log"
    reseal: str = ""
    """Kind of container that is opened, damaged inside and sealed again; empty for none."""
    open_head: int = 0
    """First bytes, outside of the checksum, that all stamps count from."""

    @property
    def likeness(self) -> bytes:
        """What looks like one of its records; empty where nobody knows any."""
        return next((one for key, one in LIKENESS.items() if self.name.startswith(key)), b"")


def seed_logs(folder: Path) -> tuple[SeedLog, ...]:
    """All of them; aids are written into the folder."""
    return tuple(_all(folder))


def _all(folder: Path) -> Iterator[SeedLog]:
    chunk, write_logs.CHUNK_SIZE = write_logs.CHUNK_SIZE, CHUNK
    try:
        for form in write_mcap.FORMATS:
            yield from _both(_seed(form, folder, "pairs"), "mcap")
    finally:
        write_logs.CHUNK_SIZE = chunk
    for form in write_tables.FORMATS:
        yield from _table(form, folder)
    for form in (*write_can.FORMATS, Format("blf, small containers", _small_blf)):
        if form.name.startswith("blf"):
            blf = replace(_seed(form, folder, "pairs"), open_head=BLF_HEADER)
            yield from _both(blf, "blf")
        else:
            yield _seed(form, folder)
    yield from _with_dbc(folder)
    for form in write_nmea0183.FORMATS:
        plain = "deltas" in form.name or "2000" in form.name
        yield _seed(form, folder, "nothing" if plain else "values")
    yield _seed(write_dataflash.FORMATS[0], folder)
    yield _seed(write_tlog.FORMATS[0], folder, "values")


def _both(seed: SeedLog, container: str) -> Iterator[SeedLog]:
    """As it is, and damaged beneath its checksum."""
    yield seed
    yield replace(seed, name=f"{seed.name}, resealed", covered="nothing", reseal=container)


def _table(form: Format, folder: Path) -> Iterator[SeedLog]:
    sealed = form.name in ("xlsx", "mat5")
    seed = _seed(form, folder, "pairs" if sealed else "nothing")
    if sealed:
        yield from _both(seed, form.name)
    else:
        yield seed
    if seed.aids.template is not None:
        yield replace(seed, name="template of a table", harmed="template")


def _with_dbc(folder: Path) -> Iterator[SeedLog]:
    form = write_can.FORMATS[0]
    dbc = folder / "bus.dbc"
    dbc.write_text(DBC, encoding="ascii")
    sources = (
        SignalSource("delta", "Rudder:Position", None, "starboard"),
        SignalSource("r", "Rate:Rate"),
    )
    seed = replace(_seed(form, folder), sources=sources, aids=Aids(dbc=dbc))
    yield replace(seed, name="candump with DBC")
    yield replace(seed, name="DBC of a CAN log", harmed="dbc")


def _seed(form: Format, folder: Path, covered: Covered = "nothing") -> SeedLog:
    path = folder / re.sub(r"\W+", "_", form.name)
    made = form.write(path, series())
    log = _undated(path.read_bytes())
    path.unlink()
    return SeedLog(form.name, log, made.sources, made.aids, covered)


def series() -> dict[str, Series]:
    """The motions at the stamps of each sensor."""
    found = {}
    for name, motion in MOTIONS.items():
        t = np.arange(0.0, SECONDS, 1 / RATES[name])
        found[name] = (START + np.rint(t * 1e9).astype(np.int64), motion(t))
    return found


def _small_blf(path: Path, some: Mapping[str, Series]) -> Written:
    there = path.with_suffix(".blf")
    with can.BLFWriter(there, max_container_size=CHUNK) as writer:
        for message in write_can.frames(write_can.messages(some)):
            writer.on_message_received(message)
    there.rename(path)
    return write_can.written(some, 1e-3)


def _undated(log: bytes) -> bytes:
    """The log without the day on which it was written, so that every run harms the same bytes."""
    if log.startswith(b"MATLAB 5.0"):
        return b"MATLAB 5.0 MAT-file".ljust(116) + log[116:]
    if not log.startswith(b"PK"):
        return log
    made = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(log)) as old, zipfile.ZipFile(made, "w") as new:
        for member in old.infolist():
            content = re.sub(rb"\d{4}-\d\d-\d\dT[\d:]+Z", b"2023-11-14T00:00:00Z", old.read(member))
            new.writestr(zipfile.ZipInfo(member.filename), content, zipfile.ZIP_DEFLATED)
    return made.getvalue()
