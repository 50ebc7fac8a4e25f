"""Protobuf messages of one type whose numbers lie at the same places, lifted out by numpy.

A message is walked tag by tag to learn its layout: which bytes are tags and lengths, and how long
each variable-length number is. Messages that have the same bytes there are of the same layout. Only
messages made of single numbers, texts and messages of such are laid out; lists, maps and choices
are not.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.unaligned import Bytes, Places, numbers

if TYPE_CHECKING:
    from google.protobuf.descriptor import Descriptor, FieldDescriptor

Numbers = NDArray[np.generic]

VARINT, FIXED64, DELIMITED, FIXED32 = 0, 1, 2, 5
FIXED = {1: "<f8", 2: "<f4", 6: "<u8", 7: "<u4", 15: "<i4", 16: "<i8"}
"""Numpy types of double, float, fixed64, fixed32, sfixed32, sfixed64, by the type's number."""
VARINTS: dict[int, Callable[[NDArray[np.uint64]], Numbers]] = {
    3: lambda raw: raw.view(np.int64),
    4: lambda raw: raw,
    5: lambda raw: raw.astype(np.uint32).view(np.int32),
    13: lambda raw: raw.astype(np.uint32),
    14: lambda raw: raw.astype(np.uint32).view(np.int32),
    17: lambda raw: _zigzag(raw.astype(np.uint32).astype(np.uint64)),
    18: lambda raw: _zigzag(raw),  # noqa: PLW0108 (it is defined below)
}
"""How int64, uint64, int32, uint32, enum, sint32 and sint64 are told from what was sent."""
BOOL, STRING, MESSAGE, BYTES = 8, 9, 11, 12
PLAIN = frozenset({*FIXED, *VARINTS, BOOL, STRING, MESSAGE, BYTES})
LONGEST = 4096
"""Bytes of a message that is laid out."""
DEEPEST = 16
MOST_FIELDS = 10_000
LONGEST_VARINT = 10


class Unusual(ValueError):
    """A message that has no layout: it may still be one the library can read."""


@dataclass(frozen=True)
class Leaf:
    """A number: its type's number, where it begins, how long it is; no length where it is 0."""

    path: str
    kind: int
    at: int = 0
    length: int = 0


@dataclass
class Layout:
    """Where the numbers of a message of `size` bytes lie.

    `pinned` are the bits that messages of this layout have in common, `mask` which those are.
    """

    size: int
    pinned: NDArray[np.uint8]
    mask: NDArray[np.uint8]
    leaves: list[Leaf] = field(default_factory=list)

    def pin(self, payload: bytes, begin: int, end: int, bits: int = 0xFF) -> None:
        """Messages of this layout have these bits in common with the payload."""
        self.mask[begin:end] |= bits
        self.pinned[begin:end] |= np.frombuffer(payload[begin:end], np.uint8) & np.uint8(bits)

    def share(self, data: Bytes, at: Places) -> NDArray[np.bool_]:
        """True for the messages of this size, from `at` on, that are of this layout; (n,)."""
        rows = data[at[:, None] + np.arange(self.size)]
        same: NDArray[np.bool_] = ((rows & self.mask) == self.pinned).all(axis=1)
        return same


def lays_out(descriptor: "Descriptor") -> bool:
    """True when messages of this type are made of single numbers, texts and such messages.

    False also of types within types without end, and of more fields in all than anybody sends:
    ten of a type in each of ten levels are ten thousand million.
    """
    level, fields = {descriptor.full_name: (descriptor, 1)}, 0
    for _ in range(DEEPEST):
        inside = [(one, many) for kind, many in level.values() for one in kind.fields]
        fields += sum(many for _, many in inside)
        if fields > MOST_FIELDS or not all(_single(one) for one, _ in inside):
            return False
        level = {}
        for one, many in inside:
            inner = one.message_type
            if inner is not None:
                before = level.get(inner.full_name, (inner, 0))[1]
                level[inner.full_name] = inner, before + many
        if not level:
            return True
    return False


def _single(field: "FieldDescriptor") -> bool:
    alone = field.containing_oneof is None or len(field.containing_oneof.fields) == 1
    return field.type in PLAIN and not field.is_repeated and alone


def layout(descriptor: "Descriptor", payload: bytes) -> Layout:
    """The layout of this message; Unusual when it has none."""
    if len(payload) > LONGEST:
        raise Unusual("too long")
    size = len(payload)
    found = Layout(size, np.zeros(size, np.uint8), np.zeros(size, np.uint8))
    found.leaves.extend(_walk(descriptor, payload, 0, size, "", found))
    return found


def _walk(
    descriptor: "Descriptor", payload: bytes, at: int, end: int, prefix: str, found: Layout
) -> Iterator[Leaf]:
    """The numbers of a message that lies between `at` and `end`, in the order of the type."""
    leaves: dict[int, list[Leaf]] = {}
    while at < end:
        tag, behind = _varint(payload, at, end)
        found.pin(payload, at, behind)
        one = descriptor.fields_by_number.get(tag >> 3)
        if one is None or one.number in leaves:
            raise Unusual("a field that is unknown or stands twice")
        at, leaves[one.number] = _field(
            one=one, wire=tag & 7, payload=payload, at=behind, end=end, prefix=prefix, found=found
        )
    for one in descriptor.fields:
        if one.number in leaves:
            yield from leaves[one.number]
        elif not one.has_presence and (one.type in FIXED or one.type in VARINTS):
            yield Leaf(prefix + one.name, one.type)


def _field(
    one: "FieldDescriptor",
    wire: int,
    payload: bytes,
    at: int,
    end: int,
    prefix: str,
    found: Layout,
) -> tuple[int, list[Leaf]]:
    """Where the field ends, and its numbers."""
    path = prefix + one.name
    if one.type in FIXED and wire == (FIXED64 if FIXED[one.type][-1] == "8" else FIXED32):
        behind = at + int(FIXED[one.type][-1])
        leaves = [Leaf(path, one.type, at, behind - at)]
    elif (one.type in VARINTS or one.type == BOOL) and wire == VARINT:
        _, behind = _varint(payload, at, end)
        found.pin(payload, at, behind, 0x80)
        leaves = [Leaf(path, one.type, at, behind - at)] if one.type != BOOL else []
    elif one.type in (STRING, BYTES, MESSAGE) and wire == DELIMITED:
        length, begin = _varint(payload, at, end)
        found.pin(payload, at, begin)
        behind = begin + length
        inner = one.message_type
        if behind <= end and inner is not None:
            leaves = list(_walk(inner, payload, begin, behind, f"{path}.", found))
        else:
            leaves = []
    else:
        raise Unusual("a field that is not sent as its type says")
    if behind > end:
        raise Unusual("cut short")
    return behind, leaves


def _varint(payload: bytes, at: int, end: int) -> tuple[int, int]:
    """A number of variable length, and where it ends."""
    value = 0
    for i in range(LONGEST_VARINT):
        if at + i >= end:
            break
        byte = payload[at + i]
        value |= (byte & 0x7F) << 7 * i
        if byte < 0x80:
            return value, at + i + 1
    raise Unusual("a number without an end")


def values(leaf: Leaf, data: Bytes, at: Places) -> Numbers:
    """The numbers of a leaf in messages of its layout that begin at `at`; (n,)."""
    if not leaf.length:
        return np.zeros(len(at), np.int64)
    if leaf.kind in FIXED:
        return numbers(data, at + leaf.at, FIXED[leaf.kind])
    raw = np.zeros(len(at), np.uint64)
    for i in range(leaf.length):
        raw |= (data[at + leaf.at + i].astype(np.uint64) & np.uint64(0x7F)) << np.uint64(7 * i)
    return VARINTS[leaf.kind](raw)


def _zigzag(raw: NDArray[np.uint64]) -> NDArray[np.int64]:
    half = (raw >> np.uint64(1)).view(np.int64)
    return half ^ -(raw & np.uint64(1)).view(np.int64)
