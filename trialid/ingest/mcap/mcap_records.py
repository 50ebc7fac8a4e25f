"""The messages of an MCAP file in stretches, read so that damage costs only what it hit.

The library's readers stop at the first damaged byte, and read flipped bits silently unless asked.
Here every chunk must pass its checksum; one that does not is skipped and said so, behind a broken
record the next chunk is looked for, and a file that was cut short gives everything before the cut.
What the file says about its own sizes is believed only as far as bytes are there.
"""

import re
import struct
import zlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.bounds import Cost
from trialid.ingest.bytes.unaligned import Bytes, Places, numbers
from trialid.ingest.mcap import mcap_chunk, mcap_names
from trialid.ingest.mcap.mcap_chunk import (
    CHANNEL,
    LARGEST,
    MESSAGE,
    MESSAGE_HEAD,
    RECORD,
    SCHEMA,
    Damaged,
    Located,
)
from trialid.ingest.mcap.mcap_names import FOOTER, MAGIC, Names, Source, Summary

CHUNK, MESSAGE_INDEX, DATA_END = 6, 7, 15
READ = frozenset({SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, DATA_END})
"""Records that are read; the others, attachments above all, are passed over."""
PRIVATE = 128
"""From here on opcodes are the recorder's own; those between are nobody's."""
STRETCH = 4 * 2**20
"""Bytes of messages that are decoded together: enough for numpy, little for the memory."""
PIECE = 2**20

CHUNK_BEGINS = re.compile(
    rb"\x06(?=.{5}\0\0\0.{28}(?:\0\0\0\0|\x03\0\0\0lz4|\x04\0\0\0zstd))", re.DOTALL
)
CHUNK_HEAD = RECORD.size + mcap_chunk.HEAD.size + 4 + 16 + 8
"""Bytes from a chunk's beginning to its packed records, if its compression has no longer name."""


@dataclass(frozen=True)
class Stretch:
    """Messages that lie in one stretch of bytes, in the order of the file; times [ns], (N,)."""

    data: Bytes
    payload: Places
    size: Places
    channel: NDArray[np.uint16]
    log: NDArray[np.int64]
    publish: NDArray[np.int64]
    sources: Mapping[int, Source]


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


@dataclass(frozen=True)
class Run:
    """Records one behind the other, and where those lie that matter."""

    data: bytes | memoryview
    located: Located


def stretches(path: Path, book: Book) -> Iterator[Stretch]:
    """The messages of the file, stretch by stretch; what is found goes into the book."""
    size = path.stat().st_size
    with path.open("rb") as file:
        book.cost = Cost(path)
        book.summary = mcap_names.summary(file, size)
        names = Names(dict(book.summary.names.schemas), dict(book.summary.names.channels))
        waiting: list[Run] = []
        for run in _runs(_indexed(_records(file, size, book)), book):
            new = _named(run, book)
            if waiting and (names.differ(new) or sum(len(one.data) for one in waiting) > STRETCH):
                yield _stretch(waiting, names, book)
                waiting = []
            names.learn(new)
            waiting.append(run)
        if waiting:
            yield _stretch(waiting, names, book)


def _stretch(runs: list[Run], names: Names, book: Book) -> Stretch:
    whole = [np.frombuffer(run.data, np.uint8) for run in runs]
    data = np.concatenate(whole) if len(whole) > 1 else whole[0]
    begins = np.cumsum([0, *(len(one) for one in whole[:-1])])
    at = np.concatenate([r.located.messages + b for r, b in zip(runs, begins, strict=True)])
    book.seen += len(at)
    return Stretch(
        data=data,
        payload=at + MESSAGE_HEAD,
        size=numbers(data, at + 1, "<i8").astype(np.int64) - (MESSAGE_HEAD - RECORD.size),
        channel=numbers(data, at + RECORD.size, "<u2").astype(np.uint16),
        log=numbers(data, at + MESSAGE_HEAD - 16, "<i8").astype(np.int64),
        publish=numbers(data, at + MESSAGE_HEAD - 8, "<i8").astype(np.int64),
        sources=names.sources(),
    )


def _named(run: Run, book: Book) -> Names:
    """The names that stand in the run."""
    try:
        return mcap_names.record_names(
            (opcode, bytes(run.data[at + RECORD.size : at + RECORD.size + length]))
            for at in run.located.names
            for opcode, length in [RECORD.unpack_from(run.data, at)]
        )
    except Damaged as error:
        book.losses.append(Loss(0, str(error)))
        return Names()


def _runs(records: Iterable[Record], book: Book) -> Iterator[Run]:
    """Chunks that passed their checksum, and, in a file without chunks, its records in runs."""
    loose: list[bytes] = []
    size = 0
    for record in records:
        if record.opcode == CHUNK:
            chunk = _chunk(record, book)
            if chunk is not None:
                yield chunk
        elif record.opcode in (SCHEMA, CHANNEL, MESSAGE) and not book.chunked:
            loose += [RECORD.pack(record.opcode, len(record.content)), record.content]
            size += len(record.content)
            if size > STRETCH:
                yield from _loose(loose, book)
                loose, size = [], 0
    yield from _loose(loose, book)


def _chunk(record: Record, book: Book) -> Run | None:
    """The chunk's records; None, and a loss in the book, unless they are sound."""
    span = None
    try:
        chunk = mcap_chunk.parse_chunk(record.content)
        span = chunk.span
        key = (chunk.span, chunk.size, chunk.crc)
        if chunk.crc and key in book.chunks:
            book.repeated += 1
            return None
        if book.cost is not None:
            book.cost.unpacks(min(chunk.size, LARGEST))
        data = mcap_chunk.unpack_chunk(chunk)
        located = mcap_chunk.locate_records(data, record.indexes)
        if book.cost is not None:
            book.cost.holds(len(located.messages))
    except Damaged as error:
        count = sum(len(index) // 16 for index in record.indexes)
        book.losses.append(Loss(record.at, str(error), _span(span), count))
        return None
    book.chunks.add(key)
    book.unprotected |= chunk.crc == 0
    return Run(data, located)


def _loose(pieces: list[bytes], book: Book) -> Iterator[Run]:
    data = b"".join(pieces)
    try:
        located = mcap_chunk.walk_records(data, 0, len(data))
    except Damaged as error:
        book.losses.append(Loss(0, str(error)))
        return
    if len(located.messages) or located.names:
        yield Run(data, located)


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
    return _span(struct.unpack_from("<QQ", head, RECORD.size)) if known else None


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


def _span(times: tuple[int, ...] | None) -> tuple[int, int] | None:
    """Log times a chunk says it covers, unless they contradict each other."""
    if times is None or not 0 <= times[0] <= times[1] < 2**63:
        return None
    return times[0], times[1]
