"""ASAM MF4: what the other CAN logs of the same frames give, and what is refused."""

import importlib.util
import sys

import can
import numpy as np
import pytest
import write_can
from test_can_log import series

from trialid.errors import LogError
from trialid.ingest import LogFile, files_of, read
from trialid.ingest.can import mf4

pytestmark = [
    pytest.mark.skipif(importlib.util.find_spec("asammdf") is None, reason="asammdf is an extra"),
]


@pytest.fixture
def logs(tmp_path):
    """The same frames as candump and as MF4."""
    sent = write_can.frames(write_can.messages(series(300)))
    write_can.by_python_can(tmp_path / "text", sent, ".log")
    write_can.by_python_can(tmp_path / "binary", sent, ".mf4")
    return tmp_path / "text", tmp_path / "binary"


def test_the_same_frames_give_the_same_channels(logs):
    text, binary = map(read, logs)
    assert binary.adapter == "mf4"
    assert list(binary.channels) == list(text.channels)
    for one, other in zip(binary.channels.values(), text.channels.values(), strict=True):
        np.testing.assert_array_equal(one.y, other.y)
        np.testing.assert_array_equal(one.t, other.t)
    assert files_of(LogFile(logs[0].parent)) == tuple(sorted(logs))


def test_other_frames_are_counted_and_two_buses_are_two_sources(tmp_path):
    sent = write_can.frames(write_can.messages(series(20)))
    for i, one in enumerate(sent):
        one.channel = i % 2
    stamp = sent[-1].timestamp
    sent += [
        can.Message(timestamp=stamp, is_remote_frame=True, arbitration_id=5, dlc=0),
        can.Message(timestamp=stamp, is_error_frame=True, arbitration_id=0),
        can.Message(timestamp=stamp, is_fd=True, arbitration_id=7, data=bytes(16)),
    ]
    write_can.by_python_can(tmp_path / "log", sent, ".mf4")
    found = read(tmp_path / "log")
    assert any(name.startswith("rudder/CAN0.11") for name in found.channels)
    assert any("CAN1.11" in name for name in found.channels)
    assert any("1 error frames left out" in remark for remark in found.remarks)
    assert any("1 remote frames" in remark for remark in found.remarks)
    assert any("1 CAN FD frames" in remark for remark in found.remarks)


@pytest.mark.parametrize("share", [0.0003, 0.01, 0.1, 0.5, 0.9, 0.99])
@pytest.mark.study(turn="each")
def test_a_damaged_file_is_refused_or_gives_what_is_intact(logs, share, tmp_path):
    content = logs[1].read_bytes()
    whole = read(logs[1])
    (tmp_path / "cut").write_bytes(content[: max(int(share * len(content)), 64)])
    try:
        found = read(tmp_path / "cut")
    except LogError as error:
        assert "\n" not in str(error)  # noqa: PT017
        return
    for name, channel in found.channels.items():
        assert set(channel.y[np.isfinite(channel.y)]) <= set(whole.channels[name].y)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("import os; os.abort()", "the reader broke down on it"),
        ("import time; time.sleep(60)", "did not come back in 2 s"),
        ("while True: pass", "did not come to an end"),
        ("x = bytearray(1 << 36)", "MemoryError|the reader gave up"),
    ],
)
def test_a_reader_that_breaks_down_is_one_line(logs, tmp_path, monkeypatch, body, words):
    """It runs beside: here a package that does harm stands in the place of asammdf."""
    (tmp_path / "evil" / "asammdf").mkdir(parents=True)
    seconds = 1 if "while" in body else 60  # of which on a busy machine imports take one
    bound = f"import trialid.ingest.can.mf4_child as c; c._bound(2000, {seconds})"
    (tmp_path / "evil" / "asammdf" / "__init__.py").write_text(f"{bound}\n{body}\n")
    monkeypatch.syspath_prepend(str(tmp_path / "evil"))
    if "sleep" in body:
        monkeypatch.setattr(mf4, "LEAST_S", 1.0)
        monkeypatch.setattr(mf4, "LONGEST_WAIT", 1.0)
    with pytest.raises(LogError, match=words):
        read(logs[1])


def test_what_is_no_bus_is_refused_in_one_line(tmp_path):
    import asammdf

    mdf = asammdf.MDF(version="4.10")
    mdf.append([asammdf.Signal(np.arange(5.0), np.arange(5.0), name="rudder", unit="deg")])
    mdf.save(tmp_path / "signals.mf4")
    mdf.close()
    with pytest.raises(LogError, match="without frames of a CAN bus; export its signals as CSV"):
        read(tmp_path / "signals.mf4")
    (tmp_path / "old").write_bytes(b"MDF     3.30    " + bytes(200))
    with pytest.raises(LogError, match="a version before 4"):
        read(tmp_path / "old")


def test_without_the_package_the_extra_is_named(logs, monkeypatch):
    monkeypatch.setitem(sys.modules, "asammdf", None)
    with pytest.raises(LogError, match=r"ASAM MF4 needs the package asammdf.*trialid\[mf4\]"):
        read(logs[1])
