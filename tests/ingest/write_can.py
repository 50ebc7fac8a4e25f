"""CAN logs by python-can, their frames by the encoder of `nmea2000`; canboat's text by hand.

canboat's analyzer and the gateways of Yacht Devices and Actisense have no writer in Python: their
lines are put together here from the public description of the formats, of the same payloads.
"""

import functools
import time
from collections.abc import Callable, Iterable, Mapping
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path

import can
import numpy as np
from can.io.sqlite import SqliteWriter
from nmea2000 import backend
from nmea2000.decoder import NMEA2000Decoder
from written import Format, Series, Written

from trialid.alignment import SignalSource
from trialid.ingest.adapter import NO_AIDS, Aids

SOURCE = 11
CHANNELS = {
    "delta": "rudder/11/0:position",
    "r": "rate_of_turn/11:rate",
    "phi": "attitude/11:roll",
    "psi": "heading/11:true",
    "u": "speed/11:water",
}
RESOLUTION = {"delta": 1e-4, "r": 3.125e-8, "phi": 1e-4, "psi": 1e-4, "u": 1e-2}
GROUPS = {"delta": 127245, "r": 127251, "phi": 127257, "psi": 127250, "u": 128259}

Message = tuple[int, int, bytes]
"""Stamp [ns], parameter group, payload."""


EMPTY = {
    "delta": ("position", bytes.fromhex("00 f8 ff7f ff7f ffff")),
    "r": ("rate", bytes.fromhex("00 ffffff7f ffffff")),
    "phi": ("roll", bytes.fromhex("00 ff7f ff7f ff7f ff")),
    "psi": ("heading", bytes.fromhex("00 ffff ff7f ff7f fc")),
    "u": ("speedWaterReferenced", bytes.fromhex("00 ffff ffff ff ffff")),
}
"""The field of a quantity, and a message of its group in which it is not available."""


@functools.cache
def _message(quantity: str):
    data = ",".join(f"{byte:02x}" for byte in EMPTY[quantity][1])
    line = f"2020-01-01T00:00:00.000Z,2,{GROUPS[quantity]},{SOURCE},255,8,{data}"
    return NMEA2000Decoder().decode(line)


def payload(quantity: str, y: float) -> bytes:
    """The 8 bytes of a message of this quantity, all else `not available`."""
    message = _message(quantity)
    field = message.get_field_by_id(EMPTY[quantity][0])
    field.value, field.raw_value = y, None
    return backend.encode(message)


def messages(series: Mapping[str, Series]) -> list[Message]:
    """All messages of the series in the order of their stamps."""
    return sorted(
        (
            int(t),
            GROUPS[quantity],
            payload(quantity, float(y) % (2 * np.pi) if quantity == "psi" else float(y)),
        )
        for quantity, (stamps, values) in series.items()
        for t, y in zip(stamps, values, strict=True)
    )


def identifier(pgn: int, source: int = SOURCE, priority: int = 2) -> int:
    return priority << 26 | pgn << 8 | source


def frames(sent: Iterable[Message]) -> list[can.Message]:
    """As python-can has them."""
    return [
        can.Message(timestamp=t / 1e9, arbitration_id=identifier(pgn), data=data, channel=0)
        for t, pgn, data in sent
    ]


def written(series: Mapping[str, Series], clock_resolution: float, aids: Aids = NO_AIDS) -> Written:
    sources = tuple(
        SignalSource(
            quantity, CHANNELS[quantity], positive="starboard" if quantity == "delta" else None
        )
        for quantity in series
    )
    resolution = {quantity: RESOLUTION[quantity] for quantity in series}
    return Written(sources, resolution, clock_resolution, aids)


def by_python_can(path: Path, sent: Iterable[can.Message], suffix: str) -> None:
    """With the writer python-can has for this suffix."""
    there = path.with_suffix(suffix)
    with can.Logger(there) as logger:
        for message in sent:
            logger.on_message_received(message)
        if (
            suffix == ".db"
        ):  # the thread that writes loses what it has not fetched when it is told to stop
            while not logger.buffer.empty():
                time.sleep(0.01)
            time.sleep(2 * SqliteWriter.GET_MESSAGE_TIMEOUT)
    there.rename(path)


def _python_can(suffix: str, clock_resolution: float) -> Callable[..., Written]:
    def write(path: Path, series: Mapping[str, Series]) -> Written:
        by_python_can(path, frames(messages(series)), suffix)
        return written(series, clock_resolution)

    return write


def candump_lines(sent: Iterable[Message], form: str) -> list[str]:
    """Compact (-l); spaced from 1970 (-ta), as dates (-tA), since the line before (-td), -tz."""
    lines, first, before = [], None, None
    for t, pgn, data in sent:
        first = t if first is None else first
        before = t if before is None else before
        spaced = f"  can0  {identifier(pgn):08X}   [{len(data)}]  {data.hex(' ').upper()}"
        if form == "-l":
            lines.append(f"({_micro(t)}) can0 {identifier(pgn):08X}#{data.hex().upper()}")
        elif form == "-tA":
            date = datetime.fromtimestamp(t // 1_000_000_000, UTC).strftime("%Y-%m-%d %H:%M:%S")
            lines.append(f" ({date}.{t // 1000 % 1_000_000:06d}){spaced}")
        elif form == "none":
            lines.append(spaced)
        elif form == "<>":
            lines.append(f"({_micro(t)}) <0x{identifier(pgn):08x}> [{len(data)}] {data.hex(' ')} ")
        else:
            since = {"-ta": 0, "-tz": first, "-td": before}[form]
            lines.append(f" ({_micro(t - since, 3)}){spaced}")
        before = t
    return lines


def _micro(t: int, width: int = 10) -> str:
    return f"{t // 1_000_000_000:0{width}d}.{t // 1000 % 1_000_000:06d}"


def canboat_lines(sent: Iterable[Message]) -> list[str]:
    return [f"{_iso(t)}Z,2,{pgn},{SOURCE},255,{len(data)},{data.hex(',')}" for t, pgn, data in sent]


def yacht_devices_lines(sent: Iterable[Message]) -> list[str]:
    return [
        f"{_iso(t)[11:]} R {identifier(pgn):08X} {data.hex(' ').upper()}" for t, pgn, data in sent
    ]


def actisense_lines(sent: Iterable[Message]) -> list[str]:
    return [
        f"A{_iso(t)[11:].replace(':', '')} {SOURCE:02X}FF2 {pgn:05X} {data.hex().upper()}"
        for t, pgn, data in sent
    ]


def _iso(t: int) -> str:
    whole = datetime.fromtimestamp(t // 1_000_000_000, UTC).strftime("%Y-%m-%dT%H:%M:%S")
    return f"{whole}.{t // 1_000_000 % 1000:03d}"


def _text(lines: Callable[[Iterable[Message]], list[str]], clock_resolution: float):
    def write(path: Path, series: Mapping[str, Series]) -> Written:
        path.write_text("\n".join(lines(messages(series))) + "\n", encoding="ascii")
        return written(series, clock_resolution)

    return write


def _candump(form: str) -> Callable[[Path, Mapping[str, Series]], Written]:
    return _text(functools.partial(candump_lines, form=form), 1e-6)


FORMATS: tuple[Format, ...] = (
    Format("candump by python-can", _python_can(".log", 1e-6)),
    Format("candump -ta", _candump("-ta")),
    Format("candump -tA", _candump("-tA")),
    Format("candump -tz", _candump("-tz")),
    Format("candump -td", _candump("-td")),
    Format("asc", _python_can(".asc", 1e-3)),
    Format("blf", _python_can(".blf", 1e-3)),
    Format("trc", _python_can(".trc", 1e-3)),
    *([Format("mf4", _python_can(".mf4", 1e-6))] if find_spec("asammdf") else []),
    Format("python-can csv", _python_can(".csv", 1e-6)),
    Format("python-can sqlite", _python_can(".db", 1e-6)),
    Format("canboat", _text(canboat_lines, 1e-3)),
    Format("yacht devices", _text(yacht_devices_lines, 1e-3)),
    Format("actisense", _text(actisense_lines, 1e-3)),
)
