"""Topics of numbers as an MCAP file for plot tools.

Protobuf with its descriptor inside: Foxglove and PlotJuggler show typed columns without any
plug-in, which JSON messages do not give them (`formats.md` 1.6 of the design).
"""

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from heapq import merge
from operator import itemgetter
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Vector
from trialid.export import lines as log_lines
from trialid.export.lines import Line

if TYPE_CHECKING:
    from google.protobuf.message import Message
    from mcap.writer import Writer

CHUNK = 64 * 1024
"""Small chunks: what is left of a damaged file is what stands in whole chunks."""


@dataclass(frozen=True)
class Track:
    """One topic: when [ns] and what, field name to values in SI."""

    topic: str
    message: str
    t: NDArray[np.int64]
    fields: Mapping[str, Vector]


@dataclass(frozen=True)
class About:
    """What a file was made of: who wrote it, a table of texts, and plain data under a name."""

    library: str
    manifest: Mapping[str, str]
    attached: str
    data: Mapping[str, Any]


def stems(names: Iterable[str]) -> list[str]:
    """A part of a topic for each name, of letters plot tools take in an expression.

    >>> stems(["zig zag", "zig_zag"])
    ['zig_zag', 'zig_zag_']
    """
    found: list[str] = []
    for name in names:
        stem = re.sub(r"[^\w-]", "_", name, flags=re.ASCII) or "_"
        while stem in found:
            stem += "_"
        found.append(stem)
    return found


def write_tracks(
    stream: BinaryIO,
    tracks: Sequence[Track],
    about: About,
    lines: Mapping[str, Sequence[Line]] = MappingProxyType({}),
) -> None:
    """The tracks as protobuf messages in the order of time, with metadata and an attachment.

    `lines` are topics of text beside those of numbers.
    """
    from mcap.writer import Writer

    writer = Writer(stream, chunk_size=CHUNK)
    writer.start(library=about.library)
    messages = _messages(tracks)
    channels = _channels(writer, tracks, messages)
    numbers = ((t, channels[index], message) for t, index, message in _in_order(tracks, messages))
    for t, channel, message in merge(numbers, *_texts(writer, lines), key=itemgetter(0)):
        writer.add_message(channel, t, message, t)
    writer.add_metadata("trialid", dict(about.manifest))
    attached = json.dumps(about.data, ensure_ascii=False, allow_nan=False).encode()
    writer.add_attachment(0, 0, about.attached, "application/json", attached)
    writer.finish()  # type: ignore[no-untyped-call]


def _texts(
    writer: "Writer", lines: Mapping[str, Sequence[Line]]
) -> Iterator[Iterator[tuple[int, int, bytes]]]:
    """Log time [ns], channel and message of the lines of each topic."""
    from mcap_protobuf.schema import register_schema

    for topic, each in lines.items():
        schema = register_schema(writer, log_lines.message())
        channel = writer.register_channel(topic, "protobuf", schema)
        yield _on(channel, each)


def _on(channel: int, lines: Sequence[Line]) -> Iterator[tuple[int, int, bytes]]:
    for t, message in log_lines.encode(lines):
        yield t, channel, message


def _messages(tracks: Iterable[Track]) -> "dict[str, type[Message]]":
    """Message types by name, each with every field any of its topics has."""
    fields: dict[str, dict[str, None]] = {}
    for track in tracks:
        fields.setdefault(track.message, {}).update(dict.fromkeys(track.fields))
    return {name: _message(name, tuple(each)) for name, each in fields.items()}


def _message(name: str, fields: Sequence[str]) -> "type[Message]":
    """A message type made here and now: a time stamp and one double a field."""
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2

    stamp = timestamp_pb2.DESCRIPTOR
    package, _, short = name.rpartition(".")
    file = descriptor_pb2.FileDescriptorProto(
        name=f"{name}.proto", package=package, syntax="proto3", dependency=[stamp.name]
    )
    message = file.message_type.add(name=short)
    kind = descriptor_pb2.FieldDescriptorProto
    one = kind.LABEL_OPTIONAL
    time = ".google.protobuf.Timestamp"
    message.field.add(name="timestamp", number=1, label=one, type=kind.TYPE_MESSAGE, type_name=time)
    for place, field in enumerate(fields, start=2):
        message.field.add(name=field, number=place, label=one, type=kind.TYPE_DOUBLE)
    pool = descriptor_pool.DescriptorPool()
    pool.AddSerializedFile(stamp.serialized_pb)
    pool.AddSerializedFile(file.SerializeToString())
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(name))


def _channels(
    writer: "Writer", tracks: Sequence[Track], messages: "Mapping[str, type[Message]]"
) -> list[int]:
    """A channel a track, with the descriptors a reader needs: the time stamp's too."""
    from mcap_protobuf.schema import register_schema

    schemas = {name: register_schema(writer, message) for name, message in messages.items()}
    return [writer.register_channel(t.topic, "protobuf", schemas[t.message]) for t in tracks]


def _in_order(
    tracks: Sequence[Track], messages: "Mapping[str, type[Message]]"
) -> Iterator[tuple[int, int, bytes]]:
    """Log time [ns], track and encoded message of every sample, in the order of time.

    Readers then meet chunks that do not overlap.
    """
    encoded = [_encoded(track, messages[track.message]) for track in tracks]
    times = np.concatenate([track.t for track in tracks] or [np.empty(0, np.int64)])
    owner = np.repeat(np.arange(len(tracks)), [len(track.t) for track in tracks])
    order = np.argsort(times, kind="stable")
    for t, index in zip(times[order].tolist(), owner[order].tolist(), strict=True):
        yield t, index, next(encoded[index])


def _encoded(track: Track, message: "type[Message]") -> Iterator[bytes]:
    names = [field.name for field in message.DESCRIPTOR.fields if field.name != "timestamp"]
    absent = np.full(len(track.t), np.nan)
    columns = [track.fields.get(name, absent).tolist() for name in names]
    seconds, nanos = (part.tolist() for part in np.divmod(track.t, 10**9))
    one: Any = message()
    stamp = one.timestamp
    for stamp.seconds, stamp.nanos, *values in zip(seconds, nanos, *columns, strict=True):
        for name, value in zip(names, values, strict=True):
            setattr(one, name, value)
        yield one.SerializeToString()
