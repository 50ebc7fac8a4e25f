"""Remarks on a dataflash log: what was lost, its servos, parameters and modes, its date."""

from collections.abc import Iterator, Mapping
from datetime import timedelta

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.mavlink import dataflash_walk, servo_deflection, vehicle_modes
from trialid.ingest.mavlink.dataflash_messages import Log, parameters
from trialid.ingest.mavlink.dataflash_walk import Gathered
from trialid.ingest.times import gps_time
from trialid.recording import Channel


def damage(gathered: Gathered) -> Iterator[str]:
    """What was lost, where, and how much was read nevertheless."""
    holes, seen = gathered.holes, int(gathered.counts.sum())
    if not holes:
        return
    lost = sum(hole.size for hole in holes)
    about = seen + max(1, round(lost * seen / max(gathered.size - lost, 1)))
    spans = [_span(hole) for hole in holes[:3]]
    more = f" and at {len(holes) - 3} places more" if len(holes) > 3 else ""
    yield (
        f"recovered {seen} of about {about} messages, lost {', '.join(spans)}{more} "
        f"({lost} bytes are no message, from byte {holes[0].at}); messages carry no checksum: "
        "damage inside one is not seen"
    )


def _span(hole: dataflash_walk.Hole) -> str:
    ends = ["?" if time is None else f"{time / 1e6:.2f}" for time in (hole.before, hole.after)]
    return f"{ends[0]}-{ends[1]} s"


def servos_and_modes(
    log: Log, steering: Mapping[str, Channel], outputs: dict[int, str]
) -> Iterator[str]:
    """Remarks on servos, parameters, modes and arming."""
    known = parameters(log)
    yield from servo_deflection.remarks(known, outputs)
    for name, channel in steering.items():
        none = int(np.isnan(channel.y).sum())
        if none:
            yield f"{name}: {none} of {len(channel.y)} samples without an output"
    yield from servo_deflection.changes(known)
    for t, states in _states(log, "MODE", "ModeNum"):
        yield from vehicle_modes.modes(t, states, _rover(log))
    for t, states in _states(log, "ARM", "ArmState"):
        yield from vehicle_modes.arming_remark(t, states != 0)


def _states(
    log: Log, message: str, column: str
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Times [ns] and values of one column, where it is logged; (N,) both."""
    number = log.number(message)
    values = log.table(message).get(column)
    if number is not None and log.known[number].clock and values is not None:
        t, good = log.times(number)
        yield t[good], values[good].astype(np.int64)


def _rover(log: Log) -> bool:
    texts = log.table("MSG").get("Message", np.empty(0, "S1"))
    return any(b"Rover" in text for text in texts[:1000].tolist())


def start_date(log: Log) -> Iterator[str]:
    """A remark on the date, by the first GPS message with a fix."""
    gps, number = log.table("GPS"), log.number("GPS")
    if number is None or not log.known[number].clock or not {"Status", "GMS", "GWk"} <= gps.keys():
        yield "no GPS time in the log: times are since boot, the date is not known"
        return
    t, good = log.times(number)
    fixed = np.flatnonzero((gps["Status"] >= 3) & (gps["GWk"] > 0) & good)
    if not len(fixed):
        yield "no GPS fix in the log: times are since boot, the date is not known"
        return
    first = fixed[0]
    since = timedelta(microseconds=int(t[first]) // 1000)
    start = gps_time.utc(int(gps["GWk"][first]), int(gps["GMS"][first])) - since
    yield gps_time.words(start, "the first GPS fix")
