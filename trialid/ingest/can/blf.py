"""BLF files of Vector's tools to frames.

A file header, then objects `LOBJ`: containers, packed with zlib, whose contents laid end to end are
again objects, of which the CAN messages are read. A container that is cut, or whose checksum fails,
is left out, and the reading goes on at the next.
"""

import dataclasses
import mmap
import struct
import zlib
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest.bytes.bounds import Cost
from trialid.ingest.bytes.text_fields import Ints
from trialid.ingest.can.can_frames import (
    EXTENDED_ID,
    Frames,
    Tally,
    date_stamps,
    join_frames,
    select_frames,
)

OBJECT = b"LOBJ"
CONTAINER, MESSAGE, MESSAGE2, ERROR, ERROR_EXT, FLEXIBLE, FLEXIBLE_64 = 10, 1, 86, 2, 73, 100, 101
ZLIB = 2
BASE = struct.Struct("<4sHHLL")
"""Signature, size of the header, its version, size and type of the object."""
STATISTICS = struct.Struct("<4sLBBBBBBBBQQLL8H8H")
"""Signature, size of the header, application and its version, sizes, count, start, end."""
LARGEST = 1 << 24
"""Bytes a container unpacks to at most; Vector's hold 128 kB."""
BLOCK = 1 << 22
"""Bytes of unpacked objects that are read at once."""
HEAD = 32
"""Bytes of an object with a stamp at least: 16 of the base header, 16 with the stamp."""
OWN = 16
"""Bytes of a CAN message after its headers."""
PACKED = 32
"""Bytes of a container before what it contains."""
MESSAGES = (MESSAGE, MESSAGE2)
BODIES = {1: 32, 2: 40}
"""Where an object's own bytes begin, by the version of its header."""
LATEST_NS = 1 << 62
EXTENDED_FLAG, REMOTE_FLAG = 0x8000_0000, 0x80
TEN_MICROSECONDS = 1


def frames(path: Path, zone: str | None, tally: Tally) -> tuple[Frames, str]:
    """The data frames of the file, and words for their clock; LogError when there is none."""
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        if len(data) < STATISTICS.size:
            raise LogError(f"{path}: is a BLF file cut within its header; copy it again")
        header = STATISTICS.unpack_from(data)
        parts, lost = _parts(data, max(header[1], STATISTICS.size), tally, Cost(path))
        size = len(data)
    whole = join_frames(parts)
    _damage(header, size, lost, len(whole), tally)
    if not len(whole):
        why = f": {tally.remarks[0]}" if tally.remarks else ""
        raise LogError(f"{path}: holds no CAN message that can be read{why}; copy it again")
    start = _start(header[14:22])
    if start is None:
        return whole, "object stamps (since the start; no date)"
    t, words = date_stamps(whole.t + start, zone, tally)
    return dataclasses.replace(whole, t=t), f"object stamps ({words})"


def _parts(data: mmap.mmap, at: int, tally: Tally, cost: Cost) -> tuple[list[Frames], int]:
    """Frames of the containers, block by block, and how many containers were lost."""
    parts: list[Frames] = []
    rest, lost = b"", 0
    for unpacked, whole in _containers(data, at):
        cost.unpacks(len(unpacked))
        cost.holds(unpacked.count(OBJECT))
        rest += unpacked
        if len(rest) >= BLOCK or not whole:
            part, used = _objects(rest, tally)
            parts.append(part)
            rest = rest[used:] if whole else b""
            lost += not whole
    parts.append(_objects(rest, tally)[0])
    return parts, lost


def _containers(data: mmap.mmap, at: int) -> Iterator[tuple[bytes, bool]]:
    """Unpacked contents of each object of the file, and whether it is whole."""
    while (at := data.find(OBJECT, at)) >= 0 and at + BASE.size <= len(data):
        _, _, _, size, kind = BASE.unpack_from(data, at)
        body, end = at + PACKED, at + size
        if size < PACKED:
            yield b"", False
            at += len(OBJECT)
        elif kind != CONTAINER:
            yield data[at:end], end <= len(data)
            at = end
        elif int.from_bytes(data[at + BASE.size : at + BASE.size + 2], "little") != ZLIB:
            yield data[body:end], end <= len(data)
            at = end
        else:
            unpack = zlib.decompressobj()
            try:
                content = unpack.decompress(data[body:end], LARGEST)
            except zlib.error:
                yield b"", False
                at += len(OBJECT)
                continue
            yield content if unpack.eof else b"", unpack.eof  # the checksum stands at its end
            at = max(body, min(end, len(data)) - len(unpack.unused_data)) if unpack.eof else body


def _objects(content: bytes, tally: Tally) -> tuple[Frames, int]:
    """Frames of objects laid end to end, and how many bytes of them were read."""
    runs: list[tuple[int, int, int]] = []
    at = 0
    while True:
        found = content.find(OBJECT, at)
        if found < 0:
            at = max(at, len(content) - len(OBJECT) + 1)
            break
        at = found
        if at + BASE.size > len(content):
            break
        _, _, version, size, kind = BASE.unpack_from(content, at)
        if not _least(kind, version) <= size <= LARGEST:
            tally.lines, tally.strange = tally.lines + 1, tally.strange + 1
            at += len(OBJECT)
            continue
        if at + size > len(content):
            break
        count = 1
        if kind in MESSAGES and version in BODIES:
            count = _alike(content, at, size)
            whole = count - (not _follows(content, at + size * count))
            tally.lines, tally.strange = tally.lines + count - whole, tally.strange + count - whole
            if whole:
                runs.append((at, size, whole))
        else:
            tally.errors += kind in (ERROR, ERROR_EXT)
            tally.flexible += kind in (FLEXIBLE, FLEXIBLE_64)
        at += size * count
    return join_frames([_run(content, *run, tally) for run in runs]), at


def _least(kind: int, version: int) -> int:
    """Bytes an object of this type must have."""
    return BODIES.get(version, HEAD) + OWN if kind in MESSAGES else HEAD


def _follows(content: bytes, end: int) -> bool:
    """True when an object ends here: the next begins, after padding, or the contents end.

    Otherwise the object began before a container that is lost, and ended behind it.
    """
    return end + 7 > len(content) or content.find(OBJECT, end, end + 7) >= 0


def _alike(content: bytes, at: int, size: int) -> int:
    """How many objects from here on have the same size, type and version; at least one."""
    ahead = 8
    while True:
        count = min(ahead, (len(content) - at) // size)
        heads = np.frombuffer(content, np.uint8, count * size, at).reshape(count, size)[:, :16]
        differs = np.flatnonzero((heads != heads[0]).any(axis=1))
        if len(differs):
            return int(differs[0])
        if count < ahead:
            return count
        ahead *= 4


def _run(content: bytes, at: int, size: int, count: int, tally: Tally) -> Frames:
    """Frames of a run of like CAN messages."""
    table = np.frombuffer(content, np.uint8, count * size, at).reshape(count, size)
    body = BODIES[int(table[0, 6])]

    def column(place: int, kind: str) -> Ints:
        width = np.dtype(kind).itemsize
        return np.ascontiguousarray(table[:, place : place + width]).view(kind)[:, 0].astype("i8")

    tick = np.where(column(16, "<u4") == TEN_MICROSECONDS, 10_000, 1)
    stamp = column(24, "<i8")
    can_id, remote = column(body + 4, "<u4"), table[:, body + 2] & REMOTE_FLAG > 0
    sane = (stamp >= 0) & (stamp < LATEST_NS // tick)
    tally.lines += count
    tally.strange += int(np.sum(~sane))
    tally.remote += int(np.sum(remote & sane))
    good = sane & ~remote
    bus = np.minimum(column(body, "<u2"), 255)
    length = np.minimum(table[:, body + 3], 8).astype(np.int64)
    data = np.where(np.arange(8) < length[:, None], table[:, body + 8 : body + 16], 0)
    names = tuple(f"CAN{n}" for n in range(int(bus.max()) + 1))
    extended = can_id & EXTENDED_FLAG > 0
    return select_frames(
        Frames(
            t=stamp * tick,
            can_id=can_id & EXTENDED_ID,
            extended=extended,
            table=data,
            length=length,
            bus=bus,
            buses=names,
        ),
        good,
    )


def _start(date: tuple[int, ...]) -> int | None:
    """The start of the measurement [ns since 1970]; None where there is none."""
    year, month, _, day, hour, minute, second, milli = date
    try:
        whole = datetime(year, month, day, hour, minute, second, tzinfo=UTC)
    except ValueError:
        return None
    if not 1970 <= year < 2250 or milli > 999:
        return None
    return int(whole.timestamp()) * 1_000_000_000 + milli * 1_000_000


def _damage(header: tuple[int, ...], size: int, lost: int, count: int, tally: Tally) -> None:
    """Remarks where the file says it was longer, or was never finished."""
    stated_size, objects = header[10], header[12]
    if not objects:
        tally.remarks.append(
            f"the file was never closed by its recorder: recovered {count} frames, the last ones "
            "it held may be missing"
        )
    elif stated_size != size or lost:
        parts = f", {lost} of its containers are damaged" if lost else ""
        tally.remarks.append(
            f"recovered {count} frames of {objects} objects: the file has {size} bytes, its header "
            f"says {stated_size}{parts}"
        )
