"""Lines of text on a clock as `foxglove.Log` messages, which plot tools list beside the curves."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from google.protobuf.message import Message

NAME: Final = "foxglove.Log"
LEVELS: Final = ("UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL")
INFO: Final = LEVELS.index("INFO")
WARNING: Final = LEVELS.index("WARNING")
TEXTS: Final = {"message": 3, "name": 4, "file": 5}


@dataclass(frozen=True)
class Line:
    """One line: when [ns], how grave (an index of `LEVELS`), and what."""

    t: int
    level: int
    text: str


@cache
def message() -> "type[Message]":
    """The message type, with the field numbers of Foxglove's schema."""
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2

    stamp = timestamp_pb2.DESCRIPTOR
    package, _, short = NAME.rpartition(".")
    file = descriptor_pb2.FileDescriptorProto(
        name=f"{NAME}.proto", package=package, syntax="proto3", dependency=[stamp.name]
    )
    made = file.message_type.add(name=short)
    kind = descriptor_pb2.FieldDescriptorProto
    one = kind.LABEL_OPTIONAL
    level = made.enum_type.add(name="Level")
    for number, word in enumerate(LEVELS):
        level.value.add(name=word, number=number)
    time, enum = ".google.protobuf.Timestamp", f".{NAME}.Level"
    made.field.add(name="timestamp", number=1, label=one, type=kind.TYPE_MESSAGE, type_name=time)
    made.field.add(name="level", number=2, label=one, type=kind.TYPE_ENUM, type_name=enum)
    for name, number in TEXTS.items():
        made.field.add(name=name, number=number, label=one, type=kind.TYPE_STRING)
    made.field.add(name="line", number=6, label=one, type=kind.TYPE_FIXED32)
    pool = descriptor_pool.DescriptorPool()
    pool.AddSerializedFile(stamp.serialized_pb)
    pool.AddSerializedFile(file.SerializeToString())
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(NAME))


def encode(lines: Sequence[Line]) -> Iterator[tuple[int, bytes]]:
    """Time [ns] and message of every line, in the order of time."""
    for line in sorted(lines, key=lambda line: line.t):
        one: Any = message()()
        one.timestamp.seconds, one.timestamp.nanos = divmod(line.t, 10**9)
        one.level, one.message, one.name = line.level, line.text, "trialid"
        yield line.t, one.SerializeToString()
