"""The messages of a dataflash log, found block by block, and columns gathered from them.

A message is taken when another one, or the end of the file, follows it exactly: dataflash has no
checksum, so this is all that tells a whole message from a torn one. Memory is that of the columns
asked for, whatever the size of the file.
"""

import functools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.adapter import State, state
from trialid.ingest.bytes.linked_records import Places, Stretch, linked_starts
from trialid.ingest.mavlink.dataflash_layout import (
    CODES,
    FMT,
    FMT_LAYOUT,
    FMT_LENGTH,
    FMT_START,
    HEADER,
    Layout,
    layout,
)

BLOCK = 1 << 22
"""Bytes read at once."""

Lengths = NDArray[np.int64]


@dataclass(frozen=True)
class Hole:
    """Bytes that are no message, and the times since boot around them [us] where known."""

    at: int
    size: int
    before: int | None
    after: int | None


class Growing:
    """One column as it is filled: in one piece, so that it is never in memory twice."""

    def __init__(self, code: str) -> None:
        self.space: NDArray[Any] = np.empty(0, code)
        self.count = 0

    def add(self, part: NDArray[Any]) -> None:
        """Put more values behind those there are."""
        count = self.count + len(part)
        if count > len(self.space):
            self.space.resize(count + count // 4, refcheck=False)
        self.space[self.count : count] = part
        self.count = count

    def all(self) -> NDArray[Any]:
        """All values; (N,)."""
        return self.space[: self.count]


@dataclass
class Gathered:
    """What a walk found: raw columns by message type, counts of all types, and holes."""

    columns: dict[int, dict[int, Growing]]
    counts: NDArray[np.int64] = field(default_factory=lambda: np.zeros(256, np.int64))
    holes: list[Hole] = field(default_factory=list)
    size: int = 0

    def column(self, number: int, index: int) -> NDArray[Any]:
        """One column in the order of the log; (N,)."""
        return self.columns[number][index].all()


@dataclass(frozen=True)
class Block:
    """Some bytes of the file and the messages in them."""

    data: NDArray[np.uint8]
    at: int
    starts: Places
    holes: tuple[tuple[int, int], ...]


def layouts(path: Path) -> tuple[dict[int, Layout], tuple[str, ...]]:
    """Message types by number, from FMT messages anywhere in the file, and what was odd.

    Of two different meanings of a number the first one stays. Looked for once in a log that is
    read in batches.
    """
    found, odd = _layouts(state(path))
    return dict(found), odd


@functools.lru_cache(maxsize=4)
def _layouts(of: State) -> tuple[Mapping[int, Layout], tuple[str, ...]]:
    found, odd = {FMT: FMT_LAYOUT}, {}
    for message in _fmt_messages(of[0]):
        one = layout(message)
        if one is not None and found.setdefault(one.number, one) != one and one.number != FMT:
            odd[one.number] = f"type {one.number} is both {found[one.number].name} and {one.name}"
    return found, tuple(odd.values())


def _fmt_messages(path: Path) -> Iterator[bytes]:
    with path.open("rb") as file:
        kept = b""
        while more := file.read(BLOCK):
            data = kept + more
            at = data.find(FMT_START)
            while 0 <= at <= len(data) - FMT_LENGTH:
                yield data[at : at + FMT_LENGTH]
                at = data.find(FMT_START, at + 1)
            kept = data[max(0, len(data) - FMT_LENGTH + 1) :]


def gather(path: Path, known: Mapping[int, Layout], asked: Mapping[int, Sequence[int]]) -> Gathered:
    """The columns asked for by message type, in one pass through the file."""
    empty = {
        number: {i: Growing(CODES[known[number].codes[i]]) for i in indices}
        for number, indices in asked.items()
    }
    gathered = Gathered(empty, size=path.stat().st_size)
    clocks = np.zeros(256, bool)
    clocks[[number for number, one in known.items() if one.clock == "TimeUS"]] = True
    before: int | None = None
    for block in _blocks(path, known):
        types = block.data[block.starts + 2]
        gathered.counts += np.bincount(types, minlength=256)
        _take(gathered, known, block, types)
        before = _note_holes(gathered, block, clocks[types], before)
    return gathered


def _blocks(path: Path, known: Mapping[int, Layout]) -> Iterator[Block]:
    lengths = np.zeros(256, np.int64)
    lengths[list(known)] = [one.length for one in known.values()]
    size = path.stat().st_size
    with path.open("rb") as file:
        at, reached, kept = 0, 0, np.empty(0, np.uint8)
        while at < size:
            more = np.fromfile(file, np.uint8, BLOCK)
            data = np.concatenate([kept, more])
            final = at + len(data) >= size or not len(more)
            starts, nexts = _starts(data, lengths)
            closing = _closing(data) if final else None
            found = linked_starts(starts, nexts, Stretch(reached - at, len(data), closing, HEADER))
            holes, reached = found.holes, found.reached + at
            if final and found.reached < (closing or 0):
                holes = (*holes, (found.reached, len(data)))
            yield Block(data, at, starts[found.kept], holes)
            kept = data[found.resume :].copy()
            at += found.resume
            if final:
                return


def _starts(data: NDArray[np.uint8], lengths: Lengths) -> tuple[Places, Places]:
    """Places that look like a message of a known type, and where each would end."""
    if len(data) < HEADER:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    starts = np.flatnonzero((data[:-2] == FMT_START[0]) & (data[1:-1] == FMT_START[1]))
    length = lengths[data[starts + 2]]
    return starts[length > 0], (starts + length)[length > 0]


def _closing(data: NDArray[np.uint8]) -> int:
    """Where the last message may end: a flash page is filled up with 00 or FF."""
    end = len(data)
    if not end or data[-1] not in {0x00, 0xFF}:
        return end - HEADER + 1
    other = np.flatnonzero(data != data[-1])
    return int(other[-1]) + 1 if len(other) else 0


def _take(
    gathered: Gathered, known: Mapping[int, Layout], block: Block, types: NDArray[np.uint8]
) -> None:
    """Put the columns of this block to those before."""
    order = np.argsort(types, kind="stable")
    edges = np.searchsorted(types[order], np.arange(257))
    for number, columns in gathered.columns.items():
        starts = block.starts[order[edges[number] : edges[number + 1]]]
        if not len(starts):
            continue
        one = known[number]
        for i, column in columns.items():
            column.add(_column(block.data, starts, one.offsets[i], CODES[one.codes[i]]))


def _column(data: NDArray[np.uint8], starts: Places, offset: int, code: str) -> NDArray[Any]:
    """The values `offset` bytes after each start; numpy copies them unaligned as they lie."""
    kind = np.dtype(code)
    count = len(data) - offset - kind.itemsize + 1
    everywhere: NDArray[Any] = np.ndarray((count,), kind, data.data, offset, (1,))
    return everywhere[starts]


def _note_holes(
    gathered: Gathered, block: Block, timed: NDArray[np.bool_], before: int | None
) -> int | None:
    """Put the holes with the times around them; gives the last time of this block [us]."""
    starts = block.starts[timed]
    for begin, end in block.holes:
        i = int(np.searchsorted(starts, begin))
        left = _time(block.data, starts, i - 1) if i else before
        right = _time(block.data, starts, i) if i < len(starts) else None
        gathered.holes.append(Hole(block.at + begin, end - begin, left, right))
    return _time(block.data, starts, len(starts) - 1) if len(starts) else before


def _time(data: NDArray[np.uint8], starts: Places, i: int) -> int:
    place = int(starts[i]) + HEADER
    return int.from_bytes(data[place : place + 8].tobytes(), "little")
