"""Bags of ROS by the library `rosbags`: the messages of the MCAP logs, in its other containers."""

import shutil
import sqlite3
import tempfile
from collections.abc import Mapping
from contextlib import closing
from importlib.util import find_spec
from pathlib import Path

from write_mcap import KINDS, LATE, ROS2_SOURCES, _ros2_messages, _written, encoder
from written import Format, Series, Written


def messages(series: Mapping[str, Series]) -> list[tuple[int, str, bytes]]:
    """Stamp of the recorder, topic, payload in CDR."""
    return [
        (stamp + LATE, topic, encoder(topic)(content))
        for stamp, topic, content in _ros2_messages(series)
    ]


def bag(path: Path, series: Mapping[str, Series]) -> Written:
    """A bag of ROS 1."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store, newer = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
    header = store.types["std_msgs/msg/Header"]  # with a count, which ROS 2 dropped
    there = path.with_suffix(".bag")
    with Writer(there) as writer:
        topics = {
            topic: writer.add_connection(f"/{topic}", kind, typestore=store)
            for topic, (kind, _) in KINDS.items()
        }
        for stamp, topic, payload in messages(series):
            kind = KINDS[topic][0]
            content = newer.deserialize_cdr(payload, kind)
            counted = header(0, content.header.stamp, content.header.frame_id)
            object.__setattr__(content, "header", counted)
            writer.write(topics[topic], stamp, bytes(store.serialize_ros1(content, kind)))
    there.rename(path)
    return _written(series, ROS2_SOURCES, dict.fromkeys(series, 1e-12))


def database(path: Path, series: Mapping[str, Series]) -> Written:
    """A database of rosbag2 that defines its types."""
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, "bag")
        with Writer(place, version=9) as writer:
            topics = {
                topic: writer.add_connection(f"/{topic}", kind, typestore=store)
                for topic, (kind, _) in KINDS.items()
            }
            for stamp, topic, payload in messages(series):
                writer.write(topics[topic], stamp, payload)
        (found,) = place.glob("*.db3")
        shutil.copyfile(found, path)
    return _written(series, ROS2_SOURCES, dict.fromkeys(series, 1e-12))


def old_database(path: Path, series: Mapping[str, Series]) -> Written:
    """One of ROS 2 Humble and before, which names its types without defining them."""
    written = database(path, series)
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("DROP TABLE message_definitions")
        connection.commit()
    return written


FORMATS: tuple[Format, ...] = (
    (Format("rosbag", bag), Format("rosbag2", database), Format("rosbag2, old", old_database))
    if find_spec("rosbags")
    else ()
)
