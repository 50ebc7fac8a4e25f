"""Blocks of a recorded NMEA 0183 stream to channels: sentences, stamps and what was lost.

The time of a sentence is, in this order: the tag block's, where it counts milliseconds or the line
has no stamp; the stamp the recorder wrote before it; the times of ZDA or RMC, interpolated.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.adapter import Wanted
from trialid.ingest.bytes.growing import Growing
from trialid.ingest.nmea0183 import (
    nmea0183_channels,
    nmea0183_clock,
    nmea0183_gather,
    nmea0183_stamps,
)
from trialid.ingest.nmea0183.nmea0183_gather import Sender
from trialid.ingest.nmea0183.nmea0183_sentences import (
    Mask,
    Places,
    Sentences,
    has_checksums,
    sentences,
)
from trialid.ingest.nmea0183.nmea0183_stamps import LOCAL, NONE, TIME_OF_DAY
from trialid.ingest.nmea0183.nmea0183_steps import out_of_step
from trialid.ingest.times import local_time
from trialid.recording import ZONELESS, Channel

Ints = NDArray[np.int64]
Connections = Callable[[Sentences], Iterable[tuple[Places, str]]]
"""Sentences by the connection they came over: rows and name."""

BLOCK = 4 << 20
UNSAFE = re.compile(r"[^\w.+#-]+")
MOST = 0.5


@dataclass
class Stream:
    """What is gathered from a stream, block after block.

    `tagged` are times of tag blocks, and which are whole seconds, from a sentence on; none of the
    many blocks without any tag.
    """

    found: nmea0183_gather.Found = field(default_factory=dict)
    tagged: list[tuple[int, Ints, Mask]] = field(default_factory=list)
    stamped: Growing = field(default_factory=lambda: Growing(np.int64))
    kind: list[NDArray[np.int8]] = field(default_factory=list)
    coarse: list[Mask] = field(default_factory=list)
    ticks: dict[str, list[nmea0183_clock.Ticks]] = field(default_factory=dict)
    total: int = 0
    wrong: int = 0
    foreign: int = 0
    bare: int = 0
    useful: int = 0


@dataclass(frozen=True)
class Timed:
    """Times of all sentences [ns], when they were received if that is another time, and words.

    `tick` is how far those are apart that the times are interpolated between [ns]; 0 if none are.
    """

    t: Ints
    received: Ints | None
    clock: str
    remarks: tuple[str, ...]
    tick: int = 0


def blocks(path: Path) -> Iterator[bytes]:
    """The file in blocks of whole lines."""
    rest = b""
    with path.open("rb") as file:
        while chunk := file.read(BLOCK):
            block = rest + chunk
            end = block.rfind(b"\n") + 1
            if not end and len(block) < 2 * BLOCK:
                rest = block
                continue
            yield block[: end or len(block)]
            rest = block[end or len(block) :]
    if rest:
        yield rest


def channels(
    path: Path,
    parts: Callable[[], Iterable[bytes]],
    wanted: Wanted,
    zone: str | None,
    connections: Connections | None = None,
) -> tuple[dict[str, Channel], list[str]]:
    """Channels of a stream, and remarks.

    Parameters
    ----------
    path
        What errors name.
    parts
        Gives the blocks, each time from the beginning.
    zone
        Zone of stamps that state none; UTC if it is None.

    Raises LogError when no sentence is sound, and when nothing says at what time they were sent.
    """
    checked = any(has_checksums(_array(part)) for part in parts())
    stream = Stream()
    for part in parts():
        _take(stream, _array(part), checked, wanted, connections)
    if not stream.total:
        raise LogError(
            f"{path}: not one sound NMEA 0183 sentence ({stream.wrong} with a wrong checksum, "
            f"{stream.bare} without one); take another copy of the log"
        )
    if not stream.useful:
        return {}, ["no sentence in it tells of the motion of the ship (AIS and satellites only?)"]
    timed = _timed(path, stream, zone)
    found, remarks = nmea0183_channels.channels(
        stream.found, timed.t, timed.received, timed.clock, wanted, NONE, tick=timed.tick
    )
    return found, [*_losses(stream, checked), *timed.remarks, *remarks]


def _array(part: bytes) -> NDArray[np.uint8]:
    return np.frombuffer(part, np.uint8)


def _take(
    stream: Stream,
    data: NDArray[np.uint8],
    checked: bool,
    wanted: Wanted,
    connections: Connections | None,
) -> None:
    block = sentences(data, checked)
    tags, before = nmea0183_stamps.of_tags(data, block.before)
    t, kind, coarse = nmea0183_stamps.of_prefixes(data, before)
    damaged = tags.there & ~tags.sound
    _inherit(block, t, kind)
    sources = list(tags.sources)
    if connections is not None:
        sources += connections(block)
    _gather(stream, block, damaged, sources, wanted)
    if (tags.t != NONE).any():
        stream.tagged.append((stream.total, tags.t, tags.seconds_only))
    stream.stamped.add(t)
    stream.kind.append(kind)
    stream.coarse.append(coarse)
    stream.total += len(t)
    stream.wrong += block.wrong + int(damaged.sum())
    stream.foreign += block.foreign
    stream.bare += block.bare


def _gather(
    stream: Stream,
    block: Sentences,
    damaged: Mask,
    sources: list[tuple[Places, str]],
    wanted: Wanted,
) -> None:
    """Add what the sentences of a block say, and the times of those that tell the time."""
    for rows, sentence, talker in nmea0183_gather.addresses(block):
        stream.useful += len(rows)
        sound = rows[~damaged[rows]]
        if sentence in nmea0183_clock.CLOCKS:
            tick = nmea0183_clock.ticks(block, sound, sentence, stream.total)
            stream.ticks.setdefault(talker + sentence, []).append(tick)
        if not nmea0183_gather.wants(sentence, wanted) or sentence == "ZDA":
            continue
        for connection, part in _by_connection(sound, sources, len(damaged)):
            sender = Sender(sentence, connection, talker)
            nmea0183_gather.gather(block, part, sender, stream.total, stream.found)


def _inherit(block: Sentences, t: Ints, kind: NDArray[np.int8]) -> None:
    """A sentence behind another on one line, with nothing between them, has its stamp."""
    rows = np.arange(len(t))
    origin = np.maximum.accumulate(np.where(block.joined, 0, rows)) if len(t) else rows
    t[:], kind[:] = t[origin], kind[origin]


def _by_connection(
    rows: Places, sources: list[tuple[Places, str]], total: int
) -> Iterator[tuple[str, Places]]:
    if not sources:
        yield "", rows
        return
    number = np.zeros(total, np.intp)
    names = [""]
    for part, text in sources:
        name = UNSAFE.sub("_", text).strip("_")
        if name not in names:
            names.append(name)
        number[part] = names.index(name)
    for one in np.unique(number[rows]):
        yield names[one], rows[number[rows] == one]


def _timed(path: Path, stream: Stream, zone: str | None) -> Timed:
    stamped: Ints = stream.stamped.array().astype(np.int64, copy=False)
    tags = sum(int(np.sum(t != NONE)) for _, t, _ in stream.tagged)
    seconds = sum(int(np.sum(coarse[t != NONE])) for _, t, coarse in stream.tagged)
    has_tags, has_stamps = tags >= MOST * stream.total, _mostly(stamped != NONE)
    fine = has_tags and seconds < MOST * tags
    tagged = _whole(stream.tagged, stream.total if has_tags else 0)
    lines = _of_lines(stream, stamped, zone) if has_stamps else None
    if has_tags and (fine or lines is None):
        words = "tag block time" + ("" if fine else ", whole seconds")
        received = None if lines is None or "no date" in lines.clock else lines.t
        return Timed(tagged, received, words, _untimed(tagged))
    if lines is not None:
        return lines
    ticks = {name: nmea0183_clock.join_ticks(parts) for name, parts in stream.ticks.items()}
    clock = nmea0183_clock.clock(stream.total, ticks)
    if clock is None:
        raise LogError(
            f"{path}: no time in the log: its lines have no stamps and no ZDA, RMC, GGA, GNS or "
            "GLL states one; record it with stamps on the lines, or with the GPS on the same stream"
        )
    remarks = (*clock.remarks, *_untimed(clock.t))
    return Timed(clock.t, None, clock.words, remarks, clock.tick)


def _whole(parts: list[tuple[int, Ints, Mask]], total: int) -> Ints:
    """Times from their sentences on, NONE where there is none. (N,)."""
    t = np.full(total, NONE)
    for start, part, _ in parts if total else ():
        t[start : start + len(part)] = part
    return t


def _mostly(there: Mask) -> bool:
    return len(there) > 0 and bool(there.mean() >= MOST)


def _of_lines(stream: Stream, stamped: Ints, zone: str | None) -> Timed:
    """The recorder's stamps: of the kind most lines have, without those that are damaged."""
    kinds = np.concatenate(stream.kind)
    kind = int(np.argmax(np.bincount(kinds[stamped != NONE])))
    ours = (kinds == kind) & (stamped != NONE)
    times = stamped if ours.all() else stamped[ours]
    if kind == LOCAL and zone is not None:
        times = local_time.utc(times, zone)
    if kind == TIME_OF_DAY:
        times = nmea0183_clock.unwrap_midnights(times)
    times[out_of_step(times)] = NONE
    t = times
    if len(times) < len(stamped):
        t = np.full(len(stamped), NONE)
        t[ours] = times
    words = {
        LOCAL: f"line stamps, zone {zone}" if zone else f"line stamps, no zone stated: {ZONELESS}",
        TIME_OF_DAY: "line stamps, time of day, no date",
    }.get(kind, "line stamps")
    remarks = list(_untimed(t))
    if _mostly(np.concatenate(stream.coarse)[ours]):
        remarks.append("the stamps on the lines are whole seconds")
    return Timed(t, None, words, tuple(remarks))


def _untimed(t: Ints) -> tuple[str, ...]:
    none = int((t == NONE).sum())
    return (f"{none} of {len(t)} sentences without a usable time left out",) if none else ()


def _losses(stream: Stream, checked: bool) -> list[str]:
    remarks = []
    if not checked:
        remarks.append(
            "no sentence of this log has a checksum: damage and half lines cannot be told from "
            "data; have the recorder keep the checksums"
        )
    lost = stream.wrong + stream.foreign + stream.bare
    whole = stream.total + lost
    foreign = f", {stream.foreign} with characters no sentence holds" if stream.foreign else ""
    if lost:
        remarks.append(
            f"recovered {stream.total} of about {whole} sentences: {stream.wrong} with a wrong "
            f"checksum{foreign} and {stream.bare} cut or without one left out"
        )
    return remarks
