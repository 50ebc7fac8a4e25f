"""MCAP logs: ROS 2, protobuf (Keelson, Foxglove) and JSON messages.

A channel is `topic:field`, the field dotted and indexed: `/imu:angular_velocity.z`, `/a:x[0]`, or
named where the message names its elements: `/joints:position[rudder]`. Every number in a message
is a channel; truth values, texts and times are not. Where one topic carries messages of two kinds
the kind is part of the name, as the source that it is: `/rudder/std_msgs/Float64:data`.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest import mcap_batches, mcap_damage, mcap_meaning, mcap_names, mcap_records
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, asked, sha256
from trialid.ingest.mcap_batches import Size
from trialid.ingest.mcap_names import Source
from trialid.ingest.mcap_records import Book, Stretch
from trialid.ingest.mcap_topics import Timed, Topic
from trialid.ingest.unaligned import Places
from trialid.recording import Channel, Recording

Share = tuple[Source, Stretch, Places]
"""The messages of a stretch that come from one source."""
Topics = dict[str, dict[tuple[object, ...], tuple[Source, Topic | None]]]
"""By topic and by what tells sources apart; None for a source that is left out."""


def recognises(head: bytes) -> bool:
    """The magic bytes of MCAP."""
    return head.startswith(mcap_names.MAGIC)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; damage is skipped and said in the remarks.

    Raises LogError when not one message can be read.
    """
    del aids
    book = Book()
    remarks: list[str] = []
    topics = _topics(path, book, wanted, remarks)
    _check(path, book)
    found = list(mcap_damage.remarks(book)) + remarks
    channels = _channels(topics, found)
    return Recording(path, ADAPTER.name, sha256(path), channels, tuple(found))


def batches(path: Path, aids: Aids = NO_AIDS) -> Iterable[Wanted]:
    """Readings that together give all channels, each within a few hundred megabytes."""
    del aids
    if path.stat().st_size <= mcap_batches.SMALL:
        return (None,)
    book = Book()
    sizes = _sizes(path, book)
    _check(path, book)
    return mcap_batches.planned(sizes)


def _check(path: Path, book: Book) -> None:
    """LogError unless there are messages, and they are to be trusted."""
    if book.untrusted:
        raise LogError(
            f"{path}: the checksum of all messages is wrong, and nothing says which of the "
            f"{book.seen} are good; take another copy of the log"
        )
    if not book.seen:
        said = next(mcap_damage.remarks(book), "") if book.losses else ""
        why = said or "it is whole, but the recorder wrote none"
        raise LogError(f"{path}: holds no readable message: {why}; take another copy of the log")


def _shares(path: Path, book: Book, remarks: list[str]) -> Iterator[Share]:
    """The messages of the file by source, stretch by stretch."""
    nameless: dict[int, int] = {}
    for stretch in mcap_records.stretches(path, book):
        for number in np.flatnonzero(np.bincount(stretch.channel)).tolist():
            rows = np.flatnonzero(stretch.channel == number)
            source = stretch.sources.get(number)
            if source is None:
                nameless[number] = nameless.get(number, 0) + len(rows)
            else:
                yield source, stretch, rows
    remarks.extend(
        f"nothing says what channel {number} is: {count} messages left out"
        for number, count in nameless.items()
    )


def _topics(path: Path, book: Book, wanted: Wanted, remarks: list[str]) -> Topics:
    """The topics there are, with their numbers where somebody wants them and they can be read."""
    topics: Topics = {}
    for source, stretch, rows in _shares(path, book, remarks):
        topics.setdefault(source.topic, {})
        if source.key not in topics[source.topic]:
            topics[source.topic][source.key] = (source, _topic(source, wanted, remarks))
        topic = topics[source.topic][source.key][1]
        if topic is not None:
            topic.add(stretch, rows)
    return topics


def _topic(source: Source, wanted: Wanted, remarks: list[str]) -> Topic | None:
    """Where the messages of the source are collected; None when they are left out."""
    names = _names(source)
    if not any(_topic_asked(name, wanted) for name in names):
        return None
    text = mcap_meaning.text(source)
    if text:
        remarks.append(
            f"{source.topic}: left out, it holds {text} as they came; write them to a file of "
            "their own and give that as a log"
        )
        return None
    try:
        return Topic(source, lambda field: any(asked(f"{n}:{field}", wanted) for n in names))
    except ValueError as error:
        remarks.append(f"{source.topic}: left out, {error}")
        return None


def _names(source: Source) -> tuple[str, str]:
    """What stands before the field in a channel's name: alone on the topic, and among others."""
    kind = mcap_meaning.ros_kind(source.kind) or source.encoding
    return source.topic, f"{source.topic}/{kind}"


def _topic_asked(topic: str, wanted: Wanted) -> bool:
    """True when a channel of the topic may be wanted."""
    channel = f"{topic}:"
    return asked(channel, wanted) or any(want.startswith(channel) for want in wanted or ())


def _channels(topics: Topics, remarks: list[str]) -> dict[str, Channel]:
    """One channel a name: a recorder that restarts writes the same topic as a second channel."""
    channels: dict[str, Channel] = {}
    for same in topics.values():
        alone = len({_names(source)[1] for source, _ in same.values()}) == 1
        for source, topic in same.values():
            for timed in topic.timed(remarks) if topic else ():
                name = f"{_names(source)[0 if alone else 1]}:{timed.field}"
                part = _channel(name, source, timed)
                first = channels.get(name)
                channels[name] = part if first is None else _joined(first, part)
    return channels


def _channel(name: str, source: Source, timed: Timed) -> Channel:
    what = mcap_meaning.meaning(source, timed.field)
    return Channel(
        name,
        timed.t,
        timed.y,
        what.unit,
        timed.clock,
        what.description,
        what.quantity,
        what.positive,
        timed.received,
    )


def _joined(first: Channel, then: Channel) -> Channel:
    t, y = np.concatenate([first.t, then.t]), np.concatenate([first.y, then.y])
    clock = first.clock if first.clock == then.clock else f"{first.clock}, {then.clock}"
    received = None
    if first.received is not None or then.received is not None:
        received = np.concatenate(
            [c.t if c.received is None else c.received for c in (first, then)]
        )
    said = (first.description, first.quantity, first.positive, received)
    return Channel(first.name, t, y, first.unit, clock, *said)


def _sizes(path: Path, book: Book) -> list[Size]:
    """How much each topic gives: all is decoded once, and only counted."""
    sizes: dict[tuple[object, ...], tuple[Size, Topic | None]] = {}
    for source, stretch, rows in _shares(path, book, []):
        if source.key not in sizes:
            sizes[source.key] = (Size(source.topic), _topic(source, None, []))
        size, topic = sizes[source.key]
        size.messages += len(rows)
        if topic is not None:
            for name, column in topic.decoded(stretch, rows).fields.items():
                size.fields[name] = size.fields.get(name, 0) + len(column.y)
    return [size for size, _ in sizes.values()]


ADAPTER = Adapter("mcap", recognises, read, batches=batches)
