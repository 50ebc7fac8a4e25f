import struct

import numpy as np
import pytest
import write_dataflash as w
from damage import damaged
from hypothesis import given, settings
from hypothesis import strategies as st
from known_motion import SERIES, check_comes_back

from trialid.errors import LogError
from trialid.ingest import adapter_of, read
from trialid.ingest.mavlink import dataflash_log, dataflash_walk

OPENING = w.description() + w.parameters(w.servo()) + w.packed(w.MSG, 3, "ArduRover V4.5.7")
COUNT = 400


def att(k):
    return w.packed(w.ATT, 1_000_000 + 20_000 * k, 0, k / 100, 0, 0, 0, k / 10)


ROWS = [att(k) for k in range(COUNT)]


def log(tmp_path, content):
    path = tmp_path / "log"
    path.write_bytes(content)
    return read(path)


def remark(recording, text):
    (found,) = (one for one in recording.remarks if text in one)
    return found


def test_a_trial_comes_back(tmp_path):
    check_comes_back(w.FORMATS[0], tmp_path / "log")


def test_channels_say_what_they_are(tmp_path):
    found = log(tmp_path, OPENING + b"".join(ROWS)).channels["ATT:Roll"]
    assert (found.unit, found.quantity, found.positive) == ("deg", "phi", "starboard")
    assert found.clock == "boot clock TimeUS"
    assert np.array_equal(found.t, 10**9 + 20_000_000 * np.arange(COUNT))
    assert np.array_equal(found.y, np.arange(COUNT) / 100)


def test_devices_are_channels_of_their_own(tmp_path):
    rows = [w.packed(w.IMU, 100 * k + 20 * i, i, 0, 0, k + i / 2, 0, 0, 0)
            for k in range(9) for i in (0, 1, 200)]  # fmt: skip
    channels = log(tmp_path, OPENING + b"".join(rows)).channels
    for i in (0, 1, 200):
        assert np.array_equal(channels[f"IMU/{i}:GyrZ"].y, np.arange(9) + i / 2)
        assert channels[f"IMU/{i}:GyrZ"].t[1] == (100 + 20 * i) * 1000
    assert channels["IMU/0:GyrZ"].unit == "rad/s"
    assert channels["IMU/0:AccZ"].unit == "m/s^2"
    assert "IMU:GyrZ" not in channels


def test_multipliers_are_applied_once(tmp_path):
    row = w.packed(w.RALY, 5, 1, 1, 59.1234567, 10.5, 1234)
    channels = log(tmp_path, OPENING + row).channels
    assert channels["RALY:Alt"].y == pytest.approx(12.34)
    assert channels["RALY:Alt"].unit == "m"
    assert channels["RALY:Lat"].y == 59.1234567
    assert channels["RALY:Lat"].unit == "deg"


def test_a_log_that_states_no_units(tmp_path):
    imu = w.packed(w.IMU, 5, 1, 0, 0, 0.25, 0, 0, 0)
    content = w.description(units=False) + ROWS[7] + imu
    channels = log(tmp_path, content).channels
    assert channels["ATT:Roll"].unit == "deg"
    assert channels["IMU/1:GyrZ"].unit == "rad/s"
    assert channels["IMU/1:GyrZ"].y == 0.25


def test_steering_orders_are_not_degrees(tmp_path):
    channels = log(tmp_path, OPENING + w.packed(w.STER, 5, 100, -4500, 3.0)).channels
    assert channels["STER:SteerOut"].unit is None
    assert "not degrees" in channels["STER:SteerOut"].description
    assert channels["STER:SteerOut"].quantity is None


def test_startup_is_not_steering(tmp_path):
    strt = w.Message(7, "STRT", "QBH", "TimeUS,SType,CTot")
    content = w.description((*w.MESSAGES, strt)) + w.packed(strt, 9, 1, 2)
    assert "not steering" in log(tmp_path, content).channels["STRT:SType"].description


def test_the_date_is_a_remark_and_never_a_stamp(tmp_path):
    gps = w.packed(w.GPS, 2_000_000, 0, 3, 1000, 2200, 9, 1, 0, 0, 0, 0, 0, 0, 0)
    found = log(tmp_path, OPENING + ROWS[0] + gps)
    assert "2022-03-05 23:59:41 UTC" in remark(found, "UTC")  # 2022-03-06 00:00:01 GPS less 18+2 s
    assert max(one.t.max() for one in found.channels.values()) < 10**10
    without = log(tmp_path, OPENING + ROWS[0])
    assert "date is not known" in remark(without, "GPS")
    assert "1970" not in " ".join(without.remarks)


def test_modes_and_arming_are_told(tmp_path):
    rows = [w.packed(w.MODE, t, n, n, 1) for t, n in ((10**6, 0), (5 * 10**6, 10), (9 * 10**6, 0))]
    content = OPENING + b"".join(rows) + w.packed(w.ARM, 10**6, 1, 0, 0, 0)
    found = log(tmp_path, content)
    assert "MANUAL from 1.0 s, AUTO from 5.0 s, MANUAL from 9.0 s" in remark(found, "MANUAL")
    assert remark(found, "armed") == "armed from 1.0 s"


def test_a_trim_changed_while_logging_counts_from_then_on(tmp_path):
    rows = [w.packed(w.RCOU, 10**6 * k, 1600, *[0] * 13) for k in range(1, 5)]
    rows.insert(2, w.packed(w.PARM, 2_500_000, "SERVO1_TRIM", 1600, 0))
    found = log(tmp_path, OPENING + b"".join(rows))
    expected = -(1600 - 1450) / (1920 - 1450)
    assert found.channels["servo/1:deflection"].y.tolist() == [expected, expected, 0, 0]
    assert "SERVO1_TRIM 1450 to 1600 at 2.5 s" in remark(found, "parameters changed")


def test_the_deflection_waits_for_the_largest_angle(tmp_path):
    channel = log(tmp_path, OPENING + w.packed(w.RCOU, 1, *[1450] * 14)).channels[
        "servo/1:deflection"
    ]
    assert channel.unit is None
    assert channel.quantity == "delta_order"
    assert "gain = the largest rudder angle; it is a command" in channel.description


def test_without_parameters_no_deflection(tmp_path):
    found = log(tmp_path, w.description() + w.packed(w.RCOU, 1, *[1450] * 14))
    assert not any(name.startswith("servo") for name in found.channels)
    assert remark(found, "deflection").endswith("the log holds no SERVOn_FUNCTION parameter")
    partly = w.parameters(w.servo(TRIM=None))
    found = log(tmp_path, w.description() + partly + w.packed(w.RCOU, 1, *[1450] * 14))
    assert "SERVO1_TRIM not in the log" in remark(found, "deflection")


def test_a_hole_costs_what_it_hit_and_prints_nothing(tmp_path, capfd):
    content = bytearray(OPENING + b"".join(ROWS))
    size = len(ROWS[0])
    at = len(OPENING) + 100 * size + 5
    content[at : at + 700] = bytes(700)
    found = log(tmp_path, content)
    lost = -(-(700 + 5) // size)
    kept = [k for k in range(COUNT) if not 100 <= k < 100 + lost]
    assert np.array_equal(found.channels["ATT:Roll"].y, np.array(kept) / 100)
    assert "lost 2.98-3.62 s" in remark(found, "recovered")
    assert capfd.readouterr() == ("", "")


@settings(max_examples=80, deadline=None, derandomize=True)
@given(st.integers(len(OPENING) + 60, len(OPENING) + COUNT * len(ROWS[0])))
def test_a_log_cut_short_gives_all_whole_messages_before_the_cut(tmp_path_factory, cut):
    found = log(tmp_path_factory.mktemp("cut"), (OPENING + b"".join(ROWS))[:cut])
    whole = (cut - len(OPENING)) // len(ROWS[0])
    assert len(found.channels["ATT:Roll"].y) in {whole, whole - 1}
    assert np.array_equal(
        found.channels["ATT:Roll"].y, np.arange(len(found.channels["ATT:Roll"].y)) / 100
    )


@pytest.mark.parametrize("filling", [b"\x00", b"\xff"])
def test_a_filled_up_last_page_is_no_damage(tmp_path, filling):
    found = log(tmp_path, OPENING + b"".join(ROWS) + filling * 200)
    assert len(found.channels["ATT:Roll"].y) == COUNT
    assert not any("recovered" in one for one in found.remarks)


def test_what_looks_like_a_header_inside_a_message(tmp_path):
    header = struct.unpack("<f", w.HEAD + bytes([w.ATT.number, 0x41]))[0]
    rows = [w.packed(w.IMU, 10 * k, 0, header, header, k, header, header, header)
            for k in range(50)]  # fmt: skip
    found = log(tmp_path, OPENING + b"".join(rows))
    assert np.array_equal(found.channels["IMU/0:GyrZ"].y, np.arange(50.0))
    assert "ATT:Roll" not in found.channels


def test_blocks_of_any_size_give_the_same(tmp_path, monkeypatch):
    content = bytearray(OPENING + b"".join(ROWS))
    content[len(OPENING) + 999 : len(OPENING) + 1300] = b"\xa3\x95" * 150 + b"\xa3"
    whole = log(tmp_path, content)
    for size in (300, 777, 4096):
        monkeypatch.setattr(dataflash_walk, "BLOCK", size)
        parted = log(tmp_path, content)
        assert parted.remarks == whole.remarks
        for name, channel in whole.channels.items():
            assert np.array_equal(parted.channels[name].t, channel.t)
            assert np.array_equal(parted.channels[name].y, channel.y, equal_nan=True)


def test_a_broken_stamp_is_left_out(tmp_path):
    rows = list(ROWS)
    rows[50] = w.packed(w.ATT, 1 << 63, 0, 7, 0, 0, 0, 0)
    rows[60] = w.packed(w.ATT, 1 << 41, 0, 7, 0, 0, 0, 0)
    found = log(tmp_path, OPENING + b"".join(rows)).channels["ATT:Roll"]
    assert len(found.y) == COUNT - 2
    assert (np.diff(found.t) > 0).all()


def test_a_broken_number_is_no_reason_to_warn(tmp_path):
    row = w.packed(w.IMU, 5, 0, 0, 0, 1.0, 0, 0, 0).replace(
        struct.pack("<f", 1.0), b"\x01\x00\xa0\x7f"
    )
    found = log(tmp_path, OPENING + row + ROWS[0])
    assert np.isnan(found.channels["IMU/0:GyrZ"].y).all()


def test_a_type_nobody_describes_is_said(tmp_path):
    content = bytearray(OPENING + b"".join(ROWS))
    at = content.index(b"\xa3\x95\x80" + bytes([w.RALY.number]))
    content[at + 4] ^= 0x40  # its length
    content += w.packed(w.RALY, 5, 1, 1, 59, 10, 1234) + ROWS[0]
    found = log(tmp_path, content)
    assert "RALY:Alt" not in found.channels
    assert remark(found, "recovered")


def with_gps(path):
    """A log with a message that is read whether wanted or not."""
    w.write(path, SERIES)
    rows = [w.packed(w.GPS, 10**6 * k, k % 2, 3, 1000 * k, 2200, 9, 1, 0, 0, 0, k, 0, 0, 0)
            for k in range(1, 9)]  # fmt: skip
    path.write_bytes(path.read_bytes() + b"".join(rows))


def test_wanted_channels_only(tmp_path):
    with_gps(tmp_path / "log")
    whole = read(tmp_path / "log")
    wanted = ["IMU/0:GyrZ", "servo/1", "ATT"]
    some = read(tmp_path / "log", wanted)
    assert set(some.channels) == {n for n in whole.channels if n.startswith(tuple(wanted))}
    assert whole.channels["GPS/1:Spd"].y.tolist() == [1, 3, 5, 7]
    assert some.remarks == whole.remarks
    for name, channel in some.channels.items():
        assert np.array_equal(channel.y, whole.channels[name].y, equal_nan=True)


@pytest.mark.parametrize("size", [10_000, 200_000, 10**9])
def test_batches_give_every_channel(tmp_path, monkeypatch, size):
    monkeypatch.setattr(dataflash_log, "BATCH_BYTES", size)
    with_gps(tmp_path / "log")
    batches = list(dataflash_log.batches(tmp_path / "log"))
    together = {name for batch in batches for name in read(tmp_path / "log", batch).channels}
    assert together == set(read(tmp_path / "log").channels)
    assert (len(batches) > 1) == (size < 10**9)


def test_a_log_of_descriptions_only_is_refused(tmp_path):
    fmt = b"".join(
        w.packed(w.FMT, m.number, m.packer.size, m.name, m.codes, m.columns) for m in w.MESSAGES
    )
    with pytest.raises(LogError, match="no readable message"):
        log(tmp_path, fmt)


def test_only_this_adapter_recognises_it(tmp_path):
    (tmp_path / "log").write_bytes(OPENING)
    assert adapter_of(tmp_path / "log") is dataflash_log.ADAPTER


def test_damage_of_any_kind_gives_a_recording_or_one_line(tmp_path):
    whole = OPENING + b"".join(ROWS)
    likeness = w.FMT.packer.pack(w.HEAD, 0x80, 100, 255, b"ATT", b"Q", b"TimeUS")
    for seed in range(60):
        path = tmp_path / "log"
        path.write_bytes(damaged(whole, np.random.default_rng(seed), 20, likeness))
        try:
            remarks = dataflash_log.read(path).remarks
        except LogError as error:
            remarks = (str(error),)
        assert not any("\n" in one for one in remarks)
