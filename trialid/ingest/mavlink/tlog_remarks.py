"""Remarks on a telemetry log: what was lost, restarts, servos, parameters, modes and dates."""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta

import numpy as np

from trialid.ingest.mavlink import servo_deflection, tlog_clock, tlog_frames, vehicle_modes
from trialid.ingest.mavlink.tlog_messages import Log, Sender, parameters
from trialid.ingest.times import gps_time

ROVERS = (10, 11)
"""MAV_TYPE of a ground rover and of a surface boat."""
NO_AUTOPILOT = 8
ARMED = 128


def damage(log: Log) -> Iterator[str]:
    """What was lost and what was left out."""
    found = log.found
    seen = len(found.frames)
    if found.holes:
        lost = sum(end - begin for begin, end in found.holes)
        about = seen + max(1, round(lost * seen / max(len(found.data) - lost, 1)))
        spans = ", ".join(_span(found, *hole) for hole in found.holes[:3])
        more = f" and at {len(found.holes) - 3} places more" if len(found.holes) > 3 else ""
        yield f"recovered {seen} of about {about} messages, lost {spans}{more} (receive times)"
    if found.failed:
        names = ", ".join(sorted(log.known[number].name for number in found.failed))
        yield f"{sum(found.failed.values())} messages fail their checksum, left out: {names}"
    if found.unchecked:
        numbers = ", ".join(str(number) for number in list(found.unchecked)[:8])
        count = sum(found.unchecked.values())
        yield f"{count} messages of numbers no MAVLink dialect here knows, left out: {numbers}"


def _span(found: tlog_frames.Found, begin: int, end: int) -> str:
    """Receive times around a hole."""
    i = int(np.searchsorted(found.frames.at, begin))
    before = _date(int(found.stamp[i - 1])) if i else "the start"
    after = _date(int(found.stamp[i])) if i < len(found.stamp) else "the end"
    return f"{before}-{after.rpartition(' ')[2] if i else after}"


def _date(ns: int) -> str:
    date = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(
        microseconds=min(ns // 1000, tlog_frames.LATEST_US)
    )
    return date.strftime("%Y-%m-%d %H:%M:%S")


def sender_remarks(log: Log, sender: Sender, names: dict[int, str]) -> Iterator[str]:
    """Remarks on one sender: its clock, its servos and parameters, its modes."""
    for words in _words_of_sender(log, sender, names):
        yield f"{sender.name}: {words}"


def _words_of_sender(log: Log, sender: Sender, names: dict[int, str]) -> Iterator[str]:
    if sender.boot is not None and len(sender.boot.first):
        dates = ", ".join(_date(int(log.found.stamp[i])) for i in sender.boot.first[:3])
        yield (
            f"restarted {len(sender.boot.first)} times (received {dates}); the channels after a "
            "restart are called boot2 and so on"
        )
    beats = log.messages(sender, log.number("HEARTBEAT"))
    table = beats.table
    steers = table["autopilot"] != NO_AUTOPILOT
    if not steers.any():
        return
    known = parameters(log, sender, 0)
    yield from servo_deflection.remarks(known, names)
    yield from servo_deflection.changes(known)
    rover = bool(np.isin(table["type"], ROVERS).any())
    yield from vehicle_modes.modes(beats.sent.t, table["custom_mode"].astype(np.int64), rover)
    yield from vehicle_modes.arming_remark(beats.sent.t, (table["base_mode"] & ARMED) != 0)
    yield from _start_date(log, sender)


def _start_date(log: Log, sender: Sender) -> Iterator[str]:
    """A remark on the date, by the sender's own SYSTEM_TIME."""
    table = log.messages(sender, log.number("SYSTEM_TIME")).table
    dated = np.flatnonzero(table["time_unix_usec"] > tlog_clock.CALENDAR_US)
    if len(dated) and table["time_unix_usec"][dated[0]] < tlog_frames.LATEST_US:
        unix = int(table["time_unix_usec"][dated[0]])
        since = int(table["time_boot_ms"][dated[0]]) * 1000
        start = gps_time.UNIX + timedelta(microseconds=unix - since)
        yield gps_time.words(start, "SYSTEM_TIME")


def receive_dates(found: tlog_frames.Found) -> str:
    """A remark on when the first and the last message came in."""
    first, last = _date(int(found.stamp.min())), _date(int(found.stamp.max()))
    return f"received {first} to {last} by the clock of the ground station"
