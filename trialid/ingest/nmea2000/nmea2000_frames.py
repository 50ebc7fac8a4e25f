"""CAN frames to NMEA 2000 messages, in columns: identifiers taken apart, fast packets joined.

A message of up to 8 bytes is one frame. A longer one is a fast packet of up to 32 frames: byte 0 of
each is a counter (bits 5-7: which packet, bits 0-4: which frame), byte 1 of frame 0 the length of
the message; 6 bytes of it follow in frame 0 and 7 in each other.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.nmea2000.nmea2000_messages import FAST, NEEDED, Payloads

Ints = NDArray[np.int64]

PACKET_NS = 750_000_000
"""Frames of one packet do not lie further apart."""
LONGEST = 223
"""Bytes of a fast packet: 6 + 31 * 7."""

GROUPS = np.arange(1 << 18)
FAST_GROUP = np.isin(GROUPS, list(FAST))
SINGLE_GROUP = np.isin(GROUPS, list(NEEDED - FAST))
"""Which parameter groups are needed, and come in fast packets or in single frames."""


@dataclass(frozen=True)
class Assembled:
    """Whole messages of N' <= N frames, singles first; `lost` packets could not be joined."""

    t: Ints
    pgn: Ints
    source: Ints
    payloads: Payloads
    lost: int
    packets: int


def group_and_source(can_id: Ints) -> tuple[Ints, Ints]:
    """Parameter group and address of the sender in 29 bit identifiers; (N,) each.

    >>> group_and_source(np.array([0x09F10DCC, 0x18EEFF0B]))
    (array([127245,  60928]), array([204,  11]))
    """
    form, specific = (can_id >> 16) & 0xFF, (can_id >> 8) & 0xFF
    pgn = ((can_id >> 8) & 0x3FF00) + np.where(form < 240, 0, specific)
    return pgn, can_id & 0xFF


def assemble(
    t: Ints, can_id: Ints, table: NDArray[np.uint8], length: Ints, bus: Ints | int = 0
) -> Assembled:
    """Whole messages of the parameter groups that are read; all other frames are left aside.

    Parameters
    ----------
    t
        Stamps [ns]; a packet has that of its first frame; (N,).
    can_id
        29 bit identifiers; (N,).
    table, length
        Data bytes of the frames, (N, 8), of which `length` count, (N,).
    bus
        Index of the bus of each frame where there are several; (N,). The source of a message is
        its address plus 256 times the bus.
    """
    pgn, source = group_and_source(can_id)
    source = source + 256 * np.asarray(bus)
    single = np.flatnonzero(SINGLE_GROUP[pgn])
    rows = np.flatnonzero(FAST_GROUP[pgn] & (length > 1))
    order, payloads, packets = join_packets(t, pgn, source, rows, table, length)
    chosen = np.concatenate([single, order])
    buffer = np.concatenate([np.ascontiguousarray(table).reshape(-1), payloads.buffer])
    start = np.concatenate([single * 8, payloads.start + table.size])
    lengths = np.concatenate([length[single], payloads.length])
    whole = Payloads(buffer, start, lengths)
    lost = packets - len(order)
    return Assembled(t[chosen], pgn[chosen], source[chosen], whole, lost, packets)


def join_packets(
    t: Ints, pgn: Ints, source: Ints, rows: Ints, table: NDArray[np.uint8], length: Ints
) -> tuple[Ints, Payloads, int]:
    """First frame and payload of each complete packet among these frames, and how many there were.

    A sender ends one packet of a group before it begins the next, so the packets of one sender and
    group are runs of frames with one packet counter, whatever came between; their frames may be
    out of order. In a run that repeats a frame (a sender that does not count its packets) they are
    in order: where the frame counter does not rise the next packet begins.
    """
    sender = (pgn << 24) + source
    rows = rows[np.argsort(sender[rows], kind="stable")]
    counter = table[rows, 0].astype(np.int64)
    packet = _packets(t[rows], sender[rows], counter >> 5, counter & 31)
    count = int(packet[-1]) + 1 if len(packet) else 0
    order = np.argsort((packet << 5) + (counter & 31), kind="stable")
    packet, frame, rows = packet[order], (counter & 31)[order], rows[order]
    first = np.searchsorted(packet, np.arange(count))
    size = table[rows[first], 1].astype(np.int64)
    place = np.arange(len(packet)) - first[packet]
    left = size[packet] + 1 - 7 * place
    good = (frame == place) & (left > 0) & (length[rows] - 1 >= np.minimum(7, left))
    held, there = np.bincount(packet, None, count), np.bincount(packet, good, count)
    complete = (there == held) & (held == (size + 7) // 7) & (size <= LONGEST)
    flat = np.ascontiguousarray(table[rows, 1:]).reshape(-1)
    earliest = np.minimum.reduceat(rows, first) if count else rows
    payloads = Payloads(flat, first[complete] * 7 + 1, size[complete])
    return earliest[complete], payloads, count


def _packets(t: Ints, sender: Ints, sequence: Ints, frame: Ints) -> Ints:
    """Number of the packet each frame belongs to; frames by sender, then as logged; (N,)."""
    begins = np.ones(len(t), np.bool_)
    begins[1:] = (np.diff(sender) != 0) | (np.diff(sequence) != 0) | (np.diff(t) > PACKET_NS)
    run = np.cumsum(begins) - 1
    twice = np.sort((run << 5) + frame)
    repeats = np.unique(twice[1:][np.diff(twice) == 0] >> 5)
    begins[1:] |= (np.diff(frame) <= 0) & np.isin(run[1:], repeats)
    return np.cumsum(begins) - 1
