"""Bags of ROS: the same channels as of MCAP, damage, and the extra."""

import importlib.util
import sqlite3
import sys
from contextlib import closing

import numpy as np
import pytest
import write_mcap
import write_ros
from damage import damaged
from mcap.writer import CompressionType
from test_can_log import series

from trialid.errors import LogError
from trialid.ingest import read
from trialid.ingest.contract import broken_promises
from trialid.ingest.ros import bag_log, db3_log

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("rosbags") is None, reason="rosbags is an extra"
)
KINDS = {"bag": (write_ros.bag, bag_log), "db3": (write_ros.database, db3_log),
         "old": (write_ros.old_database, db3_log)}  # fmt: skip


@pytest.fixture(params=list(KINDS))
def log(request, tmp_path):
    write, module = KINDS[request.param]
    write(tmp_path / "log", series(300))
    return tmp_path / "log", module.ADAPTER


def test_the_promises_of_an_adapter_are_kept(log):
    path, adapter = log
    assert broken_promises(adapter, path) == []


def test_the_channels_are_those_of_mcap(log, tmp_path):
    write_mcap.ros2(CompressionType.NONE)(tmp_path / "mcap", series(300))
    one, other = read(log[0]), read(tmp_path / "mcap")
    assert one.channels.keys() == other.channels.keys()
    for name, channel in one.channels.items():
        same = other.channels[name]
        np.testing.assert_array_equal(channel.t, same.t)
        np.testing.assert_array_equal(channel.y, same.y)
        np.testing.assert_array_equal(channel.received, same.received)
        said = (channel.unit, channel.quantity, channel.positive, channel.clock)
        assert said == (same.unit, same.quantity, same.positive, same.clock)


@pytest.mark.parametrize("share", [0.05, 0.3, 0.6, 0.95])
def test_a_damaged_bag_gives_what_is_intact_or_one_line(log, share):
    path, _ = log
    content, whole = path.read_bytes(), read(path)
    at = int(share * len(content))
    for worse in (content[:at], content[:at] + b"\xa5" * 300 + content[at + 300 :]):
        path.write_bytes(worse)
        try:
            found = read(path)
        except LogError as error:
            assert "\n" not in str(error)  # noqa: PT017
            continue
        assert found.channels.keys() <= whole.channels.keys()


@pytest.mark.study(turn=15)
def test_random_damage_is_a_recording_or_one_line(log):
    path, _ = log
    content, rng = path.read_bytes(), np.random.default_rng(11)
    for _ in range(200):
        path.write_bytes(damaged(content, rng))
        try:
            read(path)
        except LogError as error:
            assert "\n" not in str(error)  # noqa: PT017


def test_a_type_nobody_defines_is_left_out_and_said(tmp_path):
    write_ros.old_database(tmp_path / "log", series(40))
    with closing(sqlite3.connect(tmp_path / "log")) as connection:
        connection.execute("UPDATE topics SET type = 'our_msgs/msg/Own' WHERE name = '/speed'")
        connection.commit()
    found = read(tmp_path / "log")
    assert "/speed: left out, the bag does not say what our_msgs/msg/Own holds" in found.remarks
    assert "/imu:angular_velocity.z" in found.channels
    assert not any(name.startswith("/speed") for name in found.channels)


def test_without_the_package_the_extra_is_named(tmp_path, monkeypatch):
    for name in ("bag", "db3", "old"):
        KINDS[name][0](tmp_path / name, series(20))
    for module in [name for name in sys.modules if name.partition(".")[0] == "rosbags"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "rosbags", None)
    assert read(tmp_path / "db3").channels  # it says itself what its types hold
    for name in ("bag", "old"):
        with pytest.raises(LogError, match=r"needs the package rosbags.*trialid\[ros\]"):
            read(tmp_path / name)
