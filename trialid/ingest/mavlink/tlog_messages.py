"""The messages of a telemetry log by sender and kind, each with when it was sent."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.linked_records import Places
from trialid.ingest.mavlink import servo_deflection, tlog_clock, tlog_frames
from trialid.ingest.mavlink.mavlink_dialect import Definition

REPEATED = frozenset({"SERVO_OUTPUT_RAW", "PARAM_VALUE", "HEARTBEAT"})
"""Messages that are looked at more than once: for channels, for rudder servos and for remarks."""
NO_FRAMES = np.zeros(0, np.int64)


@dataclass(frozen=True)
class Sender:
    """One component of a system: its clock and its parameters."""

    system: int
    component: int
    boot: tlog_clock.Boot | None

    @property
    def name(self) -> str:
        """How channels and remarks call it."""
        return f"{self.system}/{self.component}"

    def starts(self, rows: Places) -> Places:
        """Which of its starts each of these frames is of; (N,)."""
        if self.boot is None or not len(self.boot.first):
            return np.zeros(len(rows), np.int64)
        return self.boot.start(rows)


Sources = Mapping[tuple[int, int, int], Places]
"""Indices of frames by system, component and message."""


@dataclass(frozen=True)
class Messages:
    """N messages of one kind from one sender, in the order of the log.

    `rows` are their indices among the frames, `table` their payloads, `received` when the recorder
    got them [ns]; (N,) each.
    """

    definition: Definition
    rows: Places
    table: NDArray[np.void]
    received: NDArray[np.int64]
    sent: tlog_clock.Sent


@dataclass(frozen=True)
class Log:
    """The frames of a file, the definitions of their messages, and who sent them."""

    found: tlog_frames.Found
    known: Mapping[int, Definition]
    sources: Sources
    senders: tuple[Sender, ...]
    looked_at: dict[tuple[int, int, int], Messages] = dataclasses.field(default_factory=dict)

    def messages(self, sender: Sender, number: int) -> Messages:
        """One sender's messages of one kind; those that are asked for repeatedly are kept."""
        key = sender.system, sender.component, number
        if key in self.looked_at:
            return self.looked_at[key]
        one, rows = self.known[number], self.sources.get(key, NO_FRAMES)
        table, received = tlog_frames.payloads(self.found, rows, one), self.found.stamp[rows]
        raw = table[one.clock] if one.clock else None
        sent = tlog_clock.send_times(one.clock, raw, rows, received, sender.boot)
        made = Messages(one, rows, table, received, sent)
        if one.name in REPEATED:
            self.looked_at[key] = made
        return made

    def number(self, name: str) -> int:
        """Number of a message by its name."""
        return next(number for number, one in self.known.items() if one.name == name)


def log(found: tlog_frames.Found, known: Mapping[int, Definition]) -> Log:
    """The messages of the frames of a log."""
    sources = tlog_frames.by_message(found.frames)
    return Log(found, known, sources, _senders(found, known, sources))


def _senders(
    found: tlog_frames.Found, known: Mapping[int, Definition], sources: Sources
) -> tuple[Sender, ...]:
    pairs = dict.fromkeys((system, component) for system, component, _ in sources)
    return tuple(Sender(*one, _boot(found, known, sources, one)) for one in pairs)


def _boot(
    found: tlog_frames.Found,
    known: Mapping[int, Definition],
    sources: Sources,
    source: tuple[int, int],
) -> tlog_clock.Boot | None:
    """The clock of a sender by its most frequent message that carries time_boot_ms."""
    mine = {key[2]: rows for key, rows in sources.items() if key[:2] == source}
    for number, rows in sorted(mine.items(), key=lambda item: -len(item[1])):
        one = known[number]
        if one.clock == "time_boot_ms":
            raw = tlog_frames.payloads(found, rows, one)["time_boot_ms"]
            boot = tlog_clock.boot(f"{one.name} time_boot_ms", rows, found.stamp[rows], raw)
            if boot is not None:
                return boot
    return None


def parameters(log: Log, sender: Sender, start: int) -> servo_deflection.Parameters:
    """Parameters as they were during one start of the sender.

    What was said in an earlier start held from its beginning on; what is only said later is the
    best that is known.
    """
    said = log.messages(sender, log.number("PARAM_VALUE"))
    starts, table = sender.starts(said.rows), said.table
    t = np.where(
        starts < start,
        servo_deflection.EVER,
        np.where(starts > start, servo_deflection.NEVER, said.sent.t),
    )
    names = [name.decode("latin-1") for name in table["param_id"].tolist()]
    return servo_deflection.parameters(names, t, table["param_value"].astype(np.float64))
