"""Where the numbers of a ROS 2 message lie: its `ros2msg` definition walked along its CDR bytes."""

import re
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from trialid.ingest.mcap.payload import LONGEST_ARRAY, NAMES_FIELDS, STAMP_FIELDS, labels

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
DEEPEST = 32
"""Messages inside messages; a definition that goes deeper holds itself."""


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
        Field names and byte offsets of the numbers, by numpy type.
    lengths
        Offset and value of every string and array length: messages that agree in them, and in
        their total length, share the layout.
    words
        Offset and bytes of what must agree besides: byte order, names of array elements.
    stamp
        Offsets of the message's own time, seconds first; empty when it has none.
    """

    order: str
    leaves: dict[str, list[tuple[str, int]]] = field(default_factory=dict)
    lengths: list[tuple[int, int]] = field(default_factory=list)
    words: list[tuple[int, bytes]] = field(default_factory=list)
    stamp: list[int] = field(default_factory=list)


class Malformed(ValueError):
    """A payload that does not fit its definition."""


def parse_definitions(root: str, text: str) -> dict[str, list[Member]]:
    """Every message definition in a schema text: the root's, then those after `MSG:` lines."""
    parts = re.split(r"^=+\s*^MSG:\s*(\S+)\s*$", text, flags=re.MULTILINE)
    named = [(root, parts[0]), *zip(parts[1::2], parts[2::2], strict=True)]
    return {full_name(name, ""): list(_members(full_name(name, ""), body)) for name, body in named}


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
        kind = full_name(found["kind"], owner)
        yield Member(found["name"], kind, count if found["array"] else None)


def full_name(kind: str, owner: str) -> str:
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
        self.depth = 0
        self.unheard = 0
        self.layout = Layout(BYTE_ORDERS[payload[:2]], words=[(0, payload[:2])])

    def message(self, kind: str, prefix: str) -> None:
        """Walk the fields of a message of this kind."""
        if kind not in self.definitions:
            raise Malformed(f"the schema does not define {kind}")
        if self.depth == DEEPEST:
            raise Malformed(f"{kind} lies more than {DEEPEST} messages deep")
        self.depth += 1
        members = self.definitions[kind]
        if not members:
            self._skip(1, 1)  # IDL knows no empty structure: ROS 2 sends one byte instead
        names: list[str] = []
        for member in members:
            if member.name in NAMES_FIELDS and member.kind == "string" and member.count is not None:
                names = self._names(member)
            else:
                self._member(member, prefix + member.name, names)
        self.depth -= 1

    def _names(self, member: Member) -> list[str]:
        """What the elements of the arrays beside are called; none when they cannot be told."""
        words = [self._text() for _ in range(member.count or self._length())]
        found = labels([word.decode("utf-8", "replace") for _, word in words])
        if found is None or len(found) > LONGEST_ARRAY:
            return []
        self.layout.words.extend(words)
        return found

    def _member(self, member: Member, path: str, names: Sequence[str]) -> None:
        if member.count is None:
            self._value(member.kind, path)
            return
        count = member.count or self._length()
        if member.kind in NUMBERS and count > LONGEST_ARRAY:
            size = int(NUMBERS[member.kind][1])
            self._skip(size, size * count)
            return
        if count > len(self.payload):
            raise Malformed(f"an array of {count} in a message of {len(self.payload)} bytes")
        self.unheard += count > LONGEST_ARRAY
        for i in range(count):
            self._value(member.kind, f"{path}[{names[i] if len(names) == count else i}]")
        self.unheard -= count > LONGEST_ARRAY

    def _value(self, kind: str, path: str) -> None:
        if kind in NUMBERS:
            size = int(NUMBERS[kind][1])
            offset = self._skip(size, size)
            if not self.unheard:
                self.layout.leaves.setdefault(NUMBERS[kind], []).append((path, offset))
        elif kind == "bool":
            self._skip(1, 1)
        elif kind == "string":
            self._text()
        elif kind in TIMES:
            self._time(kind, path)
        else:
            self.message(kind, f"{path}.")

    def _text(self) -> tuple[int, bytes]:
        """Offset and bytes of a string, without the zero at its end."""
        size = self._length()
        offset = self._skip(1, size)
        return offset, self.payload[offset : offset + size].rstrip(b"\0")

    def _time(self, kind: str, path: str) -> None:
        offset = self._skip(4, 8)
        if kind == "builtin_interfaces/Time" and path in STAMP_FIELDS:
            self.layout.stamp.append(offset)

    def _length(self) -> int:
        offset = self._skip(4, 4)
        count: int = struct.unpack_from(f"{self.layout.order}I", self.payload, offset)[0]
        self.layout.lengths.append((offset, count))
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
