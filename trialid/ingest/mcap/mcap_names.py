"""What the numbers of channels and schemas mean, and the summary at the end of an MCAP file."""

import io
import struct
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, BinaryIO

from trialid.ingest.mcap.mcap_chunk import CHANNEL, LARGEST, RECORD, SCHEMA, Damaged

if TYPE_CHECKING:
    from mcap.records import Channel, Schema

MAGIC = b"\x89MCAP0\r\n"
FOOTER, STATISTICS = 2, 11
FOOTER_RECORD = struct.Struct("<BQQQI")
"""Opcode, length, where the summary begins and its offsets, its checksum."""
FOOTER_LENGTH = 20


@dataclass(frozen=True)
class Source:
    """Where messages come from: one topic of one encoding and one schema."""

    topic: str
    encoding: str
    schema: "Schema | None"

    @property
    def kind(self) -> str:
        """Name of the messages' type, empty when the file names none."""
        return self.schema.name if self.schema else ""

    @property
    def key(self) -> tuple[str, str, str, str, bytes]:
        """Equal for sources that are one: a recorder that restarts names the same topic anew."""
        schema = self.schema
        said = (schema.encoding, schema.name, bytes(schema.data)) if schema else ("", "", b"")
        return (self.topic, self.encoding, *said)


@dataclass
class Names:
    """Schemas and channels by their numbers."""

    schemas: dict[int, "Schema"] = field(default_factory=dict)
    channels: dict[int, "Channel"] = field(default_factory=dict)

    def sources(self) -> dict[int, Source]:
        """Channel number to source."""
        return {
            number: Source(one.topic, one.message_encoding, self.schemas.get(one.schema_id))
            for number, one in self.channels.items()
        }

    def differ(self, other: "Names") -> bool:
        """True when the other gives a number another meaning."""
        return any(self.schemas.get(k, v) != v for k, v in other.schemas.items()) or any(
            self.channels.get(k, v) != v for k, v in other.channels.items()
        )

    def learn(self, other: "Names") -> None:
        """Take over what the other knows."""
        self.schemas.update(other.schemas)
        self.channels.update(other.channels)


@dataclass(frozen=True)
class Summary:
    """The end of a file: where it begins, the names in it, how many messages it counts.

    `begins` is None where the file has no end, `intact` False where the end is damaged.
    """

    begins: int | None = None
    intact: bool = False
    names: Names = field(default_factory=Names)
    promised: int | None = None


def record_names(records: Iterable[tuple[int, bytes]]) -> Names:
    """The names in records of opcode and content; Damaged when one cannot be read."""
    from mcap.data_stream import ReadDataStream
    from mcap.exceptions import McapError
    from mcap.records import Channel, Schema

    names = Names()
    try:
        for opcode, content in records:
            stream = ReadDataStream(io.BytesIO(content))
            if opcode == SCHEMA:
                schema = Schema.read(stream)
                names.schemas[schema.id] = schema
            elif opcode == CHANNEL:
                channel = Channel.read(stream)
                names.channels[channel.id] = channel
    except (McapError, struct.error, ValueError, OverflowError) as error:
        raise Damaged(f"the name of a channel or schema cannot be read ({error})") from error
    return names


def summary(file: BinaryIO, size: int) -> Summary:
    """The end of the file; names and counts only where it is whole."""
    at = size - len(MAGIC) - FOOTER_RECORD.size
    if at < len(MAGIC):
        return Summary()
    file.seek(at)
    footer = file.read(FOOTER_RECORD.size)
    opcode, length, begins, _, crc = FOOTER_RECORD.unpack(footer)
    if (opcode, length, file.read(len(MAGIC))) != (FOOTER, FOOTER_LENGTH, MAGIC):
        return Summary()
    begins = begins or at
    if not len(MAGIC) <= begins <= at or at - begins > LARGEST:
        return Summary()
    file.seek(begins)
    content = file.read(at - begins)
    if crc not in (0, zlib.crc32(footer[:-4], zlib.crc32(content))):
        return Summary(begins)
    return _summarised(begins, content)


def _summarised(begins: int, content: bytes) -> Summary:
    try:
        records = list(_records(content))
        names = record_names(records)
    except Damaged:
        return Summary(begins)
    counts = [int.from_bytes(found[:8], "little") for opcode, found in records
              if opcode == STATISTICS]  # fmt: skip
    return Summary(begins, True, names, counts[0] if counts else None)


def _records(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Opcode and content of the records in a run of them; Damaged when they do not fill it."""
    at = 0
    while at < len(content):
        if len(content) - at < RECORD.size:
            raise Damaged("the records of the summary do not fit")
        opcode, length = RECORD.unpack_from(content, at)
        begin = at + RECORD.size
        at = begin + length
        if at > len(content):
            raise Damaged("the records of the summary do not fit")
        if opcode in (SCHEMA, CHANNEL, STATISTICS):
            yield opcode, content[begin:at]
