"""NMEA 2000 messages to channels, in columns.

A channel is `message/source:field`, and `message/source/instance:field` where the message numbers
its devices: `rudder/11/255:position`. The source is the address of the sender. What a message holds
is in `nmea2000_pgns`, who sent it in `nmea2000_sources`. Messages are whole: the frames of a fast
packet are already joined (`nmea2000_frames`).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.adapter import Wanted, is_wanted
from trialid.ingest.nmea2000 import nmea2000_sources
from trialid.ingest.nmea2000.nmea2000_pgns import LAYOUTS, POSITIONS, Field, Layout, Reference
from trialid.recording import Channel

Ints = NDArray[np.int64]

UNAVAILABLE = 3
"""The highest codes of a number: not available, out of range, reserved."""

SYSTEM_TIME = 126992
DAY_NS = 86_400_000_000_000
LISTED = 6
"""Channels without a value a remark names at most."""

APPARENT = {"apparent_speed": "V_aw", "apparent_angle": "gamma_aw"}
"""The wind of a message is a quantity of the dictionary only when it is the apparent one."""

FAST = frozenset(pgn for pgn, layout in LAYOUTS.items() if layout.fast)
NEEDED = frozenset(LAYOUTS) | {nmea2000_sources.ADDRESS_CLAIM, SYSTEM_TIME}
"""Parameter groups `channels` makes use of; a reader may drop all others."""


@dataclass(frozen=True)
class Payloads:
    """Bytes of N messages in one buffer: message i is `buffer[start[i] : start[i] + length[i]]`."""

    buffer: NDArray[np.uint8]
    start: Ints
    length: Ints

    def __len__(self) -> int:
        return len(self.start)

    def number(self, rows: Ints, at: int, size: int) -> NDArray[np.uint64]:
        """Little endian number from byte `at` of these messages; they must be long enough."""
        first = self.start[rows] + at
        value = np.zeros(len(rows), np.uint64)
        for i in range(size):
            value |= self.buffer[first + i].astype(np.uint64) << np.uint64(8 * i)
        return value


@dataclass(frozen=True)
class Messages:
    """Whole messages in the order of the log: stamps [ns] and parameter groups, (N,)."""

    t: Ints
    pgn: Ints
    senders: nmea2000_sources.Senders
    payloads: Payloads


@dataclass
class Found:
    """What a reading gathers: channels, and what there is to say about them."""

    clock: str
    wanted: Wanted
    channels: dict[str, Channel] = field(default_factory=dict)
    silent: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)


def pack_payloads(payloads: Sequence[bytes] | NDArray[np.uint8] | Payloads) -> Payloads:
    """Payloads as texts of bytes, or as an (N, 8) table, in one buffer."""
    if isinstance(payloads, Payloads):
        return payloads
    if isinstance(payloads, np.ndarray):
        count, width = payloads.shape
        flat = np.ascontiguousarray(payloads, np.uint8).reshape(-1)
        return Payloads(flat, np.arange(count) * width, np.full(count, width))
    length = np.fromiter(map(len, payloads), np.int64, len(payloads))
    return Payloads(np.frombuffer(b"".join(payloads), np.uint8), np.cumsum(length) - length, length)


def channels(
    t: Ints,
    pgn: Ints,
    source: Ints,
    payloads: Sequence[bytes] | NDArray[np.uint8] | Payloads,
    clock: str,
    wanted: Wanted = None,
    buses: Sequence[str] = (),
) -> tuple[dict[str, Channel], list[str]]:
    """Channels of whole messages, and remarks on what was noticed.

    Parameters
    ----------
    t
        Stamps [ns]; (N,).
    pgn, source
        Parameter group and address of the sender; (N,). With several buses the source is the
        index of the bus times 256 plus the address.
    payloads
        Bytes of the messages, each as long as it is: N of them, or a table (N, 8).
    clock
        Words for `Channel.clock`.
    wanted
        Channel names or their beginnings; None for all.
    buses
        Names of the buses where there are several: sources become `can1.11`.

    A channel that holds not one value is left out and named in a remark. A message that ends before
    a field gives no sample of it, and is counted.
    """
    data = pack_payloads(payloads)
    claims = np.flatnonzero((pgn == nmea2000_sources.ADDRESS_CLAIM) & (data.length >= 8))
    names = data.number(claims, 0, 8).view(np.int64)
    used = np.isin(pgn, list(LAYOUTS))
    senders = nmea2000_sources.name_sources(source, claims, names, used, buses)
    messages = Messages(t, pgn, senders, data)
    found = Found(clock, wanted, remarks=list(senders.remarks))
    for number, layout in LAYOUTS.items():
        rows = np.flatnonzero(pgn == number)
        if len(rows):
            _of_group(number, layout, messages, rows, found)
    if found.silent:
        more = f" and {len(found.silent) - LISTED} more" if len(found.silent) > LISTED else ""
        silent = ", ".join(found.silent[:LISTED]) + more
        found.remarks.append(f"`not available` throughout, left out: {silent}")
    found.remarks.extend(_system_time(messages))
    return found.channels, found.remarks


def _of_group(number: int, layout: Layout, messages: Messages, rows: Ints, found: Found) -> None:
    """The channels of one parameter group."""
    senders, payloads = messages.senders, messages.payloads
    full = max(one.end for one in layout.fields)
    short = int(np.sum(payloads.length[rows] < full))
    if short and _may_be(layout.name, found.wanted):
        words = f"{short} of {len(rows)} messages end early, the fields they lack are left out"
        found.remarks.append(f"{layout.name} (PGN {number}): {words}")
    for sender, some in _by_label(senders, rows):
        place = f"{layout.name}/{senders.labels[sender]}"
        if not _may_be(place, found.wanted):
            continue
        told = f"PGN {number} {layout.words}, source {senders.devices[sender]}"
        for instance, few in _instances(layout, payloads, some):
            if instance is None:
                _of_sender(layout, place, told, messages, few, found)
            else:
                known = layout.instances.get(instance)
                words = f"{told}, instance {instance}" + (f" ({known})" if known else "")
                _of_sender(layout, f"{place}/{instance}", words, messages, few, found)


def _of_sender(
    layout: Layout, place: str, told: str, messages: Messages, rows: Ints, found: Found
) -> None:
    """The channels of one device, or one instance of it."""
    for one in layout.fields:
        for name, words, some in _referred(one, layout, messages.payloads, rows):
            channel = f"{place}:{name}"
            if not is_wanted(channel, found.wanted):
                continue
            y = _numbers(one, messages.payloads, some)
            if layout.no_fix is not None and one.name in POSITIONS:
                none = _no_fix(layout.no_fix, messages.payloads, some) & np.isfinite(y)
                y[none] = np.nan
                poor = f"{channel}: {none.sum()} of {len(y)} are no fix by satellites, left out"
                found.remarks += [poor] if none.any() else []
            if np.isnan(y).all():
                found.silent.append(channel)
                continue
            found.channels[channel] = Channel(
                name=channel,
                t=messages.t[some],
                y=y,
                unit=one.unit,
                clock=found.clock,
                description=f"{told}, {words}",
                quantity=APPARENT.get(name, one.quantity),
                positive=one.positive,
            )


def _by_label(senders: nmea2000_sources.Senders, rows: Ints) -> Iterator[tuple[int, Ints]]:
    """Rows by their sender; a device that moved is one sender."""
    one_of = [senders.labels.index(label) for label in senders.labels]
    yield from _split(np.array(one_of)[senders.of[rows]], rows)


def _may_be(start: str, wanted: Wanted) -> bool:
    """True when a channel whose name begins so may be wanted."""
    return is_wanted(start, wanted) or any(want.startswith(start) for want in wanted or ())


def _split(key: Ints, rows: Ints) -> Iterator[tuple[int, Ints]]:
    """Rows by the value of their key, each in the order of the log."""
    values = np.unique(key)
    for value in values.tolist():
        yield value, rows if len(values) == 1 else rows[key == value]


def _instances(layout: Layout, payloads: Payloads, rows: Ints) -> Iterator[tuple[int | None, Ints]]:
    if layout.instance is None:
        yield None, rows
        return
    long = rows[payloads.length[rows] > layout.instance]
    yield from _split(payloads.number(long, layout.instance, 1).astype(np.int64), long)


def _referred(
    one: Field, layout: Layout, payloads: Payloads, rows: Ints
) -> Iterator[tuple[str, str, Ints]]:
    """Name and words of a field, and the messages that hold it, by the reference they state."""
    rows = rows[payloads.length[rows] >= one.end]
    if "{}" not in one.name or layout.reference is None:
        yield one.name, one.words, rows
        return
    reference = layout.reference
    rows = rows[payloads.length[rows] > reference.at]
    code = payloads.number(rows, reference.at, 1).astype(np.int64) >> reference.shift
    for value, some in _split(code & reference.mask, rows):
        name = reference.names.get(value, f"reference{value}")
        words = name.replace("_", " ").replace("reference", "unknown reference ")
        yield one.name.format(name), one.words.format(words), some


def _no_fix(told: Reference, payloads: Payloads, rows: Ints) -> NDArray[np.bool_]:
    """Where a message says that its position is none by satellites; one cut short says nothing."""
    long = payloads.length[rows] > told.at
    code = np.full(len(rows), told.mask)
    code[long] = payloads.number(rows[long], told.at, 1).astype(np.int64) >> told.shift & told.mask
    return np.isin(code, list(told.names))


def _numbers(one: Field, payloads: Payloads, rows: Ints) -> NDArray[np.float64]:
    """Physical numbers; NaN for codes that say there is none, and past the limit."""
    raw = payloads.number(rows, one.at, one.size)
    bits = 8 * one.size
    if one.bits:
        raw &= np.uint64(2**one.bits - 1)
        missing = raw == 2**one.bits - 1
        y = raw.astype(np.float64) * one.step
    elif one.kind[0] == "u":
        missing = raw > np.uint64(2**bits - 1 - UNAVAILABLE)
        y = raw.astype(np.float64) * one.step
    else:
        signed = (raw << np.uint64(64 - bits)).view(np.int64) >> np.int64(64 - bits)
        missing = signed > 2 ** (bits - 1) - 1 - UNAVAILABLE
        y = signed.astype(np.float64) * one.step
    y[missing | (np.abs(y) > one.limit + one.step / 2)] = np.nan
    return y


def _system_time(messages: Messages) -> Iterator[str]:
    """How far the bus's own UTC lies from the stamps, for each sender that tells it."""
    payloads = messages.payloads
    rows = np.flatnonzero((messages.pgn == SYSTEM_TIME) & (payloads.length >= 8))
    for sender, some in _by_label(messages.senders, rows):
        days = payloads.number(some, 2, 2).astype(np.int64)
        tick = payloads.number(some, 4, 4).astype(np.int64)
        stated = (days <= 0xFFFF - UNAVAILABLE) & (tick < 864_010_000)
        if stated.any():
            utc = days[stated] * DAY_NS + tick[stated] * 100_000
            ahead = (utc - messages.t[some[stated]]) / 1e9
            middle, spread = np.median(ahead), np.ptp(ahead)
            side = "ahead of" if middle >= 0 else "behind"
            yield (
                f"system time (PGN 126992) of source {messages.senders.labels[sender]} is "
                f"{abs(middle):.3f} s {side} the stamps (median of {len(ahead)}, "
                f"spread {spread:.3f} s)"
            )
