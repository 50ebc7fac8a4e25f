"""PX4 ULog: names, stamps and sides, damage, and the extra."""

import importlib.util
import sys

import numpy as np
import pytest
import write_ulog
from damage import damaged
from test_can_log import series

from trialid.errors import LogError
from trialid.ingest import read, ulog_log
from trialid.ingest.contract import broken_promises
from trialid.inspection import inspect_log

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("pyulog") is None, reason="pyulog is an extra"
)


@pytest.fixture
def path(tmp_path):
    (tmp_path / "log").write_bytes(write_ulog.log(write_ulog.samples(series(400))))
    return tmp_path / "log"


def test_the_promises_of_an_adapter_are_kept(path):
    assert broken_promises(ulog_log.ADAPTER, path) == []


def test_channels_stamps_and_sides(path):
    found = read(path).channels
    t, y = series(400)["r"]
    rate = found["vehicle_angular_velocity:xyz[2]"]
    np.testing.assert_allclose(rate.y, y, rtol=1e-6)
    np.testing.assert_array_equal(rate.t, t // 1000 * 1000)
    np.testing.assert_array_equal(rate.received - rate.t, write_ulog.LATE * 1000)
    assert (rate.quantity, rate.unit, rate.positive) == ("r", "rad/s", "starboard")
    assert "vehicle_local_position:heading_good_for_control" not in found
    known = inspect_log(path)
    assert known.sources("phi")[0].key == "vehicle_attitude:q (roll)"
    turns = [one for one in known.channels.values() if one.key == "vehicle_attitude:q (yaw)"]
    assert all(one.guess.positive != "port" for one in turns)


def test_two_instances_of_a_topic_are_two_sources(tmp_path):
    one = write_ulog.log(write_ulog.samples(series(50)))
    place = len(write_ulog.TOPICS)
    second = write_ulog.message("A", b"\x01" + bytes([place, 0]) + b"rudder_feedback")
    data = write_ulog.message("D", bytes([place, 0]) + np.array([7], "<u8").tobytes() + bytes(4))
    (tmp_path / "log").write_bytes(one + second + data)
    names = read(tmp_path / "log").channels
    assert {"rudder_feedback/0:angle", "rudder_feedback/1:angle"} <= set(names)


@pytest.mark.parametrize("share", [0.001, 0.02, 0.3, 0.77])
def test_a_log_that_is_cut_or_damaged_gives_what_is_intact(path, share, capsys):
    content, whole = path.read_bytes(), read(path)
    at = int(share * len(content))
    for worse in (content[:at], content[:at] + b"\xff\x00\x13" * 20 + content[at + 60 :]):
        path.write_bytes(worse)
        try:
            found = read(path)
        except LogError as error:
            assert "\n" not in str(error)  # noqa: PT017
            continue
        for name, channel in found.channels.items():
            near = np.isin(channel.y, whole.channels[name].y) if name in whole.channels else None
            assert near is None or near.sum() >= len(channel.y) - 3
    assert capsys.readouterr() == ("", "")


def test_random_damage_is_a_recording_or_one_line(path):
    content, rng = path.read_bytes(), np.random.default_rng(11)
    for _ in range(300):
        path.write_bytes(damaged(content, rng))
        try:
            read(path)
        except LogError as error:
            assert "\n" not in str(error)  # noqa: PT017


def test_without_the_package_the_extra_is_named(path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyulog", None)
    with pytest.raises(LogError, match=r"PX4 ULog needs the package pyulog.*trialid\[px4\]"):
        read(path)
