"""PX4 ULog: every number of every topic, by pyulog.

A channel is `topic:field`, `topic/1:field` for the second instance of a topic. Stamps count from
the start of the autopilot: those of the measurement where a topic has them, else of the message.
Quaternions `q[0]` ... are called `q.w`, `q.x`, `q.y`, `q.z`; the axes are x forward, y to
starboard, z down, so that turns to starboard are positive.
"""

import contextlib
import io
import struct
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError, reason_of
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, is_wanted, sha256
from trialid.ingest.packages import require
from trialid.recording import Channel, Recording

MAGIC: Final = b"ULog\x01\x12\x35"
NAME: Final = "px4 ulog"
LATEST_US: Final = 1 << 53
MEANINGS: Final[dict[tuple[str, str], tuple[str, str]]] = {
    ("vehicle_angular_velocity", "xyz[0]"): ("rad/s", "p"),
    ("vehicle_angular_velocity", "xyz[2]"): ("rad/s", "r"),
    ("sensor_combined", "gyro_rad[0]"): ("rad/s", "p"),
    ("sensor_combined", "gyro_rad[2]"): ("rad/s", "r"),
    ("vehicle_local_position", "heading"): ("rad", "psi"),
}
"""Unit and quantity that the definitions of PX4's messages state; all count to starboard."""
UNITS: Final = {
    ("vehicle_local_position", "vx"): "m/s", ("vehicle_local_position", "vy"): "m/s",
    ("vehicle_gps_position", "vel_m_s"): "m/s", ("sensor_gps", "vel_m_s"): "m/s",
    ("vehicle_gps_position", "cog_rad"): "rad", ("sensor_gps", "cog_rad"): "rad",
    ("vehicle_gps_position", "latitude_deg"): "deg", ("sensor_gps", "latitude_deg"): "deg",
    ("vehicle_gps_position", "longitude_deg"): "deg", ("sensor_gps", "longitude_deg"): "deg",
    ("vehicle_global_position", "lat"): "deg", ("vehicle_global_position", "lon"): "deg",
    ("vehicle_angular_velocity", "xyz[1]"): "rad/s", ("sensor_combined", "gyro_rad[1]"): "rad/s",
}  # fmt: skip
QUATERNION: Final = {f"q[{i}]": f"q.{axis}" for i, axis in enumerate("wxyz")}
STAMPS: Final = frozenset(("timestamp", "timestamp_sample"))


def recognises(head: bytes) -> bool:
    """The magic bytes of ULog."""
    return head.startswith(MAGIC)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; LogError for a log of which nothing can be read."""
    del aids
    log = _log(path)
    many = Counter(one.name for one in log.data_list)
    channels: dict[str, Channel] = {}
    remarks = list(_remarks(log))
    for topic in sorted(log.data_list, key=lambda one: (one.name, one.multi_id)):
        place = f"{topic.name}/{topic.multi_id}" if many[topic.name] > 1 else topic.name
        for channel in _channels(topic, place, wanted, remarks):
            channels.setdefault(channel.name, channel)
    if not log.data_list:
        raise LogError(f"{path}: is a ULog without a message; the recorder wrote none")
    return Recording(path, NAME, sha256(path), channels, tuple(remarks))


def _log(path: Path) -> Any:
    ulog = require("pyulog", path, "PX4 ULog", extra="px4")
    try:
        with contextlib.redirect_stdout(io.StringIO()), path.open("rb") as file:  # it prints
            return ulog.ULog(file)
    except (
        ulog.core.ULogException, ValueError, LookupError, TypeError, AttributeError,
        ArithmeticError, OSError, MemoryError, RecursionError, struct.error,
    ) as error:  # fmt: skip
        raise LogError(
            f"{path}: is no ULog that can be read ({reason_of(error)}); copy it again"
        ) from error


def _remarks(log: Any) -> Iterator[str]:
    if log.file_corruption:
        yield "parts of the log are damaged and left out"
    if log.dropouts:
        lost = sum(one.duration for one in log.dropouts) / 1000.0
        yield f"the logger dropped messages {len(log.dropouts)} times, {lost:.3g} s in all"


def _channels(topic: Any, place: str, wanted: Wanted, remarks: list[str]) -> Iterator[Channel]:
    """Every number of a topic."""
    if "timestamp" not in topic.data:
        remarks.append(f"{place}: left out, its messages have no stamp")
        return
    t, good, received, clock = _times(topic.data)
    if not good.all():
        remarks.append(f"{place}: {int(np.sum(~good))} messages without a usable stamp, left out")
    truths = {one.field_name for one in topic.field_data if one.type_str == "bool"}
    for field, values in topic.data.items():
        if field in truths:
            continue
        name = f"{place}:{QUATERNION.get(field, field)}"
        if field in STAMPS or values.dtype.kind not in "fiu" or not is_wanted(name, wanted):
            continue
        with np.errstate(invalid="ignore"):  # a NaN of 32 bits that warns, out of damage
            y = values[good].astype(np.float64)
        y[np.isinf(y)] = np.nan
        unit, quantity, positive = _meaning(topic.name, field)
        yield Channel(
            name=name,
            t=t,
            y=y,
            unit=unit,
            clock=clock,
            description=f"PX4 {topic.name} {field}",
            quantity=quantity,
            positive=positive,
            received=received,
        )


def _meaning(topic: str, field: str) -> tuple[str | None, str | None, Literal["starboard"] | None]:
    unit, quantity = MEANINGS.get((topic, field), (UNITS.get((topic, field)), None))
    return unit, quantity, "starboard" if quantity else None


def _times(
    data: dict[str, NDArray[Any]],
) -> tuple[NDArray[np.int64], NDArray[np.bool_], NDArray[np.int64] | None, str]:
    """Stamps [ns] of the messages that have one, which these are, and when they were sent."""
    sent = data["timestamp"]
    sample = data.get("timestamp_sample")
    if sample is None or not sample.any():
        good = sent < LATEST_US
        return _ns(sent[good]), good, None, "message stamp since start of the autopilot"
    good = (sample > 0) & (sample < LATEST_US) & (sent < LATEST_US)
    words = "sample stamp since start of the autopilot"
    return _ns(sample[good]), good, _ns(sent[good]), words


def _ns(micro: NDArray[Any]) -> NDArray[np.int64]:
    return micro.astype(np.int64) * 1000


ADAPTER = Adapter(NAME, recognises, read)
