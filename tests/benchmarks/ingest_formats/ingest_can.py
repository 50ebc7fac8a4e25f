"""How fast logs of CAN buses are read, beside python-can with nmea2000 or cantools.

    python tests/benchmarks/ingest.py --only can

Both read the same files in the same process: ours into channels, theirs into decoded messages, of
the groups ours reads. Files are made on the spot, of frames as a ship's bus carries them.
"""

import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

import can
import cantools
import numpy as np
import write_can
from can.io.asc import ASCReader
from can.io.blf import BLFReader
from can.io.csv import CSVReader
from can.io.sqlite import SqliteReader
from can.io.trc import TRCReader
from ingest_timing import Row, SizedLogs, race, repeated
from nmea2000.decoder import NMEA2000Decoder

from trialid.ingest import read
from trialid.ingest.adapter import Aids
from trialid.ingest.nmea2000.nmea2000_pgns import LAYOUTS

MESSAGES = 20_000
ASKED = 3.0
DBC = """VERSION ""
BU_: A
BO_ 2314276107 Rudder: 8 A
 SG_ Position : 32|16@1- (0.0001,0) [0|0] "rad" A
 SG_ Order : 16|16@1- (0.0001,0) [0|0] "rad" A
"""


def measure(scale: float = 1.0) -> list[Row]:
    """One row for each format."""
    count = max(MESSAGES, int(MESSAGES * scale))
    sent = _sent(count)
    frames = write_can.frames(sent)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log"
        rows = [_text(path, form, lines, count) for form, lines in _texts(sent).items()]
        for suffix, reader in {
            ".asc": lambda path: ASCReader(path, relative_timestamp=False),
            ".blf": BLFReader,
            ".trc": TRCReader,
            ".csv": CSVReader,
            ".db": SqliteReader,
        }.items():
            write_can.by_python_can(path, frames, suffix)
            rows.append(_row(f"python-can {suffix}", count, path, _by_nmea2000(reader, path)))
        write_can.by_python_can(path, frames, ".blf")
        rows.append(_by_dbc(path, count))
    return rows


def _sent(count: int) -> list[write_can.Message]:
    """Messages of five groups in turn."""
    s = np.arange(count) / 100
    t = 1_700_000_000_000_000_000 + (s * 1e9).astype(np.int64)
    series = {
        quantity: (t[k::5], 1 + np.sin(s[k::5] + k)) for k, quantity in enumerate(write_can.GROUPS)
    }
    return write_can.messages(series)


def _texts(sent: list[write_can.Message]) -> dict[str, list[str]]:
    return {
        "candump -l": write_can.candump_lines(sent, "-l"),
        "canboat": write_can.canboat_lines(sent),
        "yacht devices": write_can.yacht_devices_lines(sent),
        "actisense": write_can.actisense_lines(sent),
    }


def _text(path: Path, form: str, lines: list[str], count: int) -> Row:
    path.write_text("\n".join(lines) + "\n", encoding="ascii")

    def theirs() -> int:
        decoder = NMEA2000Decoder(include_pgns=list(LAYOUTS))
        with path.open(encoding="ascii") as file:
            return sum(decoder.decode(line.rstrip()) is not None for line in file)

    return _row(form, count, path, theirs)


def _by_nmea2000(reader: Callable[[Path], Iterable[can.Message]], path: Path) -> Callable[[], int]:
    def theirs() -> int:
        decoder = NMEA2000Decoder(include_pgns=list(LAYOUTS))
        return sum(decoder.decode(message) is not None for message in reader(path))

    return theirs


def _by_dbc(path: Path, count: int) -> Row:
    dbc = path.with_name("bus.dbc")
    dbc.write_text(DBC, encoding="ascii")

    def theirs() -> int:
        database = cantools.database.load_file(dbc)
        known = {message.frame_id for message in database.messages}
        return sum(
            1
            for message in BLFReader(path)
            if message.arbitration_id not in known
            or database.decode_message(message.arbitration_id, message.data)
        )

    return _row("python-can .blf by DBC", count, path, theirs, Aids(dbc=dbc))


def _row(what: str, count: int, path: Path, theirs: Callable[[], int], aids: Aids = Aids()) -> Row:  # noqa: B008
    assert theirs() == count
    assert read(path, None, aids).channels
    own, other = race(lambda: read(path, None, aids), theirs)
    return what, count / own, count / other, ASKED


def sized(path: Path, size: float) -> tuple[str, ...]:
    """A candump of that size."""
    lines = [line.partition(" ")[2] for line in write_can.candump_lines(_sent(50_000), "-l")]
    repeated(path, lines, lambda i: f"({1_700_000_000 + i / 100:.6f}) ", size)
    return tuple(write_can.CHANNELS.values())


SIZED: SizedLogs = {"candump": sized}
