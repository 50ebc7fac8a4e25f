"""The records of an MCAP file, read so that damage costs only what it hit.

The library's readers stop at the first damaged byte, and read flipped bits silently unless asked.
Here every chunk must pass its checksum; one that does not is skipped and said so, behind a broken
record the next chunk is looked for, and a file that was cut short gives everything before the cut.
What the file says about its own sizes is believed only as far as bytes are there.
"""

import re
import struct
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import BinaryIO

from trialid.ingest.bytes.bounds import Cost
from trialid.ingest.mcap import mcap_chunk
from trialid.ingest.mcap.mcap_chunk import CHANNEL, LARGEST, MESSAGE, RECORD, SCHEMA
from trialid.ingest.mcap.mcap_names import FOOTER, MAGIC, Summary

CHUNK, MESSAGE_INDEX, DATA_END = 6, 7, 15
READ = frozenset({SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, DATA_END})
"""Records that are read; the others, attachments above all, are passed over."""
PRIVATE = 128
"""From here on opcodes are the recorder's own; those between are nobody's."""
PIECE = 2**20

CHUNK_BEGINS = re.compile(
    rb"\x06(?=.{5}\0\0\0.{28}(?:\0\0\0\0|\x03\0\0\0lz4|\x04\0\0\0zstd))", re.DOTALL
)
CHUNK_HEAD = RECORD.size + mcap_chunk.HEAD.size + 4 + 16 + 8
"""Bytes from a chunk's beginning to its packed records, if its compression has no longer name."""


@dataclass(frozen=True)
class Loss:
    """Something that could not be read; `span` are log times [ns], `count` messages, if known."""

    at: int
    reason: str
    span: tuple[int, int] | None = None
    count: int = 0


@dataclass
class Book:
    """What the way through the file has found so far.

    `cost` is what the chunks unpack to in all; `chunks` are those read, by what they say of
    themselves. `unprotected` is set when a chunk has no checksum; `checked` and `untrusted` when
    the one over a file without chunks is right or wrong.
    """

    summary: Summary = field(default_factory=Summary)
    losses: list[Loss] = field(default_factory=list)
    seen: int = 0
    cost: Cost | None = None
    chunked: bool = False
    chunks: set[tuple[tuple[int, int], int, int]] = field(default_factory=set)
    repeated: int = 0
    unprotected: bool = False
    checked: bool = False
    untrusted: bool = False


@dataclass(frozen=True)
class Record:
    """One record of the file, and the index records behind it."""

    at: int
    opcode: int
    content: bytes
    indexes: list[bytes] = field(default_factory=list)


def records(file: BinaryIO, size: int, book: Book) -> Iterator[Record]:
    """The records that matter of a file of `size` bytes; what is lost goes into the book."""
    return _indexed(_records(file, size, book))


def _indexed(records: Iterable[Record]) -> Iterator[Record]:
    """The records but for the indexes, which go with the record they stand behind."""
    held: Record | None = None
    for record in records:
        if record.opcode == MESSAGE_INDEX:
            if held is not None:
                held.indexes.append(record.content)
            continue
        if held is not None:
            yield held
        held = record
    if held is not None:
        yield held


def _records(file: BinaryIO, size: int, book: Book) -> Iterator[Record]:
    """The records that matter up to the end of the messages or to where the file breaks off."""
    at: int | None = len(MAGIC)
    crc = zlib.crc32(MAGIC)
    while at is not None:
        file.seek(at)
        head = file.read(CHUNK_HEAD)
        opcode, length = RECORD.unpack_from(head) if len(head) >= RECORD.size else (0, 0)
        reason = _broken(at, head, size) or _misplaced(opcode, book)
        if reason:
            book.losses.append(Loss(at, reason, _stated(head) if opcode == CHUNK else None))
            at = _next_chunk(file, at + 1, size)
            continue
        file.seek(at + RECORD.size)
        behind = at + RECORD.size + length
        if opcode not in READ:
            crc = _passed(file, 0 if book.chunked else length, zlib.crc32(head[: RECORD.size], crc))
        else:
            content = file.read(length)
            if opcode == DATA_END:
                ended = _ended(book, at, behind, content, crc)
                at = None if ended else _next_chunk(file, behind, size)
                continue
            book.chunked |= opcode == CHUNK
            if not book.chunked:
                crc = zlib.crc32(content, zlib.crc32(head[: RECORD.size], crc))
            yield Record(at, opcode, content)
        at = behind


def _stated(head: bytes) -> tuple[int, int] | None:
    """The span a chunk of which only the beginning is there says it covers."""
    known = len(head) >= RECORD.size + 16
    return chunk_span(struct.unpack_from("<QQ", head, RECORD.size)) if known else None


def _passed(file: BinaryIO, length: int, crc: int) -> int:
    """The checksum with the next bytes, which nobody keeps."""
    while length > 0:
        piece = file.read(min(length, PIECE))
        crc, length = zlib.crc32(piece, crc), length - PIECE
    return crc


def _broken(at: int, head: bytes, size: int) -> str:
    """Why no whole record lies at `at` in a file of `size` bytes; empty when one does."""
    if at == size:
        return "the closing record is missing, the recorder may have died"
    left = size - at
    opcode, length = RECORD.unpack_from(head) if len(head) >= RECORD.size else (0, left)
    if left < RECORD.size or (opcode and length > left - RECORD.size):
        return "cut short here"
    if opcode in (0, FOOTER) or DATA_END < opcode < PRIVATE:
        return "no record here"
    if opcode == CHUNK and not _is_chunk(head, 0, left):
        return "the lengths in the chunk contradict each other"
    too_large = opcode in READ and length > LARGEST + PIECE
    return "a record too large to be believed" if too_large else ""


def _misplaced(opcode: int, book: Book) -> str:
    """In a chunked file a message outside of a chunk is what a broken length looks like."""
    return "no record here" if opcode == MESSAGE and book.chunked else ""


def _ended(book: Book, at: int, behind: int, content: bytes, crc: int) -> bool:
    """True when the messages end here; their checksum is looked at, where there are no chunks."""
    if not book.chunked:
        stated = int.from_bytes(content[:4], "little")
        book.untrusted = stated not in (0, crc)
        book.checked = stated == crc
    if book.summary.begins != behind:
        reason = "the end of the file is missing or damaged, or something stands behind it"
        book.losses.append(Loss(at, reason))
        return False
    if not book.summary.intact:
        book.losses.append(Loss(behind, "the summary at the end is damaged"))
    return True


def _next_chunk(file: BinaryIO, begin: int, size: int) -> int | None:
    """Where the next whole chunk begins, None when there is none."""
    while begin < size:
        file.seek(begin)
        block = file.read(PIECE + CHUNK_HEAD)
        for found in CHUNK_BEGINS.finditer(block, 0, len(block)):
            if found.start() < PIECE and _is_chunk(block, found.start(), size - begin):
                return begin + found.start()
        begin += PIECE
    return None


def _is_chunk(block: bytes, at: int, left: int) -> bool:
    """True when the lengths in what looks like a chunk fit together and the file holds it."""
    _, length = RECORD.unpack_from(block, at)
    if at + RECORD.size + length > left:
        return False
    name = at + RECORD.size + mcap_chunk.HEAD.size
    packed = name + 4 + int.from_bytes(block[name : name + 4], "little")
    behind = packed + 8 + int.from_bytes(block[packed : packed + 8], "little")
    return behind == at + RECORD.size + length


def chunk_span(times: tuple[int, ...] | None) -> tuple[int, int] | None:
    """Log times a chunk says it covers, unless they contradict each other."""
    if times is None or not 0 <= times[0] <= times[1] < 2**63:
        return None
    return times[0], times[1]
