"""MCAP logs: ROS 2, protobuf (Keelson, Foxglove) and JSON messages.

A channel is `topic:field`, the field dotted and indexed: `/imu:angular_velocity.z`,
`/joints:position[0]`. Every number in a message is a channel; truth values, texts and times are
not.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from trialid.errors import LogError
from trialid.ingest import mcap_clock, mcap_records, payload_cdr, payload_json, payload_protobuf
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, asked, sha256
from trialid.ingest.payload import Columns, Decoder
from trialid.recording import Channel, Recording

if TYPE_CHECKING:
    from mcap.records import Schema

DECODERS: dict[str, Callable[["Schema | None"], Decoder]] = {
    "cdr": payload_cdr.decoder,
    "protobuf": payload_protobuf.decoder,
    "json": payload_json.decoder,
}
"""Message encoding to its decoder."""

STAMP_NAMES = {"cdr": "header stamp", "protobuf": "message timestamp", "json": "message timestamp"}

KEELSON = re.compile(r"/@v\d+/[^/]+/pubsub/\w+_(?P<unit>[a-z]+)/.*:value")
KEELSON_UNITS = {
    "deg": "deg",
    "degps": "deg/s",
    "knots": "kn",
    "mps": "m/s",
    "rpm": "rpm",
    "rad": "rad",
    "radps": "rad/s",
    "m": "m",
    "pct": "percent",
}
"""Keelson names its subjects with their unit at the end: `rudder_angle_deg`, `yaw_rate_degps`."""


def recognises(head: bytes) -> bool:
    """The magic bytes of MCAP."""
    return head.startswith(mcap_records.MAGIC)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; damage is skipped and said in the remarks.

    Raises LogError when not one message can be read.
    """
    del aids
    contents = mcap_records.contents(path, lambda topic: _topic_asked(topic, wanted))
    if not contents.seen:
        why = (
            contents.remarks[0] if contents.remarks else "it is whole, but the recorder wrote none"
        )
        raise LogError(f"{path}: holds no readable message: {why}; take another copy of the log")
    remarks = list(contents.remarks)
    channels = _merged(
        channel for part in contents.messages for channel in _channels(part, wanted, remarks)
    )
    return Recording(path, ADAPTER.name, sha256(path), channels, tuple(remarks))


def _topic_asked(topic: str, wanted: Wanted) -> bool:
    """True when a channel of the topic may be wanted."""
    channel = f"{topic}:"
    return asked(channel, wanted) or any(want.startswith(channel) for want in wanted or ())


def _channels(part: mcap_records.Messages, wanted: Wanted, remarks: list[str]) -> Iterator[Channel]:
    """The channels of one topic; why there are none, or fewer samples, goes to the remarks."""
    topic = part.topic
    try:
        decode = _decoder(part.encoding, part.schema)
    except ValueError as error:
        remarks.append(f"{topic}: left out, {error}")
        return
    columns = decode(part.payloads, lambda field: asked(f"{topic}:{field}", wanted))
    count = len(part.payloads)
    if columns.undecodable:
        bad = f"{columns.undecodable} of {count} messages"
        remarks.append(f"{topic}: {bad} cannot be decoded ({columns.reason})")
    yield from _timed(part, columns, remarks)


def _decoder(encoding: str, schema: "Schema | None") -> Decoder:
    if encoding not in DECODERS:
        raise ValueError(f"encoding {encoding!r} is none of {', '.join(DECODERS)}")
    return DECODERS[encoding](schema)


def _timed(part: mcap_records.Messages, columns: Columns, remarks: list[str]) -> Iterator[Channel]:
    name = STAMP_NAMES[part.encoding]
    t, timed, clock = mcap_clock.measured(columns.stamp, part.publish, part.log, name)
    if not timed.all():
        remarks.append(f"{part.topic}: {np.sum(~timed)} messages without a usable {name} left out")
    for field, column in columns.fields.items():
        row = column.row[timed[column.row]]
        channel = f"{part.topic}:{field}"
        yield Channel(channel, t[row], column.y[timed[column.row]], _unit(channel), clock)


def _unit(channel: str) -> str | None:
    """The unit the topic's name states, by the Keelson convention; ROS messages state none."""
    found = KEELSON.search(channel)
    return KEELSON_UNITS.get(found["unit"]) if found else None


def _merged(parts: Iterable[Channel]) -> dict[str, Channel]:
    """One channel a name: a recorder that restarts writes the same topic as a second channel."""
    channels: dict[str, Channel] = {}
    for part in parts:
        first = channels.get(part.name)
        channels[part.name] = part if first is None else _joined(first, part)
    return channels


def _joined(first: Channel, then: Channel) -> Channel:
    t, y = np.concatenate([first.t, then.t]), np.concatenate([first.y, then.y])
    clock = first.clock if first.clock == then.clock else f"{first.clock}, {then.clock}"
    return Channel(first.name, t, y, first.unit, clock)


ADAPTER = Adapter("mcap", recognises, read)
