"""Where the messages lie in a chunk of an MCAP file, or in any run of its records.

After a chunk the recorder writes, channel by channel, where its messages begin. These places are
taken as a hint: the records that begin there, and the few between them, must cover the chunk byte
by byte. Then the places are those one finds walking from record to record, and no message is
missing; otherwise the chunk is walked.
"""

import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trialid.ingest.bytes.unaligned import Places, numbers

RECORD = struct.Struct("<BQ")
"""Opcode, length of what follows."""
HEAD = struct.Struct("<QQQI")
"""Log times of a chunk's first and last message [ns], its size unpacked, its checksum; then the
name of the compression and the packed records, each behind its length."""
INDEX = struct.Struct("<HI")
"""Channel id and length of the pairs of log time [ns] and place in the chunk that follow."""

SCHEMA, CHANNEL, MESSAGE = 3, 4, 5
LARGEST = 128 * 2**20
"""Bytes of the largest chunk that is believed; recorders write chunks of 1 to 16 MiB."""
MESSAGE_HEAD = RECORD.size + 22
"""Bytes before a message's payload: opcode, length, channel id, sequence, log and publish time."""


class Damaged(ValueError):
    """Bytes that are not what their format says; the message says why."""


@dataclass(frozen=True)
class Chunk:
    """A chunk as it lies in the file; `span` are its log times [ns], `crc` 0 when it has none."""

    span: tuple[int, int]
    size: int
    crc: int
    compression: str
    packed: memoryview


@dataclass(frozen=True)
class Located:
    """Where records begin in a run of them: messages, and those that name schemas and channels."""

    messages: Places
    names: tuple[int, ...]


def parse_chunk(content: bytes) -> Chunk:
    """The chunk in a chunk record's content; Damaged when its lengths do not fit together."""
    try:
        first, last, size, crc = HEAD.unpack_from(content)
        at = HEAD.size
        (length,) = struct.unpack_from("<I", content, at)
        name = bytes(content[at + 4 : at + 4 + min(length, 16)])
        (packed,) = struct.unpack_from("<Q", content, at + 4 + length)
    except struct.error as error:
        raise Damaged("the chunk is shorter than its head") from error
    begin = at + 4 + length + 8
    if begin + packed != len(content):
        raise Damaged("the lengths in the chunk contradict each other")
    compression = name.decode("ascii", "replace")
    return Chunk((first, last), size, crc, compression, memoryview(content)[begin:])


def unpack_chunk(chunk: Chunk) -> bytes | memoryview:
    """The records of the chunk, which passed its checksum; Damaged when they do not."""
    if chunk.size > LARGEST:
        raise Damaged(f"the chunk says it holds {chunk.size / 1e6:.0f} MB, more than is believed")
    if chunk.compression == "":
        data: bytes | memoryview = chunk.packed
    elif chunk.compression == "zstd":
        data = _zstd(chunk)
    elif chunk.compression == "lz4":
        data = _lz4(chunk)
    else:
        raise Damaged(f"compression {chunk.compression!r} is none of zstd, lz4")
    if len(data) != chunk.size:
        raise Damaged(f"the chunk unpacks to {len(data)} bytes, not to the {chunk.size} it states")
    if chunk.crc and zlib.crc32(data) != chunk.crc:
        raise Damaged("the checksum of the chunk is wrong")
    return data


def _zstd(chunk: Chunk) -> bytes:
    """At most one byte more than stated: what unpacks to more is damaged, or a bomb."""
    import zstandard

    try:
        stated = zstandard.frame_content_size(chunk.packed)
        if stated not in (-1, chunk.size):
            raise Damaged(f"the chunk unpacks to {stated} bytes, not to the {chunk.size} it states")
        unpacker = zstandard.ZstdDecompressor()
        if stated == chunk.size:
            return unpacker.decompress(chunk.packed)
        with unpacker.stream_reader(chunk.packed) as stream:
            return stream.read(chunk.size + 1)
    except zstandard.ZstdError as error:
        raise Damaged(f"zstd: {error}") from error


def _lz4(chunk: Chunk) -> bytes:
    import lz4.frame

    try:
        unpacker = lz4.frame.LZ4FrameDecompressor()
        data: bytes = unpacker.decompress(chunk.packed, max_length=chunk.size + 1)
    except (RuntimeError, EOFError) as error:
        raise Damaged(f"lz4: {error}") from error
    return data


def locate_records(data: bytes | memoryview, indexes: Sequence[bytes]) -> Located:
    """Where the records of a run begin; Damaged when they do not fill it."""
    hinted = _hinted(indexes)
    found = None if hinted is None else _covered(data, hinted)
    return found or walk_records(data, 0, len(data))


def walk_records(data: bytes | memoryview, begin: int, end: int) -> Located:
    """Where the records from `begin` to `end` begin, walking from one to the next."""
    messages, names = [], []
    at, unpack = begin, RECORD.unpack_from
    while at < end:
        if end - at < RECORD.size:
            raise Damaged("the records in it do not fit")
        opcode, length = unpack(data, at)
        if opcode == MESSAGE and length >= MESSAGE_HEAD - RECORD.size:
            messages.append(at)
        elif opcode in (SCHEMA, CHANNEL):
            names.append(at)
        elif opcode in (0, MESSAGE):
            raise Damaged("what should be a record in it is none")
        at += RECORD.size + length
    if at != end:
        raise Damaged("the records in it do not fit")
    return Located(np.array(messages, np.int64), tuple(names))


def _hinted(indexes: Sequence[bytes]) -> Places | None:
    """Where the index records say messages begin, in order; None where they say nothing."""
    parts = []
    for content in indexes:
        if len(content) < INDEX.size:
            return None
        _, length = INDEX.unpack_from(content)
        if length % 16 or INDEX.size + length != len(content):
            return None
        parts.append(np.frombuffer(content, "<i8", offset=INDEX.size)[1::2])
    return np.sort(np.concatenate(parts)) if parts else None


def _covered(data: bytes | memoryview, at: Places) -> Located | None:
    """The hinted messages and what lies between them; None unless they fill the run."""
    if not len(at) or at[0] < 0 or at[-1] > len(data) - MESSAGE_HEAD:
        return None
    octets = np.frombuffer(data, np.uint8)
    lengths = numbers(octets, at + 1, "<i8").astype(np.int64)
    fits = (lengths >= MESSAGE_HEAD - RECORD.size) & (lengths <= len(data))
    if not (fits & (octets[at] == MESSAGE)).all():
        return None
    begins = np.append(at, len(data))
    ends = np.insert(at + RECORD.size + lengths, 0, 0)
    gaps = np.flatnonzero(ends != begins)
    names: list[int] = []
    for begin, end in zip(ends[gaps].tolist(), begins[gaps].tolist(), strict=True):
        try:
            between = walk_records(data, begin, end)
        except Damaged:
            return None
        if len(between.messages):
            return None
        names.extend(between.names)
    return Located(at, tuple(names))
