"""Damage beneath the checksum: a container is opened, damaged inside and closed again.

What is read then may be wrong by right, as the checksum fits: the writer itself was out of order,
or ill will wrote the file. It must not crash, hang or grow.
"""

import io
import struct
import zipfile
import zlib
from collections.abc import Callable

import lz4.frame
import zstandard
from damage import Rng, damaged

Seal = Callable[[bytes], bytes]

MCAP_CHUNK = 6
CHUNK_HEAD = struct.Struct("<QQQII")
PACKERS: dict[bytes, tuple[Seal, Seal]] = {
    b"": (bytes, bytes),
    b"zstd": (zstandard.ZstdDecompressor().decompress, zstandard.ZstdCompressor().compress),
    b"lz4": (lz4.frame.decompress, lz4.frame.compress),
}
BLF_HEADER = 144
LOG_CONTAINER = 10
MAT_HEADER = 128
MAT_PACKED = 15


def resealed(container: str, log: bytes, rng: Rng) -> bytes:
    """The log with one of its containers damaged inside; `container` is a key of `SEALS`."""
    count = SEALS[container](log, lambda number, content: content)[1]
    chosen = int(rng.integers(count))

    def harm(number: int, content: bytes) -> bytes:
        return damaged(content, rng) if number == chosen else content

    return SEALS[container](log, harm)[0]


Harm = Callable[[int, bytes], bytes]


def _mcap(log: bytes, harm: Harm) -> tuple[bytes, int]:
    """Chunks with their checksum anew; the index behind them no longer fits."""
    at, made, count = 8, [log[:8]], 0
    while at + 9 <= len(log) - 8:
        size = int.from_bytes(log[at + 1 : at + 9], "little")
        record = log[at + 9 : at + 9 + size]
        if log[at] == MCAP_CHUNK:
            record, count = _chunk(record, count, harm), count + 1
        made.append(log[at : at + 1] + struct.pack("<Q", len(record)) + record)
        at += 9 + size
    return b"".join([*made, log[at:]]), count


def _chunk(record: bytes, number: int, harm: Harm) -> bytes:
    start, end, _, _, length = CHUNK_HEAD.unpack_from(record)
    name = record[CHUNK_HEAD.size : CHUNK_HEAD.size + length]
    unpack, pack = PACKERS[name]
    content = harm(number, unpack(record[CHUNK_HEAD.size + length + 8 :]))
    packed = pack(content)
    head = CHUNK_HEAD.pack(start, end, len(content), zlib.crc32(content), length)
    return head + name + struct.pack("<Q", len(packed)) + packed


def _xlsx(log: bytes, harm: Harm) -> tuple[bytes, int]:
    made = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(log)) as old, zipfile.ZipFile(made, "w") as new:
        for number, member in enumerate(old.infolist()):
            name = zipfile.ZipInfo(member.filename)
            new.writestr(name, harm(number, old.read(member)), zipfile.ZIP_DEFLATED)
        count = len(old.infolist())
    return made.getvalue(), count


def _mat5(log: bytes, harm: Harm) -> tuple[bytes, int]:
    at, made, count = MAT_HEADER, [log[:MAT_HEADER]], 0
    while at + 8 <= len(log):
        kind, size = struct.unpack_from("<II", log, at)
        body = log[at + 8 : at + 8 + size]
        if kind == MAT_PACKED:
            body, count = zlib.compress(harm(count, zlib.decompress(body))), count + 1
        made.append(struct.pack("<II", kind, len(body)) + body)
        at += 8 + size
    return b"".join(made), count


def _blf(log: bytes, harm: Harm) -> tuple[bytes, int]:
    at, made, count = BLF_HEADER, [log[:BLF_HEADER]], 0
    while at + 32 <= len(log):
        size, kind = struct.unpack_from("<II", log, at + 8)
        body = log[at + 32 : at + size]
        if kind == LOG_CONTAINER:
            content = harm(count, zlib.decompress(body))
            body, count = zlib.compress(content), count + 1
            head = struct.pack("<H6xL4x", 2, len(content))
            size_now = 32 + len(body)
            made.append(struct.pack("<4sHHLL", b"LOBJ", 16, 1, size_now, kind) + head + body)
            made.append(bytes(size_now % 4))
        at += size + size % 4
    return b"".join(made), count


SEALS: dict[str, Callable[[bytes, Harm], tuple[bytes, int]]] = {
    "mcap": _mcap, "xlsx": _xlsx, "mat5": _mat5, "blf": _blf,
}  # fmt: skip
