"""ROS 1 bags (`.bag`) by the library `rosbags`, their messages brought to those of ROS 2."""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from trialid.errors import LogError, reason_of
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, sha256
from trialid.ingest.mcap import mcap_channels
from trialid.ingest.mcap.mcap_names import Source
from trialid.ingest.packages import require
from trialid.ingest.ros.bag_shares import Message, shares, source
from trialid.recording import Recording

MAGIC: Final = b"#ROSBAG V2.0\n"
DAMAGED: Final = (
    ValueError, LookupError, TypeError, AssertionError, ArithmeticError, OSError, MemoryError,
    EOFError, RuntimeError, struct.error,
)  # fmt: skip
"""What the library raises on a damaged bag, besides its own."""


SHARED: Final = ("std_msgs/msg/Header", "builtin_interfaces/msg/Time")
"""Types of which the library takes ROS 2's: it leaves out the count of a header by itself."""


def recognises(head: bytes) -> bool:
    """The first line of a bag."""
    return head.startswith(MAGIC)


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; LogError when not one message can be read."""
    del aids
    remarks: list[str] = []
    with _opened(path) as bag:
        store, sources = _sources(path, bag, remarks)
        messages = _messages(bag, store, sources, remarks)
        topics = mcap_channels.topics(path, shares(messages, sources), wanted, remarks)
    if not topics:
        why = f": {remarks[0]}" if remarks else "; the recorder wrote none"
        raise LogError(f"{path}: holds no message that can be read{why}")
    channels = mcap_channels.channels(topics, remarks)
    return Recording(path, ADAPTER.name, sha256(path), channels, tuple(remarks))


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    rosbag1 = require("rosbags.rosbag1", path, "a ROS 1 bag", extra="ros")
    bag = rosbag1.Reader(path)
    try:
        bag.open()
    except (*DAMAGED, rosbag1.ReaderError) as error:
        raise LogError(
            f"{path}: is no bag that can be read ({reason_of(error)}); a bag that was not closed "
            "is mended by `rosbag reindex`"
        ) from error
    try:
        yield bag
    finally:
        bag.close()


def _sources(path: Path, bag: Any, remarks: list[str]) -> tuple[Any, dict[int, Source]]:
    """The types that the bag defines, and its topics by their numbers."""
    typesys = require("rosbags.typesys", path, "a ROS 1 bag", extra="ros")
    store = typesys.get_typestore(typesys.Stores.EMPTY)
    newer = typesys.get_typestore(typesys.Stores.LATEST)
    store.register({kind: newer.fielddefs[kind] for kind in SHARED})
    found = {}
    for one in bag.connections:
        try:
            own = typesys.get_types_from_msg(one.msgdef.data, one.msgtype)
            store.register({kind: fields for kind, fields in own.items() if kind not in SHARED})
            definition = store.generate_msgdef(one.msgtype, ros_version=2)[0]
        except (*DAMAGED, typesys.TypesysError) as error:
            remarks.append(
                f"{one.topic}: left out, its definition cannot be read ({reason_of(error)})"
            )
            continue
        if 0 <= one.id < 1 << 16:
            found[one.id] = source(one.id, one.topic, one.msgtype, definition)
    return store, found


def _messages(
    bag: Any, store: Any, sources: dict[int, Source], remarks: list[str]
) -> Iterator[Message]:
    """Messages in the order of their stamps, brought to the layout of ROS 2."""
    from rosbags.rosbag1 import ReaderError
    from rosbags.serde import SerdeError

    count = strange = 0
    try:
        for connection, stamp, raw in bag.messages():
            if connection.id not in sources:
                continue
            try:
                payload = bytes(store.ros1_to_cdr(raw, connection.msgtype))
            except (*DAMAGED, SerdeError):
                strange += 1
                continue
            count += 1
            yield connection.id, stamp, payload
    except (*DAMAGED, ReaderError) as error:
        remarks.append(f"recovered {count} messages, then the bag is damaged ({reason_of(error)})")
    if strange:
        remarks.append(f"{strange} messages are not as their types define, left out")


ADAPTER = Adapter("rosbag", recognises, read)
