"""The messages of an MCAP file in stretches of bytes that are decoded together."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

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
from trialid.ingest.mcap.mcap_names import Names, Source
from trialid.ingest.mcap.mcap_records import CHUNK, Book, Loss, Record, chunk_span, records

STRETCH = 4 * 2**20
"""Bytes of messages that are decoded together: enough for numpy, little for the memory."""


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
        for run in _runs(records(file, size, book), book):
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
        book.losses.append(Loss(record.at, str(error), chunk_span(span), count))
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
