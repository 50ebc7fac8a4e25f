"""When the messages of a telemetry log were sent: the boot clock of each sender.

The recorder's stamps are receive times, late by a link that jitters. Most messages carry the time
since the sender's start, in counters of 32 bits that wrap: microseconds do every 71.6 minutes,
milliseconds every 49.7 days. Which turn of the counter a message is of follows from the messages
around it, and so does the time of messages that carry none.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.linked_records import Places

TURN = 2**32
"""Counts after which a counter of 32 bits begins anew."""
MS, US = 1_000_000, 1_000
"""Nanoseconds."""
RESTART_NS = 5 * 10**9
"""A clock that falls back by more was started anew; messages that overtake each other do less."""
AROUND_NS = 600 * 10**9
"""Nothing is sent longer before or after the messages that show the clock; stamps can be broken."""
LASTING = 3
"""Messages that must show a restart: blocks of a log that were mixed up show one alike."""
CALENDAR_US = 10**14
"""Microseconds above this count from 1970: no autopilot runs for three years."""

MOST_COUNTS = 2**62 // US
"""Counts of microseconds that still fit 64 bits of nanoseconds."""

Times = NDArray[np.int64]


@dataclass(frozen=True)
class Boot:
    """The clock of one sender, as one kind of its messages shows it.

    Parameters
    ----------
    source
        The message and field it is from, in words.
    received
        Receive times of these messages, increasing within each start [ns]; (N,).
    sent
        Their times since the sender's start [ns]; (N,).
    first
        Index in the log of the first message after each start but the first; (starts - 1,).
    edges
        Where in `received` and `sent` each start begins and ends; (starts + 1,).
    """

    source: str
    received: Times
    sent: Times
    first: Places
    edges: Places

    def start(self, index: Places) -> Places:
        """Which start of the sender the messages at these indices of the log are of; (M,)."""
        return np.searchsorted(self.first, index, "right")

    def at(self, index: Places, received: Times) -> Times:
        """Time since the sender's start at which messages were sent, by their neighbours; (M,)."""
        if not len(self.first):
            return self._within(0, received)
        sent = np.empty(len(index), np.int64)
        starts = self.start(index)
        for start in np.unique(starts).tolist():
            rows = np.flatnonzero(starts == start)
            sent[rows] = self._within(start, received[rows])
        return sent

    def _within(self, start: int, received: Times) -> Times:
        """The same within one start."""
        part = slice(self.edges[start], self.edges[start + 1])
        late, known = self.received[part] - self.sent[part], self.received[part]
        since = np.interp(received - known[0], known - known[0], late - late[0])
        about = received - late[0] - np.rint(since).astype(np.int64)
        ends = self.sent[part].min() - AROUND_NS, self.sent[part].max() + AROUND_NS
        return np.clip(about, *ends)


def boot(source: str, index: Places, received: Times, raw: NDArray[np.uint32]) -> Boot | None:
    """The clock that messages at `index` of the log show; (N,) each, milliseconds.

    None when the counter stands still.
    """
    if len(raw) < 2 or (raw == raw[0]).all():
        return None
    sent = unwrap_ticks(raw.astype(np.int64), received, MS)
    restarts = _restarts(sent, received)
    edges = np.concatenate([[0], restarts, [len(sent)]]).astype(np.int64)
    order = np.arange(len(sent))
    for begin, end in itertools.pairwise(edges.tolist()):
        order[begin:end] = begin + np.argsort(received[begin:end], kind="stable")
    return Boot(source, received[order], sent[order], index[restarts], edges)


def _restarts(sent: Times, received: Times) -> Places:
    """Where the clock falls back, and stays there, though time went on for the receiver."""
    late = received - sent
    found: list[int] = []
    at = 0
    while True:
        back = sent[at + 1 :] < np.maximum.accumulate(sent[at:])[:-1] - RESTART_NS
        stays = np.flatnonzero(back)
        for k in range(LASTING):
            then = np.minimum(at + 1 + stays + k, len(sent) - 1)
            stays = stays[
                back[then - at - 1] & (late[then] - _latest(late, at, stays) > RESTART_NS)
            ]
        if not len(stays):
            return np.array(found, np.int64)
        at += 1 + int(stays[0])
        found.append(at)


def _latest(late: Times, at: int, stays: Places) -> Times:
    """How late the last messages before a fall were at most: one alone may be out of place."""
    before = [late[np.maximum(at + stays - k, at)] for k in range(LASTING)]
    return np.max(before, axis=0)


def unwrap_ticks(raw: Times, received: Times, unit: int) -> Times:
    """A counter of 32 bits without its turns, by the receive times in between [ns]; (N,)."""
    step = np.diff(raw)
    # Stamps can be broken: where a turn takes weeks the counter itself says that it began anew.
    elapsed = np.diff(received) / unit if unit == US else 0.0
    missing = np.rint((elapsed - step) / TURN).astype(np.int64)
    turns = np.concatenate([[0], np.cumsum(missing)])[: len(raw)]
    return (raw + turns * TURN) * unit


def closest_time(raw: Times, about: Times, unit: int) -> Times:
    """The time [ns] closest to `about` that a counter of 32 bits can mean by `raw`; (N,)."""
    turns = np.rint((about / unit - raw) / TURN).astype(np.int64)
    return (raw + np.maximum(turns, 0) * TURN) * unit


@dataclass(frozen=True)
class Sent:
    """Stamps of messages [ns], (N,), and which clock they are of in words.

    `own` is True when they are of another clock than the receiver's.
    """

    t: Times
    clock: str
    own: bool = True


def send_times(
    clock: str | None,
    raw: NDArray[np.unsignedinteger] | None,
    index: Places,
    received: Times,
    by: Boot | None,
) -> Sent:
    """When messages of one kind from one sender were sent; `raw` is their field `clock`; (N,)."""
    if clock is None or raw is None or not raw.any():
        return _by_neighbours(index, received, by)
    counts = np.minimum(raw.astype(np.uint64), MOST_COUNTS).astype(np.int64)
    if clock == "time_usec" and counts.max() > CALENDAR_US:
        return Sent(counts * US, "sender's clock time_usec, since 1970")
    unit = MS if clock == "time_boot_ms" else US
    if raw.dtype.itemsize == 8:
        return Sent(counts * unit, f"boot clock {clock}")
    if by is None:
        return Sent(unwrap_ticks(counts, received, unit), f"boot clock {clock}")
    return Sent(closest_time(counts, by.at(index, received), unit), f"boot clock {clock}")


def _by_neighbours(index: Places, received: Times, by: Boot | None) -> Sent:
    if by is None:
        return Sent(received, "receive time, the sender states none", own=False)
    return Sent(
        by.at(index, received), f"boot clock, interpolated between {by.source} by receive time"
    )
