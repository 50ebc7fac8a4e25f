"""Signal K deltas in JSON, a line each, as a server sends them or has them in its log.

Channels are `path/source:field`: `steering.rudderAngle/n2k.11:value`,
`navigation.attitude/imu:roll`. Numbers of Signal K are SI. A log of deltas alone has the stamps of
their sources.
"""

import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from trialid.errors import LogError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, is_wanted, sha256
from trialid.recording import Channel, Recording

UPDATES = re.compile(rb'"updates"\s*+:\s*+\[')
STAMP = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(?:\.\d{1,9})?Z")
STAMPS = "stamps of the deltas' sources"
LONGEST = 2_000_000
"""Bytes of a line that is still a delta."""
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


def take(payload: bytes, wanted: Wanted, deltas: Deltas, t: int | None = None) -> None:
    """One delta: updates of a source, each of several values, with their own stamp but for `t`."""
    try:
        delta = json.loads(payload) if len(payload) < LONGEST else None
    except (ValueError, RecursionError):
        deltas.damaged += 1
        return
    deltas.damaged += delta is None
    for update in _listed(delta, "updates"):
        stamp = _stamp(update) if t is None else t
        if stamp is None:
            deltas.damaged += 1
            continue
        source = _source(update)
        for value in _listed(update, "values"):
            path = value.get("path")
            if isinstance(path, str) and path:
                _value(stamp, path, source, value.get("value"), wanted, deltas)


def _stamp(update: dict[str, Any]) -> int | None:
    """When its source says it was [ns]; None where that is no time of UTC."""
    told = update.get("timestamp")
    if not isinstance(told, str) or STAMP.fullmatch(told) is None:
        return None
    try:
        return int(np.datetime64(told[:-1], "ns").astype(np.int64))
    except ValueError:
        return None


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


def channels_of(deltas: Deltas, clock: str) -> dict[str, Channel]:
    """What was taken, by channel; `clock` says in words whose stamps they have."""
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
                clock=clock,
                description=words,
                quantity=quantity,
                positive=side,
            )
    return found


def recognises(start: bytes) -> bool:
    """A first line that is a delta."""
    first = start.lstrip().partition(b"\n")[0]
    return first.startswith(b"{") and UPDATES.search(first) is not None


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; lines that are no delta are left out and counted.

    Raises LogError when not one line can be read.
    """
    del aids
    deltas = Deltas()
    with path.open("rb") as file:
        for line in file:
            if text := line.strip():
                take(text, wanted, deltas)
    found = channels_of(deltas, STAMPS)
    if not found and wanted is None:
        raise LogError(f"{path}: no delta with a number and a `timestamp` of its own, in UTC")
    lost = f"{deltas.damaged} deltas or updates cannot be read, or have no stamp; left out"
    remarks = (lost,) if deltas.damaged else ()
    return Recording(path, ADAPTER.name, sha256(path), found, remarks)


ADAPTER = Adapter("signal k deltas", recognises, read)
