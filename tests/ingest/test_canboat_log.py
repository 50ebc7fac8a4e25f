"""NMEA 2000 as text: what canboat, Yacht Devices and Actisense gateways write."""

import numpy as np
import pytest
import write_can
from nmea2000.decoder import NMEA2000Decoder

from trialid.errors import LogError
from trialid.ingest import read

DAY = 86_400_000_000_000
RUDDER = "rudder/11/0:position"
PAYLOAD = bytes.fromhex("00F8FF7FE803FFFF")
LONG = bytes(range(21))
"""A message of group 127237, which needs four frames."""


def log(tmp_path, lines):
    path = tmp_path / "log"
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    return path


def fast_frames(sequence):
    stream = bytes([len(LONG)]) + LONG
    parts = [stream[k : k + 7].ljust(7, b"\xff") for k in range(0, len(stream), 7)]
    return [bytes([sequence << 5 | k]) + part for k, part in enumerate(parts)]


def canboat(data, pgn=127245, stamp="2016-02-28T19:57:02.364Z"):
    return f"{stamp},2,{pgn},11,255,{len(data)},{data.hex(',')}"


@pytest.mark.parametrize(
    "stamp", ["2016-02-28T19:57:02.364Z", "2016-02-28-19:57:02.364", "2016-02-28T19:57:02.364"]
)
def test_stamps_of_canboat_are_utc(tmp_path, stamp):
    channel = read(log(tmp_path, ["# comment", canboat(PAYLOAD, stamp=stamp)])).channels[RUDDER]
    assert channel.t.tolist() == [1_456_689_422_364_000_000]
    assert (channel.y.tolist(), channel.clock) == ([0.1], "line stamps")


def test_whole_messages_and_frames_give_the_same(tmp_path):
    whole = read(log(tmp_path, ["# format=FAST", canboat(LONG, 127237), canboat(PAYLOAD)]))
    frames = [canboat(frame, 127237) for frame in fast_frames(3)]
    plain = read(log(tmp_path, [*frames[:2], canboat(PAYLOAD), *frames[2:]]))
    assert set(whole.channels) == set(plain.channels)
    assert plain.channels["heading_control/11:rudder_order"].y.tolist() == [0.1027]
    for name, channel in whole.channels.items():
        np.testing.assert_array_equal(plain.channels[name].y, channel.y)
    lost = read(log(tmp_path, [*frames[:2], canboat(PAYLOAD), *frames[3:]]))
    assert list(lost.channels) == [RUDDER]
    assert lost.remarks[0] == "1 of 1 messages of several frames lack a frame, left out"


def test_lines_that_are_no_messages_are_counted(tmp_path):
    good = canboat(PAYLOAD)
    lines = [
        good,
        good.replace("2016-02-28", "2016-02-30"),
        good.replace("19:57", "24:57"),
        good.replace("127245", "12724x"),
        good.replace(",8,", ",9,"),
        good.replace("f8", "g8"),
        good.replace(",11,", ",311,"),
        good.replace("ff,7f", "ff,,7f"),
        good[:40],
        "garbage",
        good,
    ]
    recording = read(log(tmp_path, lines))
    assert len(recording.channels[RUDDER].y) == 2
    assert recording.remarks[0] == "9 of 11 lines are no messages, left out"


def test_yacht_devices_over_midnight(tmp_path):
    identifier = f"{write_can.identifier(127245):08X}"
    times = ("23:59:59.900", "00:00:00.100", "23:59:59.950", "00:00:00.200")
    data = PAYLOAD.hex(" ").upper()
    lines = [f"{time} R {identifier} {data}" for time in times]
    channel = read(log(tmp_path, lines)).channels[RUDDER]
    assert ((channel.t - DAY) // 1_000_000).tolist() == [-100, 100, -50, 200]
    assert channel.clock == "line stamps (time of the day, no date)"


def test_yacht_devices_fast_packets_as_the_oracle_joins_them(tmp_path):
    identifier = f"{write_can.identifier(127237):08X}"
    lines = [f"10:00:00.100 R {identifier} {frame.hex(' ').upper()}" for frame in fast_frames(5)]
    decoder = NMEA2000Decoder()
    (theirs,) = [message for line in lines if (message := decoder.decode(line)) is not None]
    order = read(log(tmp_path, lines)).channels["heading_control/11:rudder_order"]
    assert order.y[0] == pytest.approx(theirs.get_field_by_id("commandedRudderAngle").value)


def test_actisense_as_the_oracle_reads_it(tmp_path):
    line = f"A173321.107 {11:02X}FF7 {127245:05X} {PAYLOAD.hex().upper()}"
    theirs = NMEA2000Decoder().decode(line)
    channel = read(log(tmp_path, [line])).channels[RUDDER]
    assert channel.y[0] == pytest.approx(theirs.get_field_by_id("position").value)
    assert theirs.source == 11
    assert channel.t.tolist() == [((17 * 60 + 33) * 60 * 1000 + 21_107) * 1_000_000]


def test_only_the_wanted(tmp_path):
    lines = [canboat(PAYLOAD), canboat(bytes(8), 127251)]
    assert list(read(log(tmp_path, lines), ["rudder/11"]).channels) == [RUDDER]


def test_nothing_but_damage_is_one_line(tmp_path):
    with pytest.raises(LogError, match="none of its 2 lines is a canboat line") as info:
        read(log(tmp_path, [canboat(PAYLOAD).replace("f8", "g8")] * 2))
    assert "\n" not in str(info.value)
