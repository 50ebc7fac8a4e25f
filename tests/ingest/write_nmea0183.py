r"""NMEA 0183 logs: sentences by pynmeagps, what recorders put around them by hand.

kplex, the loggers of ships (IEC 61162-450), OpenCPN and Signal K have no writer in Python: stamps,
tag blocks `\s:..,c:..*hh\`, rows and lines are put together here from the public description of
the formats; so are the deltas and the NMEA 2000 lines of a Signal K log.
"""

import json
import struct
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from functools import reduce
from operator import xor
from pathlib import Path

import numpy as np
from pynmeagps import NMEAMessage
from written import Format, Series, Written

from trialid.alignment import SignalSource

SENTENCES = {
    "delta": ("AG", "RSA", lambda y: [f"{np.degrees(y):.2f}", "A", "", "V"]),
    "r": ("TI", "ROT", lambda y: [f"{np.degrees(y) * 60:.2f}", "A"]),
    "phi": ("II", "XDR", lambda y: ["A", f"{np.degrees(y):.2f}", "D", "ROLL"]),
    "u": ("VW", "VHW", lambda y: ["", "T", "", "M", f"{y * 3600 / 1852:.3f}", "N", "", "K"]),
    "psi": ("HE", "HDT", lambda y: [f"{np.degrees(y) % 360:.2f}", "T"]),
}
CHANNELS = {
    "delta": ("RSA/AG:starboard", "deg"),
    "r": ("ROT/TI:rate", None),
    "phi": ("XDR/II/ROLL:angle", None),
    "u": ("VHW/VW:speed", None),
    "psi": ("HDT/HE:heading", None),
}
HUNDREDTH = float(np.radians(0.01))
RESOLUTION = {
    "delta": HUNDREDTH,
    "r": HUNDREDTH / 60,
    "phi": HUNDREDTH,
    "u": 1.852 / 3600,
    "psi": HUNDREDTH,
}
PATHS = {
    "delta": "steering.rudderAngle",
    "r": "navigation.rateOfTurn",
    "phi": "navigation.attitude",
    "u": "navigation.speedThroughWater",
    "psi": "navigation.headingTrue",
}
GROUPS = {
    "delta": (127245, "rudder/11/0:position", 1e-4, "000FFF7F{i2}FFFF"),
    "r": (127251, "rate_of_turn/11:rate", 3.125e-8, "00{i4}FFFFFF"),
    "phi": (127257, "attitude/11:roll", 1e-4, "00FF7FFF7F{i2}FF"),
    "u": (128259, "speed/11:water", 1e-2, "00{u2}FFFF00FFFF"),
    "psi": (127250, "heading/11:true", 1e-4, "00{u2}FF7FFF7FFC"),
}
Around = Callable[[int, str, str], str]
"""Stamp [ns], address and sentence to a line."""


def sentence(talker: str, kind: str, fields: list[str]) -> str:
    return NMEAMessage(talker, kind, 0, payload=fields).serialize().decode().rstrip()


def checksum(text: str) -> str:
    return f"{reduce(xor, text.encode(), 0):02X}"


def said(series: Mapping[str, Series]) -> list[tuple[int, str, str]]:
    """Stamp, address and sentence of every sample, in the order of the stamps."""
    return sorted(
        (
            int(t),
            "".join(SENTENCES[name][:2]),
            sentence(*SENTENCES[name][:2], SENTENCES[name][2](y)),
        )
        for name, (stamps, values) in series.items()
        for t, y in zip(stamps, values, strict=True)
    )


def milliseconds(t: int) -> int:
    return (t + 500_000) // 1_000_000


def iso(t: int) -> str:
    stamp = datetime.fromtimestamp(milliseconds(t) / 1e3, UTC)
    return stamp.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def with_iso(t: int, address: str, text: str) -> str:
    return f"{iso(t)} {text}\r\n"


def with_tag_block(t: int, address: str, text: str) -> str:
    tag = f"s:{address[:2]}0001,c:{milliseconds(t)}"
    return f"\\{tag}*{checksum(tag)}\\{text}\r\n"


def with_datagram(t: int, address: str, text: str) -> str:
    return "UdPbC\0" + with_tag_block(t, address, text)


def with_opencpn(t: int, address: str, text: str) -> str:
    return f'{milliseconds(t)},NMEA0183,TCP 10.0.0.1:3000,{address[2:]},"{text}"\n'


def with_signal_k(t: int, address: str, text: str) -> str:
    return f"{milliseconds(t)};N;{text}\n"


OPENCPN = (
    "# timestamp_format: EPOCH_MILLIS\n# Created at: Tue Nov 14 22:13:20 2023\n \n"
    "received_at,protocol,msg_type,source,raw_data\n"
)


def of_sentences(name: str, around: Around, head: str = "") -> Format:
    def write(path: Path, series: Mapping[str, Series]) -> Written:
        lines = "".join(around(*one) for one in said(series))
        path.write_bytes((head + lines).encode())
        sources = tuple(
            SignalSource(
                quantity, *CHANNELS[quantity], "starboard" if quantity == "delta" else None
            )
            for quantity in series
        )
        return Written(sources, {name: RESOLUTION[name] for name in series}, 1e-3)

    return Format(name, write)


def delta(name: str, y: float, t: int | None = None) -> str:
    value = {"roll": y, "pitch": None, "yaw": None} if name == "phi" else y
    stamp = {} if t is None else {"timestamp": f"{iso(t - t % 1_000_000)[:-1]}{t % 1_000_000:06d}Z"}
    update = {"$source": "can.11", **stamp, "values": [{"path": PATHS[name], "value": value}]}
    return json.dumps({"context": "vessels.self", "updates": [update]})


def group(name: str, y: float, t: int) -> str:
    pgn, _, step, layout = GROUPS[name]
    kind = next(kind for kind in ("i2", "i4", "u2") if kind in layout)
    turned = y % (2 * np.pi) if name == "psi" else y
    packed = struct.pack({"i2": "<h", "i4": "<i", "u2": "<H"}[kind], round(turned / step))
    data = bytes.fromhex(layout.replace(f"{{{kind}}}", packed.hex())).hex(",")
    return f"A;{iso(t)},2,{pgn},11,255,8,{data}"


def signal_k(
    name: str, line: Callable[[str, float, int], str], channels, resolution, stamped=True
) -> Format:
    def write(path: Path, series: Mapping[str, Series]) -> Written:
        lines = sorted(
            (milliseconds(t), line(quantity, float(y), int(t)))
            for quantity, (stamps, values) in series.items()
            for t, y in zip(stamps.tolist(), values, strict=True)
        )
        path.write_text("".join(f"{t};{text}\n" if stamped else f"{text}\n" for t, text in lines))
        sources = tuple(
            SignalSource(
                quantity, channels[quantity], None, "starboard" if quantity == "delta" else None
            )
            for quantity in series
        )
        return Written(sources, {name: resolution(name) for name in series}, 1e-3)

    return Format(name, write)


OF_DELTAS = {
    name: f"{path}/can.11:{'roll' if name == 'phi' else 'value'}" for name, path in PATHS.items()
}

FORMATS: tuple[Format, ...] = (
    of_sentences("NMEA 0183, ISO stamps", with_iso),
    of_sentences("NMEA 0183, tag blocks", with_tag_block),
    of_sentences("NMEA 0183, UdPbC", with_datagram),
    of_sentences("NMEA 0183, OpenCPN", with_opencpn, OPENCPN),
    of_sentences("Signal K, sentences", with_signal_k),
    signal_k(
        "Signal K, deltas",
        lambda name, y, t: f"I;{delta(name, y)}",
        OF_DELTAS,
        lambda name: 1e-12,
    ),
    signal_k("Signal K, deltas alone", delta, OF_DELTAS, lambda name: 1e-12, stamped=False),
    signal_k(
        "Signal K, NMEA 2000",
        group,
        {name: channel for name, (_, channel, _, _) in GROUPS.items()},
        lambda name: GROUPS[name][2],
    ),
)
