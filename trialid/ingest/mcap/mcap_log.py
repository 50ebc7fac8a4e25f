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
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, sha256
from trialid.ingest.bytes.bounds import check_channels
from trialid.ingest.mcap import (
    mcap_batches,
    mcap_channels,
    mcap_damage,
    mcap_names,
    mcap_stretches,
)
from trialid.ingest.mcap.mcap_batches import Size
from trialid.ingest.mcap.mcap_channels import Share
from trialid.ingest.mcap.mcap_records import Book
from trialid.ingest.mcap.mcap_topics import Topic
from trialid.recording import Recording


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
    topics = mcap_channels.topics(path, _shares(path, book, remarks), wanted, remarks)
    _check(path, book)
    found = list(mcap_damage.remarks(book)) + remarks
    channels = mcap_channels.channels(topics, found)
    return Recording(path, ADAPTER.name, sha256(path), channels, tuple(found))


def batches(path: Path, aids: Aids = NO_AIDS) -> Iterable[Wanted]:
    """Readings that together give all channels, each within a few hundred megabytes."""
    del aids
    if path.stat().st_size <= mcap_batches.SMALL:
        return (None,)
    book = Book()
    sizes = _sizes(path, book)
    _check(path, book)
    return mcap_batches.plan_batches(sizes)


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
    for stretch in mcap_stretches.stretches(path, book):
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


def _sizes(path: Path, book: Book) -> list[Size]:
    """How much each topic gives: all is decoded once, and only counted."""
    sizes: dict[tuple[object, ...], tuple[Size, Topic | None]] = {}
    for source, stretch, rows in _shares(path, book, []):
        if source.key not in sizes:
            sizes[source.key] = (Size(source.topic), mcap_channels.topic_of(source, None, []))
            check_channels(path, len(sizes))
        size, topic = sizes[source.key]
        size.messages += len(rows)
        if topic is not None:
            for name, column in topic.decoded(stretch, rows).fields.items():
                size.fields[name] = size.fields.get(name, 0) + len(column.y)
    return [size for size, _ in sizes.values()]


ADAPTER = Adapter("mcap", recognises, read, batches=batches)
