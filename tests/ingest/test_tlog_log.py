import random
import re
import struct

import numpy as np
import pytest
import write_tlog as w
from damage import damaged
from hypothesis import given, settings
from hypothesis import strategies as st
from known_motion import SERIES, check_comes_back
from pymavlink.dialects.v20 import all as dialect

from trialid.errors import LogError
from trialid.ingest import adapter_of, read
from trialid.ingest.mavlink import tlog_log

START = 1_700_000_000_000_000
"""Receive time of the first frame [us]."""
BOOT = 60_000
COUNT = 200


def attitude(boot_ms, roll=0.0):
    return dialect.MAVLink_attitude_message(boot_ms % 2**32, roll, 0, 0, 0, 0, 0)


def steady(log, by, *, first=BOOT, at=START, count=COUNT):
    """ATTITUDE at 20 Hz, received 80 ms late."""
    for k in range(count):
        log.add(at + 50_000 * k + 80_000, attitude(first + 50 * k, k / 100), by)
    return log


def saved(tmp_path, log):
    path = tmp_path / "log"
    path.write_bytes(log if isinstance(log, bytes | bytearray) else log.content())
    return read(path)


def remark(recording, text):
    (found,) = (one for one in recording.remarks if text in one)
    return found


def test_a_trial_comes_back(tmp_path):
    check_comes_back(w.FORMATS[0], tmp_path / "log")


def test_channels_say_what_they_are(tmp_path):
    found = saved(tmp_path, steady(w.Log(), w.sender())).channels["ATTITUDE/1/1:roll"]
    assert (found.unit, found.quantity, found.positive) == ("rad", "phi", "starboard")
    assert found.clock == "boot clock time_boot_ms"
    assert np.array_equal(found.t, (BOOT + 50 * np.arange(COUNT)) * 10**6)
    assert np.array_equal(found.received, (START + 80_000 + 50_000 * np.arange(COUNT)) * 1000)
    assert found.y == pytest.approx(np.arange(COUNT) / 100, abs=1e-6)


@pytest.mark.parametrize("kind", ["v1", "v2", "signed"])
def test_all_kinds_of_frames(tmp_path, kind):
    log, by = w.Log(), w.sender()
    if kind == "signed":
        by.signing.secret_key, by.signing.sign_outgoing = b"k" * 32, True
        by.signing.timestamp = 1
    for k in range(COUNT):
        log.add(START + 1000 * k, attitude(BOOT + k, k / 7), by, v1=kind == "v1")
    found = saved(tmp_path, log)
    assert found.channels["ATTITUDE/1/1:roll"].y == pytest.approx(np.arange(COUNT) / 7, rel=1e-6)
    assert not any("checksum" in one or "recovered" in one for one in found.remarks)


def test_zeros_cut_off_the_end_are_put_back(tmp_path):
    log, by = w.Log(), w.sender()
    for k in range(5):
        log.add(START + k, w.servo_output(10**6 + k, *([1500 + k] * (4 * k))), by)
    channels = saved(tmp_path, log).channels
    assert channels["SERVO_OUTPUT_RAW/1/1:servo5_raw"].y.tolist() == [0, 0, 1502, 1503, 1504]
    assert channels["SERVO_OUTPUT_RAW/1/1:servo16_raw"].y.tolist() == [0, 0, 0, 0, 1504]


@pytest.mark.parametrize("hours", [0, 1.1931, 5.0])
def test_microseconds_that_wrap_every_71_minutes(tmp_path, hours):
    """The wrap lies in the log, and before its beginning; its counter has only 32 bits."""
    log, by = w.Log(), w.sender()
    first = round(hours * 3600e3)
    steady(log, by, first=first)
    for k in range(COUNT):
        log.add(START + 50_000 * k + 90_000, w.servo_output((first + 50 * k) * 1000, 1500), by)
    found = saved(tmp_path, log).channels["SERVO_OUTPUT_RAW/1/1:servo1_raw"]
    assert np.array_equal(found.t, (first + 50 * np.arange(COUNT)) * 10**6)


def test_a_wrap_while_the_recorder_paused(tmp_path):
    log, by = w.Log(), w.sender()
    for at in (0, 5 * 3600):
        steady(log, by, first=BOOT + 1000 * at, at=START + at * 10**6, count=20)
        log.add(START + (at + 1) * 10**6, w.servo_output((BOOT + 1000 * at) * 1000, 1500), by)
    found = saved(tmp_path, log).channels["SERVO_OUTPUT_RAW/1/1:servo1_raw"]
    assert np.diff(found.t).tolist() == [5 * 3600 * 10**9]


def test_milliseconds_that_wrap_after_49_days(tmp_path):
    found = saved(tmp_path, steady(w.Log(), w.sender(), first=2**32 - 3000))
    channel = found.channels["ATTITUDE/1/1:roll"]
    assert np.array_equal(channel.t, (2**32 - 3000 + 50 * np.arange(COUNT)) * 10**6)
    assert not any("restarted" in one for one in found.remarks)


def test_messages_without_time_get_that_of_their_neighbours(tmp_path):
    """Received with the latency of their neighbours, which wanders by 0.4 s."""
    log, by = w.Log(), w.sender()
    for k in range(COUNT):
        late = 80_000 + round(4e5 * np.sin(k / 30) ** 2)
        log.add(START + 50_000 * k + late, attitude(BOOT + 50 * k), by)
        hud = dialect.MAVLink_vfr_hud_message(0, k, 0, 0, 0, 0)
        log.add(START + 50_000 * k + 20_000 + late, hud, by)
    found = saved(tmp_path, log).channels["VFR_HUD/1/1:groundspeed"]
    order = np.argsort(found.y)
    error = found.t[order] / 1e6 - (BOOT + 50 * np.arange(COUNT) + 20)
    assert np.abs(error).max() < 10
    assert "interpolated between ATTITUDE time_boot_ms" in found.clock
    assert found.received is not None


def test_a_restart_is_told_and_kept_apart(tmp_path):
    log, by = steady(w.Log(), w.sender()), w.sender()
    for name, value in w.SERVO.items():
        log.add(START + 500, w.parameter(f"SERVO1_{name}", value), by)
    log.add(START + 600, w.heartbeat(), by)
    later = START + 100_000_000
    steady(log, by, first=2_000, at=later)
    log.add(later + 200_000, dialect.MAVLink_vfr_hud_message(0, 1, 0, 0, 0, 0), by)
    log.add(later + 300_000, w.servo_output(2_220_000, 1920), by)
    found = saved(tmp_path, log)
    assert "1/1: restarted 1 times (received 2023-11-14 22:15:00)" in remark(found, "restart")
    second = found.channels["ATTITUDE/1/1/boot2:roll"]
    assert second.t[0] == 2_000 * 10**6
    assert len(found.channels["ATTITUDE/1/1:roll"].t) == len(second.t) == COUNT
    assert found.channels["VFR_HUD/1/1/boot2:groundspeed"].t == pytest.approx(2_120e6, abs=1e6)
    assert found.channels["servo/1/1/1/boot2:deflection"].y == -1.0


def test_one_frame_out_of_place_is_no_restart(tmp_path):
    log, by = steady(w.Log(), w.sender()), w.sender()
    log.add(START + 5_000_000, attitude(BOOT + 60_000), by)
    log.add(START + 7_000_000, attitude(BOOT - 30_000), by)
    found = saved(tmp_path, log)
    assert len(found.channels["ATTITUDE/1/1:roll"].t) == COUNT + 2
    assert not any("restarted" in one for one in found.remarks)


def test_senders_are_channels_of_their_own(tmp_path):
    log = steady(w.Log(), w.sender())
    steady(log, w.sender(1, 2), first=5 * BOOT)
    steady(log, w.sender(7, 1), first=9 * BOOT)
    log.add(START, dialect.MAVLink_manual_control_message(1, 3, 0, 0, 0, 0), w.sender(255, 190))
    channels = saved(tmp_path, log).channels
    firsts = [channels[f"ATTITUDE/{one}:roll"].t[0] for one in ("1/1", "1/2", "7/1")]
    assert firsts == [BOOT * k * 10**6 for k in (1, 5, 9)]
    pilot = channels["MANUAL_CONTROL/255/190:x"]
    assert pilot.clock == "receive time, the sender states none"
    assert pilot.t == START * 1000
    assert pilot.received is None


def test_instances_and_names_are_channels_of_their_own(tmp_path):
    log, by = steady(w.Log(), w.sender()), w.sender()
    for i in (0, 1):
        message = dialect.MAVLink_battery_status_message(i, 0, 0, 32767, [65535] * 10, 5, 0, 0, 0)
        log.add(START, message, by)
    log.add(START, dialect.MAVLink_named_value_float_message(BOOT, b"tilt/x", 0.5), by)
    channels = saved(tmp_path, log).channels
    assert channels["BATTERY_STATUS/1/1:current_battery"].y == 5
    assert np.isnan(channels["BATTERY_STATUS/1/1/1:voltages[3]"].y)
    assert np.isnan(channels["BATTERY_STATUS/1/1/1:temperature"].y)
    assert channels["NAMED_VALUE_FLOAT/1/1/tilt_x:value"].y == 0.5


def test_what_stands_for_not_known_is_no_number(tmp_path):
    log, by = w.Log(), w.sender()
    for k, hdg in enumerate((35999, 65535)):
        message = dialect.MAVLink_global_position_int_message(BOOT + k, 0, 0, 0, 0, 0, 0, 0, hdg)
        log.add(START + k, message, by)
    found = saved(tmp_path, log).channels["GLOBAL_POSITION_INT/1/1:hdg"]
    assert found.y[0] == 359.99
    assert np.isnan(found.y[1])
    assert found.unit == "deg"


def test_servo_outputs_of_the_second_port(tmp_path):
    log, by = steady(w.Log(), w.sender()), w.sender()
    for name, value in w.SERVO.items():
        log.add(START, w.parameter(f"SERVO18_{name}", value), by)
    log.add(START + 1, w.servo_output(BOOT * 1000, 1, 1275, port=1), by)
    log.add(START + 2, w.servo_output(BOOT * 1000, 1, 1100, port=0), by)
    found = saved(tmp_path, log).channels["servo/1/1/18:deflection"]
    assert found.y == 0.5  # reversed, half way from trim 1450 to 1100
    assert found.unit is None


def test_without_parameters_no_deflection_and_a_reason(tmp_path):
    log, by = steady(w.Log(), w.sender()), w.sender()
    log.add(START, w.heartbeat(), by)
    found = saved(tmp_path, log)
    assert "no SERVOn_FUNCTION parameter" in remark(found, "deflection")
    assert not any(name.startswith("servo") for name in found.channels)


def test_modes_dates_and_receive_times_are_told(tmp_path):
    log, by = steady(w.Log(), w.sender()), w.sender()
    for second, mode in ((1, 0), (4, 10), (8, 0)):
        log.add(START + second * 10**6, w.heartbeat(mode, armed=second > 1), by)
    unix = 1_699_999_000_000_000
    log.add(START, dialect.MAVLink_system_time_message(unix, 60_000), by)
    found = saved(tmp_path, log)
    assert "MANUAL from 60.9 s, AUTO from 63.9 s, MANUAL from 67.9 s" in remark(found, "MANUAL")
    assert "disarmed from 60.9 s, armed from 63.9 s" in remark(found, "armed from")
    assert "0 s is about 2023-11-14 21:55:40 UTC by SYSTEM_TIME" in remark(found, "boot clock 0")
    assert "received 2023-11-14 22:13:20 to" in remark(found, "ground station")


def whole():
    log, by = steady(w.Log(), w.sender()), w.sender(1, 1)
    for k in range(COUNT // 4):
        log.add(START + 200_000 * k + 90_000, w.servo_output(BOOT * 1000 + k, 1500 + k), by)
    return log.content()


WHOLE = whole()


def samples(path, content):
    path.write_bytes(content)
    try:
        recording = tlog_log.read(path)
    except LogError as error:
        return {}, (str(error),)
    found = {
        name: list(zip(one.t.tolist(), one.y.tolist(), strict=True))
        for name, one in recording.channels.items()
    }
    return found, recording.remarks


class Samples(dict):
    """Too long to be printed."""

    def __repr__(self):
        return "the samples of the whole log"


@pytest.fixture(scope="module")
def true(tmp_path_factory):
    return Samples(samples(tmp_path_factory.mktemp("whole") / "log", WHOLE)[0])


def check_true(found, true):
    """Every sample is one of the whole log; of stamps there are no more than were sent."""
    for named, pairs in found.items():
        name = re.sub("/boot[0-9]+", "", named)  # blocks mixed up may look like a restart
        assert {y for _, y in pairs} <= {y for _, y in true[name]}
        if name.startswith("ATTITUDE"):
            assert set(pairs) <= set(true[name])


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.integers(0, len(WHOLE) - 1), st.integers(0, 7))
def test_a_flipped_bit_is_never_read_silently(tmp_path_factory, true, at, bit):
    content = bytearray(WHOLE)
    content[at] ^= 1 << bit
    found, remarks = samples(tmp_path_factory.mktemp("flip") / "log", content)
    check_true(found, true)
    lost = sum(map(len, true.values())) - sum(map(len, found.values()))
    assert not lost or any("left out" in one or "recovered" in one for one in remarks)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.integers(40, len(WHOLE)))
def test_a_log_cut_short_gives_all_frames_before_the_cut(tmp_path_factory, true, cut):
    found, _ = samples(tmp_path_factory.mktemp("cut") / "log", WHOLE[:cut])
    pairs = found["ATTITUDE/1/1:roll"]
    assert pairs == true["ATTITUDE/1/1:roll"][: len(pairs)]
    assert len(pairs) >= (cut / len(WHOLE) - 0.02) * COUNT


def test_garbage_between_frames_costs_nothing_and_is_told(tmp_path, true):
    middle = WHOLE.index(struct.pack(">Q", START + 50_000 * 100 + 80_000))
    garbage = bytes([0xFD, 0xFE, 0x10]) * 200
    found, remarks = samples(tmp_path / "log", WHOLE[:middle] + garbage + WHOLE[middle:])
    assert found == true
    assert any("lost 2023-11-14 22:13:25-22:13:25" in one for one in remarks)


def test_a_broken_receive_stamp_moves_no_sample(tmp_path):
    content = bytearray(WHOLE)
    for k in (0, 31, 90, 199):
        content[content.index(struct.pack(">Q", START + 50_000 * k + 80_000))] ^= 0x40
    found, _ = samples(tmp_path / "log", content)
    assert found == samples(tmp_path / "log", WHOLE)[0]


def test_messages_of_no_dialect_are_counted(tmp_path):
    log, by = steady(w.Log(), w.sender()), w.sender()
    frame = bytearray(attitude(5).pack(by))
    frame[7:10] = (15_000_000).to_bytes(3, "little")
    log.rows.append((START + 10**6, struct.pack(">Q", START + 10**6) + frame))
    found = saved(tmp_path, log)
    assert "1 messages of numbers no MAVLink dialect here knows, left out: 15000000" in (
        remark(found, "dialect")
    )
    assert len(found.channels["ATTITUDE/1/1:roll"].t) == COUNT


def test_wanted_channels_only(tmp_path):
    w.write(tmp_path / "log", SERIES)
    everything = read(tmp_path / "log")
    wanted = ["ATTITUDE/1/1:roll", "servo/", "GLOBAL"]
    some = read(tmp_path / "log", wanted)
    assert set(some.channels) == {n for n in everything.channels if n.startswith(tuple(wanted))}
    assert len(some.channels) > 3


def test_only_this_adapter_recognises_it(tmp_path):
    for content in (WHOLE, WHOLE[37:], WHOLE[: WHOLE.index(b"\xfd", 60) - 8]):
        (tmp_path / "log").write_bytes(content)
        assert adapter_of(tmp_path / "log") is tlog_log.ADAPTER


@pytest.mark.parametrize(
    "head", [b"t,u\n1,2\n", b"\x89MCAP0\r\n" + bytes(50), bytes(4096), b"\xfd"]
)
def test_what_is_none_is_not_recognised(head):
    assert not tlog_log.recognises(head)


def test_noise_is_not_recognised():
    by = random.Random(1)
    assert not any(tlog_log.recognises(by.randbytes(4096)) for _ in range(50))


def test_a_log_without_a_good_frame_is_refused(tmp_path):
    content = bytearray(WHOLE)
    for at in [i for i, byte in enumerate(content) if byte == 0xFD]:
        content[at + 3 : at + 5] = b"??"
    with pytest.raises(LogError, match="no frame with a valid checksum"):
        saved(tmp_path, content)


def test_damage_of_any_kind_gives_no_wrong_sample(tmp_path, true):
    for seed in range(60):
        rng = np.random.default_rng(seed)
        content = damaged(WHOLE, rng, 20, b"\xfd\xff\x01" + bytes(8))
        found, remarks = samples(tmp_path / "log", content)
        check_true(found, true)
        assert not any("\n" in one for one in remarks)
