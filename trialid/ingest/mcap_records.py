"""The records of an MCAP file, read so that damage costs only what it hit.

The library's readers stop at the first damaged byte, and read flipped bits silently unless asked.
Here every chunk must pass its checksum; one that does not is skipped and said so, and a file that
was cut short gives everything before the cut.
"""

import io
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from mcap.records import Channel, Schema

MAGIC = b"\x89MCAP0\r\n"
RECORD = struct.Struct("<BQ")
"""Opcode, length of what follows."""
MESSAGE = struct.Struct("<HIQQ")
"""Channel id, sequence, log time [ns], publish time [ns]; the payload follows."""
SPAN = struct.Struct("<QQ")
"""A chunk begins with the log times of its first and last message [ns]."""

FOOTER, SCHEMA, CHANNEL, MESSAGE_RECORD, CHUNK, STATISTICS, DATA_END = 2, 3, 4, 5, 6, 11, 15
FOOTER_SIZE = 20
"""Bytes of the footer: two places and, last, the checksum of the summary before it."""


@dataclass(frozen=True)
class Messages:
    """The messages of one channel record in the order of the file; times [ns], (N,)."""

    topic: str
    encoding: str
    schema: "Schema | None"
    log: NDArray[np.int64]
    publish: NDArray[np.int64]
    payloads: list[bytes]


@dataclass(frozen=True)
class Contents:
    """What a file gave: messages by channel, how many messages of any topic, what was lost."""

    messages: list[Messages]
    seen: int
    remarks: tuple[str, ...]


@dataclass(frozen=True)
class Loss:
    """A stretch of the file that could not be read; `span` are log times [ns] where known."""

    at: int
    reason: str
    span: tuple[int, int] | None = None


@dataclass
class Rows:
    """Messages of one channel while the file is walked."""

    log: list[int] = field(default_factory=list)
    publish: list[int] = field(default_factory=list)
    payload: list[bytes] = field(default_factory=list)


@dataclass
class Names:
    """What the numbers of schemas and channels mean."""

    schemas: dict[int, "Schema"] = field(default_factory=dict)
    channels: dict[int, "Channel"] = field(default_factory=dict)


@dataclass
class Book:
    """What the walk through the file has found so far.

    Names inside a chunk passed its checksum; those outside pass with the summary they stand in.
    """

    asked: Callable[[str], bool]
    inside: Names = field(default_factory=Names)
    outside: Names = field(default_factory=Names)
    summary_intact: bool = False
    rows: dict[int, Rows] = field(default_factory=dict)
    losses: list[Loss] = field(default_factory=list)
    seen: int = 0
    first: int | None = None
    chunks: int = 0
    unprotected: int = 0
    promised: int | None = None


def contents(path: Path, asked: Callable[[str], bool]) -> Contents:
    """Messages of the topics asked for, and remarks on what was lost."""
    book = Book(asked)
    with path.open("rb") as file:
        for at, opcode, content in _records(file, path.stat().st_size, book):
            try:
                _note(book, at, opcode, content)
            except _damage() as error:
                book.losses.append(Loss(at, str(error), _span(opcode, content)))
    return Contents(_messages(book), book.seen, tuple(_remarks(book)))


def _damage() -> tuple[type[Exception], ...]:
    """What the library and its decompressors raise on damaged bytes; lz4 says RuntimeError."""
    import zstandard
    from mcap.exceptions import McapError

    errors = (struct.error, ValueError, RuntimeError, MemoryError, OverflowError)
    return (McapError, zstandard.ZstdError, *errors)


def _records(file: BinaryIO, size: int, book: Book) -> Iterator[tuple[int, int, bytes]]:
    """Place, opcode and content of each record up to the footer or to where the file breaks off."""
    at = file.seek(len(MAGIC))
    crc, summary = zlib.crc32(MAGIC), 0
    while at < size:
        head = file.read(RECORD.size)
        opcode, length = RECORD.unpack(head) if len(head) == RECORD.size else (0, 0)
        content = file.read(min(length, size - at))
        reason = _broken(at, head, opcode, length, size)
        if reason:
            book.losses.append(Loss(at, reason, _span(opcode, content)))
            return
        if opcode == DATA_END:
            _check_data(book, at, content, crc)
        yield at, opcode, content
        if opcode == FOOTER:
            stated = int.from_bytes(content[-4:], "little")
            book.summary_intact = stated == zlib.crc32(head + content[:-4], summary)
            return
        crc = zlib.crc32(content, zlib.crc32(head, crc))
        summary = 0 if opcode == DATA_END else zlib.crc32(content, zlib.crc32(head, summary))
        at += RECORD.size + length
    book.losses.append(Loss(at, "the closing record is missing, the recorder may have died"))


def _broken(at: int, head: bytes, opcode: int, length: int, size: int) -> str:
    """Why no whole record lies at `at` in a file of `size` bytes; empty when one does."""
    left = size - at - RECORD.size
    if len(head) < RECORD.size or (opcode and length > left):
        return "cut short here"
    footer = opcode == FOOTER and (length != FOOTER_SIZE or left != FOOTER_SIZE + len(MAGIC))
    return "no record here" if footer or not opcode else ""


def _check_data(book: Book, at: int, content: bytes, crc: int) -> None:
    """Unchunked messages have one checksum for all of them, if any."""
    stated = int.from_bytes(content[:4], "little")
    if book.chunks or stated == crc:
        return
    if stated == 0:
        book.unprotected = book.seen
    else:
        book.losses.append(Loss(at, "the checksum of all messages is wrong: do not trust them"))


def _span(opcode: int, content: bytes) -> tuple[int, int] | None:
    """Log times a chunk says it covers."""
    if opcode != CHUNK or len(content) < SPAN.size:
        return None
    first, last = SPAN.unpack_from(content)
    return (first, last) if first <= last else None


def _note(book: Book, at: int, opcode: int, content: bytes) -> None:
    if opcode == CHUNK:
        _chunk(book, at, content)
    elif opcode in (SCHEMA, CHANNEL):
        _define(book.outside, opcode, content)
    elif opcode == MESSAGE_RECORD and not book.chunks:
        # In a chunked file a message outside of a chunk is what a broken record length looks like.
        _message(book, content)
    elif opcode == STATISTICS:
        book.promised = int.from_bytes(content[:8], "little")


def _chunk(book: Book, at: int, content: bytes) -> None:
    from mcap.data_stream import ReadDataStream
    from mcap.records import Chunk
    from mcap.stream_reader import get_chunk_data_stream

    stream = ReadDataStream(io.BytesIO(content))
    chunk = Chunk.read(stream)
    book.chunks += 1
    data_stream, size = get_chunk_data_stream(chunk, validate_crc=True)
    data = data_stream.read(size)
    book.unprotected += chunk.uncompressed_crc == 0
    if stream.count != len(content):
        book.losses.append(Loss(at, "a record length is wrong"))
    _inside(book, data)


def _inside(book: Book, data: bytes) -> None:
    """The records inside a chunk."""
    at = 0
    while at < len(data):
        opcode, length = RECORD.unpack_from(data, at)
        at += RECORD.size
        content = data[at : at + length]
        if opcode == MESSAGE_RECORD:
            _message(book, content)
        elif opcode in (SCHEMA, CHANNEL):
            _define(book.inside, opcode, content)
        at += length


def _message(book: Book, content: bytes) -> None:
    channel, _, log, publish = MESSAGE.unpack_from(content)
    book.seen += 1
    book.first = log if book.first is None else min(book.first, log)
    known = book.inside.channels.get(channel) or book.outside.channels.get(channel)
    if known is not None and not book.asked(known.topic):
        return
    rows = book.rows.get(channel)
    if rows is None:
        rows = book.rows[channel] = Rows()
    rows.log.append(log)
    rows.publish.append(publish)
    rows.payload.append(content[MESSAGE.size :])


def _define(names: Names, opcode: int, content: bytes) -> None:
    from mcap.data_stream import ReadDataStream
    from mcap.records import Channel, Schema

    stream = ReadDataStream(io.BytesIO(content))
    if opcode == SCHEMA:
        schema = Schema.read(stream)
        names.schemas[schema.id] = schema
    else:
        channel = Channel.read(stream)
        names.channels[channel.id] = channel


def _trusted(book: Book) -> Names:
    """The names that passed a checksum; in a file without chunks there is none to pass."""
    if book.chunks and not book.summary_intact:
        return book.inside
    return Names(
        book.outside.schemas | book.inside.schemas, book.outside.channels | book.inside.channels
    )


def _messages(book: Book) -> list[Messages]:
    found = []
    names = _trusted(book)
    for number, rows in book.rows.items():
        channel = names.channels.get(number)
        if channel is None:
            reason = f"nothing says what channel {number} is: {len(rows.log)} messages left out"
            book.losses.append(Loss(0, reason))
        elif book.asked(channel.topic):
            schema = names.schemas.get(channel.schema_id)
            log, publish = _times(rows.log), _times(rows.publish)
            encoding = channel.message_encoding
            found.append(Messages(channel.topic, encoding, schema, log, publish, rows.payload))
    return found


def _times(times: list[int]) -> NDArray[np.int64]:
    return np.array(times, np.uint64).astype(np.int64)


def _remarks(book: Book) -> Iterator[str]:
    if book.losses:
        yield _damage_remark(book)
    elif book.promised is not None and book.promised != book.seen:
        yield f"{book.seen} messages found where the file's statistics count {book.promised}"
    if book.unprotected:
        yield "the messages carry no checksum: damage inside them would not be seen"


def _damage_remark(book: Book) -> str:
    """What was lost, where, and how much was read nevertheless."""
    loss = book.losses[0]
    more = f" and {len(book.losses) - 1} more" if len(book.losses) > 1 else ""
    total = f" of {book.promised}" if book.promised is not None else ""
    spans = [lost.span for lost in book.losses if lost.span]
    lost = ", ".join(_seconds(span, book.first) for span in spans[:3])
    known = f"lost {lost} after the first message" if lost else "the time lost is not known"
    return (
        f"damaged at byte {loss.at} ({loss.reason}){more}; "
        f"{book.seen}{total} messages recovered; {known}"
    )


def _seconds(span: tuple[int, int], first: int | None) -> str:
    start = span[0] if first is None else first
    return f"{(span[0] - start) / 1e9:.2f}-{(span[1] - start) / 1e9:.2f} s"
