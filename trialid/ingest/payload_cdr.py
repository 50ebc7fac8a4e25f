"""ROS 2 payloads (CDR with `ros2msg` definitions), decoded a whole topic at a time.

Messages of one topic mostly have their numbers at the same places. So the first message is walked
field by field to learn the places; all messages with the same length and the same string and array
lengths then share that layout, and numpy lifts each column out at once. Messages of another layout
are walked in their turn. mcap-ros2-support decodes the same messages one by one; the tests hold
this file to it.
"""

import re
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.payload import LONGEST_ARRAY, STAMP_FIELDS, Column, Columns, Decoder, Keep

if TYPE_CHECKING:
    from mcap.records import Schema

NUMBERS = {
    "float32": "f4",
    "float64": "f8",
    "int8": "i1",
    "uint8": "u1",
    "byte": "u1",
    "char": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "int64": "i8",
    "uint64": "u8",
}
TIMES = frozenset({"builtin_interfaces/Time", "builtin_interfaces/Duration"})
HEADER = 4
"""Bytes of encapsulation before the data; alignment counts from there."""
BYTE_ORDERS = {b"\x00\x00": ">", b"\x00\x01": "<"}
"""Plain CDR; parameter lists and CDR 2 lay their fields out differently and are refused."""


@dataclass(frozen=True)
class Member:
    """One field of a message definition; `count` None: single, 0: any number, n: always n."""

    name: str
    kind: str
    count: int | None


@dataclass(frozen=True)
class Layout:
    """Where the numbers of a message lie.

    Parameters
    ----------
    order
        Byte order as numpy writes it.
    leaves
        Field name, byte offset and numpy type of every number.
    lengths
        Offset and bytes of every string and array length: messages that agree in them, and in
        their total length, share the layout.
    stamp
        Offsets of the message's own time, seconds first; empty when it has none.
    """

    order: str
    leaves: list[tuple[str, int, str]] = field(default_factory=list)
    lengths: list[tuple[int, bytes]] = field(default_factory=list)
    stamp: list[int] = field(default_factory=list)


class Malformed(ValueError):
    """A payload that does not fit its definition."""


def decoder(schema: "Schema | None") -> Decoder:
    """A decoder of the messages `schema` describes; ValueError when it is no `ros2msg`."""
    if schema is None or schema.encoding != "ros2msg":
        raise ValueError(f"its schema is {schema.encoding if schema else 'missing'}, not ros2msg")
    root = _full_name(schema.name, "")
    definitions = _definitions(root, schema.data.decode("utf-8", "replace"))

    def columns(payloads: Sequence[bytes], keep: Keep) -> Columns:
        return _columns(payloads, keep, definitions, root)

    return columns


def _definitions(root: str, text: str) -> dict[str, list[Member]]:
    """Every message definition in a schema text: the root's, then those after `MSG:` lines."""
    parts = re.split(r"^=+\s*^MSG:\s*(\S+)\s*$", text, flags=re.MULTILINE)
    named = [(root, parts[0]), *zip(parts[1::2], parts[2::2], strict=True)]
    return {
        _full_name(name, ""): list(_members(_full_name(name, ""), body)) for name, body in named
    }


MEMBER = re.compile(
    r"(?P<kind>[\w/]+)(?:<=\d+)?(?P<array>\[(?P<bounded><=)?(?P<count>\d*)\])?\s+(?P<name>\w+)"
    r"(?P<constant>\s*=)?"
)


def _members(owner: str, body: str) -> Iterator[Member]:
    for line in body.splitlines():
        found = MEMBER.match(line.split("#")[0].strip())
        if found is None or found["constant"]:
            continue
        always = found["array"] and not found["bounded"] and found["count"]
        count = int(found["count"]) if always else 0
        kind = _full_name(found["kind"], owner)
        yield Member(found["name"], kind, count if found["array"] else None)


def _full_name(kind: str, owner: str) -> str:
    """`package/Type` of a type as written inside `owner`; primitive types stay as they are."""
    package, _, short = kind.replace("/msg/", "/").rpartition("/")
    if package or short in NUMBERS or short in ("bool", "string", "wstring"):
        return f"{package}/{short}" if package else short
    return f"std_msgs/{short}" if short == "Header" else f"{owner.partition('/')[0]}/{short}"


class Walk:
    """One message walked field by field, noting in `layout` where its numbers lie."""

    def __init__(self, definitions: dict[str, list[Member]], payload: bytes) -> None:
        if payload[:2] not in BYTE_ORDERS:
            raise Malformed(f"CDR of kind {payload[:2].hex() or 'none'} is not supported")
        self.definitions = definitions
        self.payload = payload
        self.at = HEADER
        self.layout = Layout(BYTE_ORDERS[payload[:2]])

    def message(self, kind: str, prefix: str) -> None:
        """Walk the fields of a message of this kind."""
        if kind not in self.definitions:
            raise Malformed(f"the schema does not define {kind}")
        members = self.definitions[kind]
        if not members:
            self._skip(1, 1)  # IDL knows no empty structure: ROS 2 sends one byte instead
        for member in members:
            self._member(member, prefix + member.name)

    def _member(self, member: Member, path: str) -> None:
        if member.count is None:
            self._value(member.kind, path)
            return
        count = member.count or self._length()
        if member.kind in NUMBERS and count > LONGEST_ARRAY:
            size = int(NUMBERS[member.kind][1])
            self._skip(size, size * count)
            return
        for i in range(count):
            self._value(member.kind, f"{path}[{i}]")

    def _value(self, kind: str, path: str) -> None:
        if kind in NUMBERS:
            size = int(NUMBERS[kind][1])
            self.layout.leaves.append((path, self._skip(size, size), NUMBERS[kind]))
        elif kind == "bool":
            self._skip(1, 1)
        elif kind == "string":
            self._skip(1, self._length())
        elif kind in TIMES:
            self._time(kind, path)
        else:
            self.message(kind, f"{path}.")

    def _time(self, kind: str, path: str) -> None:
        offset = self._skip(4, 8)
        if kind == "builtin_interfaces/Time" and path in STAMP_FIELDS:
            self.layout.stamp.append(offset)

    def _length(self) -> int:
        offset = self._skip(4, 4)
        word = self.payload[offset : offset + 4]
        self.layout.lengths.append((offset, word))
        count: int = struct.unpack(f"{self.layout.order}I", word)[0]
        if count > len(self.payload):
            raise Malformed(f"a length of {count} in a message of {len(self.payload)} bytes")
        return count

    def _skip(self, alignment: int, size: int) -> int:
        """Offset of the next `size` bytes, after padding to the alignment."""
        offset = self.at + (HEADER - self.at) % alignment
        self.at = offset + size
        if self.at > len(self.payload):
            raise Malformed(f"the message ends after {len(self.payload)} bytes, inside a field")
        return offset


def _columns(
    payloads: Sequence[bytes], keep: Keep, definitions: dict[str, list[Member]], root: str
) -> Columns:
    stamp = np.zeros(len(payloads), np.int64)
    pieces: dict[str, list[Column]] = {}
    errors: list[str] = []
    todo = list(_alike(payloads))
    while todo:
        rows, table = todo.pop()
        try:
            layout = _layout(definitions, root, table[0].tobytes())
            same = _share(layout, table)
            _lift(layout, rows[same], table[same], keep, stamp, pieces)
        except Malformed as error:
            errors.append(str(error))
            same = np.arange(len(rows)) == 0
        if not same.all():
            todo.append((rows[~same], table[~same]))
    fields = {name: _joined(parts) for name, parts in pieces.items()}
    return Columns(stamp, fields, len(errors), errors[0] if errors else "")


def _layout(definitions: dict[str, list[Member]], root: str, payload: bytes) -> Layout:
    walk = Walk(definitions, payload)
    walk.message(root, "")
    return walk.layout


def _alike(payloads: Sequence[bytes]) -> Iterator[tuple[NDArray[np.intp], NDArray[np.uint8]]]:
    """Row numbers and bytes (n, length) of the payloads of equal length and byte order."""
    groups: dict[tuple[int, bytes], list[int]] = {}
    for row, payload in enumerate(payloads):
        groups.setdefault((len(payload), payload[:2]), []).append(row)
    for (length, _), rows in groups.items():
        joined = b"".join([payloads[row] for row in rows])
        yield np.array(rows), np.frombuffer(joined, np.uint8).reshape(len(rows), length)


def _share(layout: Layout, table: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """True for the messages whose string and array lengths are those of the layout; (n,)."""
    same = np.ones(len(table), np.bool_)
    for offset, word in layout.lengths:
        same &= (table[:, offset : offset + 4] == np.frombuffer(word, np.uint8)).all(axis=1)
    return same


def _lift(
    layout: Layout,
    rows: NDArray[np.intp],
    table: NDArray[np.uint8],
    keep: Keep,
    stamp: NDArray[np.int64],
    pieces: dict[str, list[Column]],
) -> None:
    """Lift the wanted columns out of messages of one layout."""
    for offset in layout.stamp[:1]:
        seconds = _numbers(table, offset, layout.order + "i4").astype(np.int64)
        nanos = _numbers(table, offset + 4, layout.order + "u4").astype(np.int64)
        stamp[rows] = seconds * 1_000_000_000 + nanos
    for name, offset, kind in layout.leaves:
        if keep(name):
            y = _numbers(table, offset, layout.order + kind).astype(np.float64)
            pieces.setdefault(name, []).append(Column(rows, y))


def _numbers(table: NDArray[np.uint8], offset: int, kind: str) -> NDArray[np.generic]:
    dtype = np.dtype(kind)
    return np.ascontiguousarray(table[:, offset : offset + dtype.itemsize]).view(dtype)[:, 0]


def _joined(parts: list[Column]) -> Column:
    """The pieces of one field in the order of the messages."""
    row = np.concatenate([part.row for part in parts])
    order = np.argsort(row, kind="stable")
    return Column(row[order], np.concatenate([part.y for part in parts])[order])
