"""Writes dataflash logs. No library writes them: this encodes ArduPilot's format anew.

By AP_Logger: every message is A3 95, its type and packed columns; FMT describes all, UNIT, MULT and
FMTU say units, PARM the parameters. Pulse widths are made as SRV_Channel::pwm_from_angle does.
"""

import struct
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from written import Format, Series, Written

from trialid.alignment import SignalSource

HEAD = b"\xa3\x95"
STRUCT = {
    "b": "b", "B": "B", "h": "h", "H": "H", "i": "i", "I": "I", "f": "f", "d": "d", "n": "4s",
    "N": "16s", "Z": "64s", "c": "h", "C": "H", "e": "i", "E": "I", "L": "i", "M": "B", "q": "q",
    "Q": "Q", "g": "e", "a": "64s",
}  # fmt: skip
SCALE = {"c": 100, "C": 100, "e": 100, "E": 100, "L": 10_000_000}


@dataclass(frozen=True)
class Message:
    """One message type; units and mults are characters by column, empty for no FMTU."""

    number: int
    name: str
    codes: str
    columns: str
    units: str = ""
    mults: str = ""

    @property
    def packer(self) -> struct.Struct:
        return struct.Struct("<2sB" + "".join(STRUCT[code] for code in self.codes))


FMT = Message(0x80, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")
UNIT = Message(178, "UNIT", "QbZ", "TimeUS,Id,Label", "s--", "F--")
MULT = Message(179, "MULT", "Qbd", "TimeUS,Id,Mult", "s--", "F--")
FMTU = Message(177, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds", "s---", "F---")
PARM = Message(64, "PARM", "QNff", "TimeUS,Name,Value,Default", "s---", "F---")
MSG = Message(91, "MSG", "QZ", "TimeUS,Message", "s-", "F-")
MODE = Message(140, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn", "s---", "F---")
ARM = Message(203, "ARM", "QBIBB", "TimeUS,ArmState,ArmChecks,Forced,Method", "s----", "F----")
GPS = Message(
    130, "GPS", "QBBIHBcLLeffff",
    "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw",
    "s#-s-S-DUmnhnh", "F--C-0BGGB000-",
)  # fmt: skip
ATT = Message(
    100, "ATT", "QccccCC", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw", "sddddhh", "FBBBBBB"
)
AHR2 = Message(98, "AHR2", "QccCfLL", "TimeUS,Roll,Pitch,Yaw,Alt,Lat,Lng", "sddhmDU", "FBBB0GG")
IMU = Message(
    120, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ", "s#EEEooo", "F-000000"
)
RCOU = Message(
    94, "RCOU", "Q" + "H" * 14, "TimeUS," + ",".join(f"C{n}" for n in range(1, 15)),
    "s" + "Y" * 14, "F" + "-" * 14,
)  # fmt: skip
RALY = Message(188, "RALY", "QBBLLh", "TimeUS,Tot,Seq,Lat,Lng,Alt", "s--DUm", "F--GGB")
STER = Message(142, "STER", "Qhhf", "TimeUS,SteerIn,SteerOut,TurnRate", "s--k", "F--0")
MESSAGES = (FMT, UNIT, MULT, FMTU, PARM, MSG, MODE, ARM, GPS, ATT, AHR2, IMU, RCOU, RALY, STER)

UNITS = {
    "-": "", "?": "UNKNOWN", "s": "s", "d": "deg", "h": "degheading", "m": "m", "E": "rad/s",
    "k": "deg/s", "o": "m/s/s", "Y": "us", "#": "instance", "D": "deglatitude", "U": "deglongitude",
    "n": "m/s", "S": "satellites",
}  # fmt: skip
MULTS = {"-": 0.0, "?": 1.0, "0": 1.0, "A": 1e-1, "B": 1e-2, "C": 1e-3, "F": 1e-6, "G": 1e-7}

SERVO = {"FUNCTION": 26, "MIN": 1100, "TRIM": 1450, "MAX": 1920, "REVERSED": 1}
FULL_DEG = 35.0
COARSE_SIDE = min(SERVO["TRIM"] - SERVO["MIN"], SERVO["MAX"] - SERVO["TRIM"])
"""Counts of the side where one of them is the most."""


def packed(message: Message, *values: object) -> bytes:
    """One message; numbers physical, texts str."""
    columns = [
        value.encode() if isinstance(value, str) else round(value * SCALE[code])
        if code in SCALE else value
        for code, value in zip(message.codes, values, strict=True)
    ]  # fmt: skip
    return message.packer.pack(HEAD, message.number, *columns)


def description(messages: Sequence[Message] = MESSAGES, *, units: bool = True) -> bytes:
    """What stands at the beginning of every log."""
    parts = [
        packed(FMT, one.number, one.packer.size, one.name, one.codes, one.columns)
        for one in messages
    ]
    if units:
        parts += [packed(UNIT, 1, ord(key), label) for key, label in UNITS.items()]
        parts += [packed(MULT, 1, ord(key), mult) for key, mult in MULTS.items()]
        parts += [
            packed(FMTU, 1, one.number, one.units, one.mults) for one in messages if one.units
        ]
    return b"".join(parts)


def parameters(values: Mapping[str, float], at: int = 2) -> bytes:
    """PARM messages, all at `at` [us]."""
    return b"".join(packed(PARM, at, name, value, 0.0) for name, value in values.items())


def servo(number: int = 1, **changed: float) -> dict[str, float]:
    """Parameters of one rudder servo; None leaves one out."""
    values = SERVO | changed
    return {f"SERVO{number}_{name}": v for name, v in values.items() if v is not None}


def pwm(share: float, low: int, trim: int, high: int, flipped: int) -> int:
    """SRV_Channel::pwm_from_angle, truncation of the pulse width included."""
    scaled = max(-1.0, min(1.0, -share if flipped else share))
    if scaled > 0:
        return trim + int(scaled * (high - trim))
    return trim - int(-scaled * (trim - low))


def of_share(share: Iterable[float]) -> list[int]:
    """Pulse widths of SERVO."""
    low, trim, high, flipped = (SERVO[key] for key in ("MIN", "TRIM", "MAX", "REVERSED"))
    return [pwm(one, low, trim, high, flipped) for one in share]


@dataclass
class Log:
    """Messages with their times [us], put in order when written."""

    rows: list[tuple[int, bytes]] = field(default_factory=list)

    def add(self, message: Message, time: int, *values: object) -> None:
        self.rows.append((time, packed(message, time, *values)))

    def content(self) -> bytes:
        return b"".join(row for _, row in sorted(self.rows, key=lambda row: row[0]))


def write(path: Path, series: Mapping[str, Series]) -> Written:
    """Rudder as pulse widths, r of a gyro beside another one, phi and psi of two estimates."""
    start = min(int(t[0]) for t, _ in series.values()) - 60 * 10**9
    log = Log()
    for name, (t, y) in series.items():
        times = np.rint((t - start) / 1000).astype(int).tolist()
        for time, row in zip(times, _rows(name, y), strict=True):
            for message, *values in row:
                log.add(message, time, *values)
    opening = description() + parameters(servo()) + packed(MSG, 3, "ArduRover V4.5.7")
    path.write_bytes(opening + packed(MODE, 3, 0, 0, 1) + log.content())
    return _written(series)


def _rows(name: str, y):
    degrees = np.degrees(y)
    if name == "delta":
        shares = of_share(degrees / FULL_DEG)
        return [[(RCOU, one, *[1500] * 13)] for one in shares]
    if name == "r":
        return [[(IMU, 0, 0, 0, one, 0, 0, -9.8), (IMU, 1, 0, 0, 9.0, 0, 0, -9.8)] for one in y]
    if name == "phi":
        return [[(ATT, 0, one, 0, 0, 0, 0)] for one in degrees]
    if name == "psi":
        return [[(AHR2, 0, 0, one % 360, 0, 0, 0)] for one in degrees]
    return [[] for _ in y]


def _written(series: Mapping[str, Series]) -> Written:
    widest = 1.05 * FULL_DEG / COARSE_SIDE  # the autopilot truncates, it does not round
    sources = (
        SignalSource("delta", "servo/1:deflection", "deg", "starboard", gain=FULL_DEG),
        SignalSource("r", "IMU/0:GyrZ"),
        SignalSource("phi", "ATT:Roll"),
        SignalSource("psi", "AHR2:Yaw"),
    )
    step = np.radians(0.01)
    resolution = {"delta": np.radians(widest), "r": 1e-7, "phi": step, "psi": step}
    held = tuple(one for one in sources if one.quantity in series)
    return Written(held, {one.quantity: resolution[one.quantity] for one in held}, 1e-6)


FORMATS = (Format("dataflash", write),)
