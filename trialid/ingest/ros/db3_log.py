"""rosbag2 databases (`.db3`): ROS 2 messages, one database a log.

What a type holds the newer bags say themselves; of the others the types that ROS comes with are
known to the library `rosbags`. A damaged database is read as far as SQLite goes.
"""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any, Final

from trialid.errors import LogError, reason_of
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, sha256
from trialid.ingest.mcap import mcap_channels
from trialid.ingest.mcap.mcap_names import Source
from trialid.ingest.packages import require
from trialid.ingest.ros.bag_shares import Message, shares, source
from trialid.recording import Recording

HEAD: Final = b"SQLite format 3\0"
LONGEST: Final = 1 << 26
"""Bytes of one message; an image has some millions."""
MOST_TOPICS: Final = 10_000
TURN: Final = 10_000
"""Steps of SQLite's machine after which it is asked whether to go on."""
STEPS_PER_BYTE: Final = 4
LATEST_NS: Final = 1 << 62
DEFINED: Final = (
    "SELECT topic_type, encoded_message_definition FROM message_definitions "
    "WHERE encoding = 'ros2msg'"
)


def recognises(head: bytes) -> bool:
    """The magic bytes of SQLite, and the definitions of rosbag2's tables."""
    return head.startswith(HEAD) and b"topic_id" in head and b"serialization_format" in head


def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read the wanted channels; LogError when not one message can be read."""
    del aids
    remarks: list[str] = []
    try:
        with closing(_opened(path)) as connection:
            sources = _sources(connection, path, remarks)
            messages = _messages(connection, sources, remarks)
            topics = mcap_channels.topics(path, shares(messages, sources), wanted, remarks)
    except (sqlite3.Error, UnicodeDecodeError) as error:  # words of a damaged schema
        raise LogError(
            f"{path}: SQLite cannot read it, {reason_of(error)}; copy it again"
        ) from error
    if not topics:
        why = f": {remarks[0]}" if remarks else "; the recorder wrote none"
        raise LogError(f"{path}: holds no message that can be read{why}")
    channels = mcap_channels.channels(topics, remarks)
    return Recording(path, ADAPTER.name, sha256(path), channels, tuple(remarks))


def _opened(path: Path) -> sqlite3.Connection:
    """The database, to read only; it is worked on no longer than its size explains."""
    uri = f"{path.resolve().as_uri()}?mode=ro&immutable=1"
    connection = sqlite3.connect(uri, uri=True)
    connection.text_factory = lambda raw: raw.decode("utf-8", "replace")
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LONGEST)
    turns = iter(range(100 + path.stat().st_size * STEPS_PER_BYTE // TURN))
    connection.set_progress_handler(lambda: next(turns, None) is None, TURN)
    return connection


def _sources(connection: sqlite3.Connection, path: Path, remarks: list[str]) -> dict[int, Source]:
    """The topics whose types are known, by the database's own numbers."""
    query = f"SELECT id, name, type, serialization_format FROM topics LIMIT {MOST_TOPICS}"
    own = _own_definitions(connection)
    store: Any = None
    found = {}
    for number, name, kind, form in connection.execute(query).fetchall():
        if form != "cdr" or not isinstance(number, int) or not 0 <= number < 1 << 16:
            remarks.append(f"{name}: left out, its messages are {form!r} and not cdr")
            continue
        definition = own.get(str(kind))
        if definition is None:
            store = store or _store(path)
            definition = _known(store, str(kind))
        if definition is None:
            remarks.append(f"{name}: left out, the bag does not say what {kind} holds")
        else:
            found[number] = source(number, str(name), str(kind), definition)
    return found


def _own_definitions(connection: sqlite3.Connection) -> dict[str, str]:
    """What the bag says of its types; bags before ROS 2 Iron have no such table."""
    try:
        rows = connection.execute(DEFINED).fetchall()
    except sqlite3.OperationalError:
        return {}
    return {str(kind): str(text) for kind, text in rows if text}


def _store(path: Path) -> Any:
    typesys = require("rosbags.typesys", path, "a bag that does not define its types", extra="ros")
    return typesys.get_typestore(typesys.Stores.LATEST)


def _known(store: Any, kind: str) -> str | None:
    """The definition of a type that ROS comes with."""
    if kind not in store.fielddefs:
        return None
    text: str = store.generate_msgdef(kind, ros_version=2)[0]
    return text


def _messages(
    connection: sqlite3.Connection, sources: dict[int, Source], remarks: list[str]
) -> Iterator[Message]:
    """Messages as they were recorded, of the known topics."""
    query = "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
    count = strange = 0
    try:
        for number, stamp, data in connection.execute(query):
            if number not in sources:
                continue
            sane = isinstance(stamp, int) and abs(stamp) < LATEST_NS and isinstance(data, bytes)
            strange += not sane
            count += sane
            if sane:
                yield number, stamp, data
    except sqlite3.Error as error:
        remarks.append(
            f"recovered {count} messages, then the database is damaged ({reason_of(error)})"
        )
    if strange:
        remarks.append(f"{strange} rows are no messages, left out")


ADAPTER = Adapter("rosbag2 db3", recognises, read)
