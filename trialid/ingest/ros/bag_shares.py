"""Messages of a bag one by one, laid end to end, as the decoder of ROS 2 messages takes them."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

import numpy as np

from trialid.ingest.mcap.mcap_channels import Share
from trialid.ingest.mcap.mcap_names import Source
from trialid.ingest.mcap.mcap_stretches import Stretch

Message = tuple[int, int, bytes]
"""Number of the source, stamp of the recorder [ns], payload in CDR."""
BLOCK: Final = 1 << 24
"""Bytes of payloads that are decoded at once."""


def source(number: int, topic: str, kind: str, definition: str) -> Source:
    """Where messages come from: a topic, its type, and the type's definition in ROS 2 words."""
    from mcap.records import Schema

    return Source(topic, "cdr", Schema(number, definition.encode(), "ros2msg", kind))


def shares(messages: Iterable[Message], sources: Mapping[int, Source]) -> Iterator[Share]:
    """The messages of each source, stretch by stretch."""
    block: list[Message] = []
    size = 0
    for message in messages:
        block.append(message)
        size += len(message[2])
        if size >= BLOCK:
            yield from _shares(block, sources)
            block, size = [], 0
    if block:
        yield from _shares(block, sources)


def _shares(block: list[Message], sources: Mapping[int, Source]) -> Iterator[Share]:
    numbers, stamps, payloads = zip(*block, strict=True)
    size = np.fromiter(map(len, payloads), np.int64, len(payloads))
    data = np.frombuffer(b"".join(payloads), np.uint8)
    channel, log = np.array(numbers, np.uint16), np.array(stamps, np.int64)
    stretch = Stretch(
        data=data,
        payload=np.cumsum(size) - size,
        size=size,
        channel=channel,
        log=log,
        publish=log,
        sources=sources,
    )
    for number in np.unique(channel).tolist():
        yield sources[number], stretch, np.flatnonzero(channel == number)
