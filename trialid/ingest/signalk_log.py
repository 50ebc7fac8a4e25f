"""Logs of a Signal K server: `milliseconds since 1970;discriminator;what came in`.

N is an NMEA 0183 sentence, A a whole NMEA 2000 message as canboat writes it, I a Signal K delta in
JSON. Channels of N are named as in NMEA 0183 logs, of A as in NMEA 2000 logs; those of I are
`path/source:field`: `steering.rudderAngle/n2k.11:value`, `navigation.attitude/imu:roll`. Numbers of
Signal K are SI.
"""

import json
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from trialid.errors import LogError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, is_wanted, sha256
from trialid.ingest.nmea0183 import nmea0183_recorded, nmea0183_steps
from trialid.ingest.nmea2000 import nmea2000_messages
from trialid.recording import Channel, Recording

LINE = re.compile(rb"\d{12,14};[A-Za-z];")
OTHERS = re.compile(rb"^(\d{12,14});([A-MO-Za-z]);([^\r\n]*)", re.MULTILINE)
STAMP = re.compile(rb"^(\d{12,14});", re.MULTILINE)
MESSAGE = re.compile(rb"[^,]*,\d,(\d{1,6}),(\d{1,3}),\d{1,3},(\d{1,4}),([0-9A-Fa-f,]*)\s*")
SENTENCES = re.compile(rb"^\d{12,14};N;[^\r\n]*(?:\r?\n|$)", re.MULTILINE)
MILLISECOND = 1_000_000
STAMPS = "line stamps"
UNSAFE = re.compile(r"[^\w.+#-]+")

Side = Literal["starboard", "port"]
PATHS: dict[str, tuple[str | None, str | None, Side | None]] = {
    "steering.rudderAngle": ("rad", "delta", "starboard"),
    "steering.rudderAngleTarget": ("rad", "delta_order", "starboard"),
    "steering.autopilot.target.rudderAngle": ("rad", "delta_order", "starboard"),
    "navigation.rateOfTurn": ("rad/s", "r", "starboard"),
    "navigation.headingTrue": ("rad", "psi", "starboard"),
    "navigation.headingMagnetic": ("rad", "psi", "starboard"),
    "navigation.headingCompass": ("rad", "psi", "starboard"),
    "navigation.attitude:roll": ("rad", "phi", "starboard"),
    "navigation.attitude:pitch": ("rad", None, None),
    "navigation.attitude:yaw": ("rad", None, None),
    "navigation.magneticVariation": ("rad", None, None),
    "navigation.speedThroughWater": ("m/s", "u", None),
    "navigation.speedThroughWaterLongitudinal": ("m/s", "u", None),
    "navigation.speedThroughWaterTransverse": ("m/s", "v", "starboard"),
    "navigation.speedOverGround": ("m/s", None, None),
    "navigation.courseOverGroundTrue": ("rad", None, None),
    "navigation.courseOverGroundMagnetic": ("rad", None, None),
    "navigation.position:latitude": ("deg", None, None),
    "navigation.position:longitude": ("deg", None, None),
    "navigation.leewayAngle": ("rad", None, None),
    "environment.wind.angleApparent": ("rad", "gamma_aw", "starboard"),
    "environment.wind.speedApparent": ("m/s", "V_aw", None),
    "environment.wind.angleTrueWater": ("rad", None, None),
    "environment.wind.speedTrue": ("m/s", None, None),
    "environment.depth.belowTransducer": ("m", None, None),
    "environment.depth.belowKeel": ("m", None, None),
    "environment.depth.belowSurface": ("m", None, None),
}
"""Unit, quantity and positive side of the paths of Signal K 1.8; an attitude has three fields.
Angles are radians, but for positions."""
REVOLUTIONS = re.compile(r"propulsion\.[^.]+\.revolutions")


@dataclass
class Deltas:
    """Samples of Signal K deltas by channel: stamps, values and the path they are of."""

    t: dict[str, list[int]] = field(default_factory=dict)
    y: dict[str, list[float]] = field(default_factory=dict)
    path: dict[str, str] = field(default_factory=dict)
    damaged: int = 0


@dataclass
class Messages:
    """Whole NMEA 2000 messages."""

    t: list[int] = field(default_factory=list)
    pgn: list[int] = field(default_factory=list)
    source: list[int] = field(default_factory=list)
    payload: list[bytes] = field(default_factory=list)
    damaged: int = 0


def recognises(head: bytes) -> bool:
    """Most whole lines are a time, a letter and something."""
    lines = [line for line in head.split(b"\n") if line.strip()]
    lines = lines[:-1] if len(lines) > 1 and not head.endswith(b"\n") else lines
    ours = [line for line in lines if LINE.match(line)]
    return b"\0" not in head and len(ours) > 0 and 2 * len(ours) >= len(lines)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; lines that cannot be read are left out and counted.

    Raises LogError when not one line can be read.
    """
    del aids
    deltas, messages, kinds = Deltas(), Messages(), Counter[str]()
    for block in nmea0183_recorded.blocks(path):
        _take(block, wanted, deltas, messages, kinds)
    if not kinds.total():
        raise LogError(f"{path}: no line of the form time;letter;data; copy the log again")
    found, remarks = _sentences(path, wanted, len(+kinds) > 1) if kinds["N"] else ({}, [])
    more, remarks_of_bus = _of_bus(messages, wanted)
    found |= more | _of_deltas(deltas)
    if not found and wanted is None and not remarks:
        raise LogError(f"{path}: none of its {kinds.total()} lines can be read; copy it again")
    remarks += [*remarks_of_bus, *_losses(kinds, messages, deltas)]
    return Recording(path, ADAPTER.name, sha256(path), found, tuple(remarks))


def _damaged_stamps(block: bytes) -> frozenset[bytes]:
    """Stamps out of step with those of the lines around them: nothing else protects them."""
    stamps = STAMP.findall(block)
    t = np.array(stamps, "S14").astype(np.int64)
    odd = nmea0183_steps.out_of_step(t * MILLISECOND)
    return frozenset(stamps[row] for row in np.flatnonzero(odd))


def _take(
    block: bytes, wanted: Wanted, deltas: Deltas, messages: Messages, kinds: Counter[str]
) -> None:
    others = OTHERS.findall(block)
    odd = _damaged_stamps(block) if others else frozenset[bytes]()
    kinds["N"] += block.count(b";N;")
    for stamp, letter, payload in others:
        kinds[letter.decode()] += 1
        if stamp in odd:
            kinds["of a damaged time"] += 1
        elif letter == b"A":
            _message(int(stamp) * MILLISECOND, payload, messages)
        elif letter == b"I":
            _delta(int(stamp) * MILLISECOND, payload, wanted, deltas)


def _sentences(path: Path, wanted: Wanted, mixed: bool) -> tuple[dict[str, Channel], list[str]]:
    """Channels of the lines N, read as an NMEA 0183 log of its own; `mixed`: not all are."""

    def parts() -> Iterator[bytes]:
        for block in nmea0183_recorded.blocks(path):
            yield b"".join(SENTENCES.findall(block)) if mixed else block

    try:
        return nmea0183_recorded.channels(path, parts, wanted, None)
    except LogError as error:
        return {}, [f"NMEA 0183 left out: {str(error).partition(': ')[2]}"]


def _message(t: int, payload: bytes, messages: Messages) -> None:
    found = MESSAGE.fullmatch(payload)
    if found is None:
        messages.damaged += 1
        return
    pgn, source, length = int(found[1]), int(found[2]), int(found[3])
    octets = found[4].split(b",")
    if len(octets) != length or source > 255 or any(len(octet) != 2 for octet in octets):
        messages.damaged += 1
        return
    if pgn in nmea2000_messages.NEEDED:
        messages.t.append(t)
        messages.pgn.append(pgn)
        messages.source.append(source)
        messages.payload.append(bytes.fromhex(b"".join(octets).decode()))


def _of_bus(messages: Messages, wanted: Wanted) -> tuple[dict[str, Channel], list[str]]:
    if not messages.t:
        return {}, []
    return nmea2000_messages.channels(
        np.array(messages.t, np.int64),
        np.array(messages.pgn, np.int64),
        np.array(messages.source, np.int64),
        messages.payload,
        STAMPS,
        wanted,
    )


def _delta(t: int, payload: bytes, wanted: Wanted, deltas: Deltas) -> None:
    """One delta: updates of a source, each of several values."""
    try:
        delta = json.loads(payload)
    except (ValueError, RecursionError):
        deltas.damaged += 1
        return
    for update in _listed(delta, "updates"):
        source = _source(update)
        for value in _listed(update, "values"):
            path = value.get("path")
            if isinstance(path, str) and path:
                _value(t, path, source, value.get("value"), wanted, deltas)


def _listed(value: Any, name: str) -> list[dict[str, Any]]:
    found = value.get(name) if isinstance(value, dict) else None
    return [one for one in found if isinstance(one, dict)] if isinstance(found, list) else []


def _source(update: dict[str, Any]) -> str:
    """The reference of a source, or what the source itself says of where it comes from."""
    reference, source = update.get("$source"), update.get("source")
    if not isinstance(reference, str) and isinstance(source, dict):
        parts = [source.get(key) for key in ("label", "src", "talker")]
        reference = ".".join(str(part) for part in parts if part)
    return UNSAFE.sub("_", reference).strip("_") if isinstance(reference, str) else ""


def _value(t: int, path: str, source: str, value: Any, wanted: Wanted, deltas: Deltas) -> None:
    if isinstance(value, dict):
        for name, part in value.items():
            if not isinstance(part, dict):
                _sample(
                    t=t,
                    path=path,
                    source=source,
                    name=name,
                    value=part,
                    wanted=wanted,
                    deltas=deltas,
                )
    else:
        _sample(
            t=t, path=path, source=source, name="value", value=value, wanted=wanted, deltas=deltas
        )


def _sample(
    t: int, path: str, source: str, name: str, value: Any, wanted: Wanted, deltas: Deltas
) -> None:
    """One number; null is a number that is not available."""
    if isinstance(value, bool) or not (value is None or isinstance(value, int | float)):
        return
    channel = "/".join(part for part in (path, source) if part) + f":{name}"
    if is_wanted(channel, wanted):
        try:
            number = float("nan") if value is None else float(value)
        except OverflowError:
            number = float("nan")
        deltas.t.setdefault(channel, []).append(t)
        deltas.y.setdefault(channel, []).append(number)
        deltas.path[channel] = path if name == "value" else f"{path}:{name}"


def _of_deltas(deltas: Deltas) -> dict[str, Channel]:
    found = {}
    for name, path in deltas.path.items():
        known = ("rps", None, None) if REVOLUTIONS.fullmatch(path) else (None, None, None)
        unit, quantity, side = PATHS.get(path, known)
        t, y = np.array(deltas.t[name], np.int64), np.array(deltas.y[name], np.float64)
        if np.isfinite(y).any():
            words = f"Signal K path {path.replace(':', ', ')}"
            found[name] = Channel(
                name=name,
                t=t,
                y=y,
                unit=unit,
                clock=STAMPS,
                description=words,
                quantity=quantity,
                positive=side,
            )
    return found


def _losses(kinds: Counter[str], messages: Messages, deltas: Deltas) -> list[str]:
    remarks = []
    for count, what in ((messages.damaged, "NMEA 2000 messages"), (deltas.damaged, "deltas")):
        if count:
            remarks.append(f"{count} lines that should be {what} cannot be read, left out")
    others = {kind: count for kind, count in sorted(kinds.items()) if kind not in "NAI" and count}
    if others:
        listed = ", ".join(
            f"{count} {kind if len(kind) > 1 else 'of kind ' + kind}"
            for kind, count in others.items()
        )
        remarks.append(f"lines left out: {listed}; kinds that are read: N, A, I")
    return remarks


ADAPTER = Adapter("signal k", recognises, read)
