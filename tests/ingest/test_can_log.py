"""Logs of CAN buses: every format comes back the same; the traps; damage; real records."""

import gzip
import struct
import sys
import time
import zlib
from datetime import datetime
from pathlib import Path

import can
import cantools
import numpy as np
import pytest
import write_can
from can.io.asc import ASCReader
from can.io.blf import BLFWriter
from can.io.canutils import CanutilsLogReader
from can.io.csv import CSVReader
from damage import damaged
from nmea2000.decoder import NMEA2000Decoder
from written import Series

from trialid import alignment
from trialid.errors import LogError
from trialid.ingest import read
from trialid.ingest.adapter import NO_AIDS, Aids
from trialid.ingest.can import can_alike, candump
from trialid.ingest.can.can_frames import Tally

START = 1_700_000_000_123_456_000


def series(count=400, start=START) -> dict[str, Series]:
    """A turning ship, each signal at its own rate."""
    rates = {"delta": 10, "r": 20, "phi": 10, "psi": 10, "u": 1}
    made = {}
    for k, (quantity, rate) in enumerate(rates.items()):
        n = count * rate // 20
        t = start + k * 1_000_000 + np.arange(n, dtype=np.int64) * (1_000_000_000 // rate)
        s = (t - start) / 1e9
        y = {
            "delta": 0.5 * np.sin(s),
            "r": -0.05 * np.cos(s),
            "phi": -0.1 * np.sin(0.7 * s),
            "psi": 6.0 - 0.05 * np.sin(s),
            "u": 5 + 0.2 * np.cos(s),
        }[quantity]
        made[quantity] = (t, y)
    return made


@pytest.mark.parametrize("form", write_can.FORMATS, ids=lambda form: form.name)
def test_what_is_written_comes_back(tmp_path, form):
    path, sent = tmp_path / "log", series()
    written = form.write(path, sent)
    recording = read(path, None, written.aids)
    shift = None
    for source in written.sources:
        channel, (t, y) = recording.channels[source.channel], sent[source.quantity]
        if source.quantity == "psi":
            y = y % (2 * np.pi)
        np.testing.assert_allclose(channel.y, y, atol=0.5001 * written.resolution[source.quantity])
        assert channel.quantity == source.quantity
        late = channel.t - t  # formats that know no date count from elsewhere, all signals alike
        shift = int(np.median(late)) if shift is None else shift
        assert np.abs(late - shift).max() <= 2e9 * written.clock_resolution
    if "no date" not in channel.clock:
        assert abs(shift) <= 1e9 * written.clock_resolution
    trial = alignment.align("t", "fit", [recording], written.sources, 0.1)
    assert set(trial.signals) == set(sent)


# what candump writes


def log(tmp_path, lines, name="log"):
    path = tmp_path / name
    content = lines if isinstance(lines, bytes) else "\n".join(lines).encode()
    path.write_bytes(content)
    return path


def sent(count=40):
    return write_can.messages(series(count))


LINE = "(1700000000.100000) can0 09F10D0B#00F8FF7FE803FFFF"
RUDDER = "rudder/11/0:position"


ODD = (
    *("", "# comment", "garbage here", "(1700000000.1) can0", "(1700000000.5) can0 123#0102"),
    *("(17000000x0.100000) can0 09F10D0B#00", "(1700000000.1000001234) can0 09F10D0B#0011"),
    *("  (1700000000.100000)  can0\t09F10D0B#0011 ", "(1700000000.100000) can0 09F10D0B#001"),
    *("(99999999999.100000) can0 09F10D0B#0011", "(9999999999.100000) can0 09F10D0B#0011"),
    *("(1700000000.100000) can0 49F10D0B#0011", "(1700000000.100000) can0 29F10D0B#0011"),
    *("(1700000000.100000) can0 09F10D0B#R", "(1700000000.100000) can0 09F10D0B##10011"),
    *("(1700000000.100000) can0 09F10D0B#", "(1700000000.100000) can1 09f10d0b#00F8FF7FE803FFFF"),
    *("(1700000000.100000) Can0 09F10D0B#00F8FF7FE803FFFF", "(1700000000) can0 09F10D0B#00"),
    *(" (1700000000.100000)  can0  09F10D0B   [3]  00 F8", "(5.5) can0 09F10D0B#00"),
    *(" (1700000000.100000)  can0  09F10D0B   [2]  00 F8   '..'", "\xe9\xff"),
    *(" (1700000000.100000)  can0  123   [1]  0G", " (1700000000.100000)  can0  123   [1]  remote"),
)
"""Lines of other kinds and widths, right and wrong."""


@pytest.mark.parametrize("form", ["-l", "-ta", "-tA", "-tz"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_lines_read_side_by_side_are_what_they_are_field_by_field(tmp_path, monkeypatch, form, end):
    rng = np.random.default_rng(5)
    lines = write_can.candump_lines(sent(400), form)
    for k in rng.integers(0, len(lines), 200):
        odd = str(rng.choice(ODD))
        lines.insert(int(k), odd.replace("1700000000.100000", "1.1") if form == "-tz" else odd)
    path = log(tmp_path, end.join(lines).encode("latin-1"))
    found = []
    for layouts in (can_alike.LAYOUTS, 0):
        monkeypatch.setattr(can_alike, "LAYOUTS", layouts)
        tally = Tally()
        try:
            frames, clock = candump.frames(path, None, tally)
        except LogError as error:  # dates and seconds in one log
            found.append((str(error), tally))
            continue
        buses = [frames.buses[k] for k in frames.bus]
        columns = (frames.t, frames.can_id, frames.extended, frames.length, frames.table)
        found.append((*(column.tolist() for column in columns), buses, clock, tally))
    assert found[0] == found[1]
    assert tally.strange > 0
    assert tally.remote > 0


def test_frames_without_a_time_are_refused(tmp_path):
    path = log(tmp_path, write_can.candump_lines(sent(), "none"))
    with pytest.raises(LogError, match=r"its 102 frames have no time stamp.*candump -l") as info:
        read(path)
    assert "\n" not in str(info.value)


def test_the_old_form_of_candump(tmp_path):
    sample = [
        "<0x09f8027f> [8] 00 fc 9b 05 88 00 ff ff",
        "<0x09f10d0b> [8] 00 f8 ff 7f e8 03 ff ff",
    ]
    with pytest.raises(LogError, match="its 2 frames have no time stamp"):
        read(log(tmp_path, sample))
    channels = read(log(tmp_path, write_can.candump_lines(sent(), "<>"))).channels
    assert len(channels[RUDDER].y) == 20


def test_all_forms_of_candump_read_alike(tmp_path):
    plain = read(log(tmp_path, write_can.candump_lines(sent(), "-l"))).channels
    for form, clock in {
        "-ta": "line stamps",
        "-tA": "line stamps (local dates, zone not stated, taken as UTC)",
        "-tz": "line stamps (since the start of the log; no date)",
        "-td": "line stamps (each since the frame before, added up; no date)",
    }.items():
        channels = read(log(tmp_path, write_can.candump_lines(sent(), form))).channels
        assert list(channels) == list(plain)
        for name, channel in channels.items():
            assert channel.clock == clock
            np.testing.assert_array_equal(channel.y, plain[name].y)
            start = START // 1000 * 1000 if form in ("-tz", "-td") else 0
            np.testing.assert_array_equal(channel.t + start, plain[name].t)


def test_local_dates_need_a_zone(tmp_path):
    path = log(tmp_path, write_can.candump_lines(sent(), "-tA"))
    without = read(path)
    assert "the log does not say of which time zone: taken as UTC" in without.remarks[0]
    oslo = read(path, None, Aids(zone="Europe/Oslo"))
    np.testing.assert_array_equal(
        without.channels[RUDDER].t - oslo.channels[RUDDER].t, 3600 * 1_000_000_000
    )
    assert oslo.channels[RUDDER].clock == "line stamps (dates in Europe/Oslo)"
    assert oslo.remarks == without.remarks[1:]


def test_frames_that_are_not_data_and_lines_that_are_not_frames(tmp_path):
    lines = [
        "# a comment, and a blank line",
        "",
        LINE,
        "(1700000000.200000) can0 09F10D0B#R8",
        "(1700000000.300000) can0 20000004#0000000000000000",
        "(1700000000.400000) can0 09F10D0B##100F8FF7FE803FFFF",
        " (1700000000.500000)  can0  09F10D0B   [8]  remote request",
        " (1700000000.600000)  can0  20000088   [8]  00 00 00 00 00 00 00 00   ERRORFRAME",
        " (1700000000.700000)  can0  09F10D0B  [08]  00 F8 FF 7F E8 03 FF FF",
        " (1700000000.800000)  can0  RX - -  09F10D0B   [8]  00 F8 FF 7F E9 03 FF FF   '........'",
        "(1700000000.900000) can0 09F10D0B#00F8FF7FE803FF",  # cut by the sender: 7 bytes
        "(1700000001.000000) can0 09F10D0B#00F8FF7FE803FFF",
        "(1700000001.100000) can0 09F10D0B#00F8FF7FE803FFFFFF",
        "(1700000001.200000) can0 09F10D0B#00F8FF7FG803FFFF",
        "(1700000001.3x0000) can0 09F10D0B#00F8FF7FE803FFFF",
        "1700000001.300000 can0 09F10D0B#00F8FF7FE803FFFF",
        "(1700000001.400000) can0 9F10D0B#00F8FF7FE803FFFF",
        "(1700000001.500000) can0 123#00F8FF7FE803FFFF",
        "(1700000001.600000) can0 09F10D0B#00F8FF7FEA03FFFF T",
        "(1700000001.700000) can0 09F10D0B#",
        "(1700000001.8000",
    ]
    recording = read(log(tmp_path, lines))
    channel = recording.channels[RUDDER]
    assert ((channel.t - 1_700_000_000_000_000_000) // 100_000_000).tolist() == [1, 8, 9, 16]
    np.testing.assert_allclose(channel.y, [0.1, 0.1001, 0.1, 0.1002])
    assert recording.remarks[:5] == (
        "7 of 19 lines are not frames, left out",
        "2 error frames left out",
        "2 remote frames, which carry no data, left out",
        "2 CAN FD frames left out",
        "rudder (PGN 127245): 1 of 5 messages end early, the fields they lack are left out",
    )
    assert "1 of 6 frames have 11 bit identifiers, not NMEA 2000" in recording.remarks


def test_two_interfaces_are_kept_apart(tmp_path):
    lines = [LINE, LINE.replace("can0", "can1"), LINE.replace("can0", "vcan0")]
    channels = read(log(tmp_path, lines)).channels
    assert [name for name in channels] == [
        f"rudder/{bus}.11/0:position" for bus in ("can0", "can1", "vcan0")
    ]


def test_a_bus_that_is_not_nmea2000_asks_for_its_description(tmp_path):
    path = log(tmp_path, [LINE.replace("09F10D0B", "123")] * 3)
    with pytest.raises(LogError, match=r"none of its 3 frames has a 29 bit identifier.*`dbc`"):
        read(path)


def test_a_log_larger_than_a_block(tmp_path, monkeypatch):
    path = log(tmp_path, write_can.candump_lines(sent(), "-ta"))
    whole = read(path)
    monkeypatch.setattr("trialid.ingest.bytes.text_fields.BLOCK", 997)
    parts = read(path)
    assert parts.remarks == whole.remarks
    for name, channel in whole.channels.items():
        np.testing.assert_array_equal(parts.channels[name].t, channel.t)
        np.testing.assert_array_equal(parts.channels[name].y, channel.y)


def test_a_packed_log_is_the_same_log(tmp_path):
    plain, packed = log(tmp_path, LINE.encode()), tmp_path / "packed"
    packed.write_bytes(gzip.compress(LINE.encode()))
    one, other = read(plain), read(packed)
    assert list(one.channels) == list(other.channels)
    assert other.path == packed
    assert other.sha256 != one.sha256


# Vector's and PEAK's text

ASC = """date Wed Nov 15 10:15:03.250 am 2023
base hex  timestamps absolute
internal events logged
// version 9.0.0
Begin Triggerblock Wed Nov 15 10:15:03.250 am 2023
   0.000000 Start of measurement
   0.000200 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%
   0.100000 1  9F10D0Bx        Rx   d 8 00 F8 FF 7F E8 03 FF FF  Length = 273910 BitCount = 141
   0.300000 1  9F10D0Bx        Rx   r
   0.400000 1  ErrorFrame
   0.450000 CANFD   1 Rx 9F10D0Bx   1 0 8 8 00 F8 FF 7F E8 03 FF FF 0 0 3000 0 0 0 0 0
   0.600000 1  9F10D0Bx        Tx   d 8 00 F8 FF 7F E9 03 FF FF
   0.700000 1  9F10D0Bx        Tx   d 8 00 F8 FF 7F
End TriggerBlock
"""
STARTED = 1_700_043_303_250_000_000


def asc(tmp_path, changes=(), aids=NO_AIDS):
    text = ASC
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    recording = read(log(tmp_path, text.encode("cp1252")), None, aids)
    return recording.channels[RUDDER], recording.remarks


def test_asc_keeps_its_date_and_counts_what_is_left_out(tmp_path):
    channel, remarks = asc(tmp_path)
    assert (channel.t - STARTED).tolist() == [100_000_000, 600_000_000]
    np.testing.assert_allclose(channel.y, [0.1, 0.1001])
    assert remarks[:5] == (
        "the header's date is of a local clock, of which time zone it does not say: taken as UTC; "
        "`zone` can state it",
        "1 of 14 lines are not frames, left out",
        "1 error frames left out",
        "1 remote frames, which carry no data, left out",
        "1 CAN FD frames left out",
    )


def test_asc_in_the_zone_of_the_ship_whatever_that_of_the_reader(tmp_path, monkeypatch):
    monkeypatch.setenv("TZ", "Asia/Tokyo")
    time.tzset()
    try:
        channel, remarks = asc(tmp_path, (), Aids(zone="America/New_York"))
    finally:
        monkeypatch.undo()
        time.tzset()
    assert channel.t[0] - STARTED == (5 * 3600 + 0.1) * 1_000_000_000
    assert remarks[0] == "1 of 14 lines are not frames, left out"
    assert channel.clock == "line stamps (since the start; start in America/New_York)"


def test_asc_with_relative_stamps_adds_them_up(tmp_path):
    channel, _ = asc(tmp_path, [("timestamps absolute", "timestamps relative")])
    assert (channel.t - STARTED).tolist() == [100_000_000, 700_000_000]
    assert channel.clock.startswith("line stamps (each since the line before, added up")


@pytest.mark.parametrize(
    ("date", "second"),
    [
        ("Wed Nov 15 10:15:03.250 am 2023", 0),
        ("Wed Nov 15 10:15:03.250 PM 2023", 43200),
        ("Wed Nov 15 10:15:03.250 2023", 0),
        ("Mit Nov 15 10:15:03.250 2023", 0),
        ("Mit Mär 15 10:15:03.250 2023", -245 * 86400),
        ("Mon Okt 15 10:15:03.250 2023", -31 * 86400),
        ("Wed Nov 15 10:15:03 2023", -0.25),
        ("Wed Nov 15 10:15:03.1 2023", -0.249),  # what python-can writes for one millisecond
        ("Wed Nov 15 12:15:03.250 am 2023", -10 * 3600),
    ],
)
def test_dates_of_asc(tmp_path, date, second):
    channel, _ = asc(tmp_path, [("Wed Nov 15 10:15:03.250 am 2023", date)])
    assert channel.t[0] - STARTED == round((second + 0.1) * 1e9)


def test_asc_without_a_date_makes_none_up(tmp_path):
    channel, _ = asc(
        tmp_path, [("date Wed Nov 15 10:15:03.250 am 2023\n", ""), ("Begin Tri", "// Tri")]
    )
    assert channel.t.tolist() == [100_000_000, 600_000_000]
    assert channel.clock == "line stamps (since the start; no date)"


def test_asc_in_decimals(tmp_path):
    text = "date Wed Nov 15 10:15:03.250 am 2023\nbase dec  timestamps absolute\n"
    data = " ".join(str(byte) for byte in bytes.fromhex("00F8FF7FE803FFFF"))
    text += f"   0.100000 1  {0x09F10D0B}x       Rx   d 8 {data}\n"
    channel = read(log(tmp_path, text.encode())).channels[RUDDER]
    assert channel.y.tolist() == [0.1]


TRC = {
    "1.1": "     1)         2.5  Rx     09F10D0B  8  00 F8 FF 7F E8 03 FF FF ",
    "1.3": "     1)         2.5 1  Rx     09F10D0B -  8    00 F8 FF 7F E8 03 FF FF ",
    "2.0": "      1         2.500 DT 09F10D0B Rx 8  00 F8 FF 7F E8 03 FF FF ",
}


@pytest.mark.parametrize("version", TRC)
def test_versions_of_trc(tmp_path, version):
    head = [f";$FILEVERSION={version}", ";$STARTTIME=45245.4271209490740741", ";"]
    channel = read(log(tmp_path, [*head, TRC[version]])).channels[RUDDER]
    assert channel.y.tolist() == [0.1]
    assert abs(channel.t[0] - STARTED - 2_500_000) < 1000


def test_rows_of_trc_that_are_not_data(tmp_path):
    lines = [
        ";$FILEVERSION=2.1",
        ";$COLUMNS=N,O,T,B,I,d,R,L,D",
        "      1         2.500 DT 1 09F10D0B Rx - 8  00 F8 FF 7F E8 03 FF FF",
        "      2         3.500 RR 1 09F10D0B Rx - 8",
        "      3         4.500 ER 1 -        Rx - 5  04 00 00 00 00",
        "      4         5.500 FD 1 09F10D0B Rx - 8  00 F8 FF 7F E8 03 FF FF",
        "      5         6.500 DT 2 09F10D0B Rx - 8  00 F8 FF 7F E9 03 FF FF",
        "      6         7.500 DT 1 09F10D0B Rx - 8  00 F8 FF",
    ]
    recording = read(log(tmp_path, lines))
    assert {name: one.t.tolist() for name, one in recording.channels.items()} == {
        "rudder/CAN1.11/0:position": [2_500_000],
        "rudder/CAN2.11/0:position": [6_500_000],
    }
    assert recording.remarks[:4] == (
        "1 of 6 lines are not frames, left out",
        "1 error frames left out",
        "1 remote frames, which carry no data, left out",
        "1 CAN FD frames left out",
    )


def test_a_trc_of_an_unknown_version_is_refused(tmp_path):
    with pytest.raises(LogError, match=r"is TRC of version 3\.0; known: 1\.0"):
        read(log(tmp_path, [";$FILEVERSION=3.0", TRC["2.0"]]))


# damage


def test_a_cut_blf_says_so(tmp_path):
    whole = tmp_path / "whole"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(BLFWriter, "max_container_size", 2048)
        write_can.by_python_can(whole, write_can.frames(sent()), ".blf")
    content = whole.read_bytes()
    assert read(whole).remarks[1].startswith("`not available`")
    size = len(read(whole).channels["rate_of_turn/11:rate"].y)
    cut = read(log(tmp_path, content[: 2 * len(content) // 3]))
    assert len(cut.channels["rate_of_turn/11:rate"].y) < size
    (told,) = [remark for remark in cut.remarks if remark.startswith("recovered")]
    assert f"of 102 objects: the file has {2 * len(content) // 3} bytes" in told
    damaged = bytearray(content)
    damaged[len(content) // 2] ^= 0xFF
    recording = read(log(tmp_path, bytes(damaged)))
    (told,) = [remark for remark in recording.remarks if remark.startswith("recovered")]
    assert "1 of its containers are damaged" in told
    whole_t = read(whole).channels["rate_of_turn/11:rate"].t.tolist()
    t = recording.channels["rate_of_turn/11:rate"].t.tolist()
    assert (t[0], t[-1]) == (whole_t[0], whole_t[-1])
    assert len(t) < size


def test_a_blf_that_was_never_closed_says_so(tmp_path):
    path = tmp_path / "log.blf"
    writer = BLFWriter(path)
    for message in write_can.frames(sent(4000)):
        writer.on_message_received(message)
    unfinished = path.read_bytes()
    writer.stop()
    recording = read(log(tmp_path, unfinished))
    assert any("was never closed" in remark for remark in recording.remarks)


def test_a_container_that_unpacks_without_end_is_cut(tmp_path):
    path = tmp_path / "whole"
    write_can.by_python_can(path, write_can.frames(sent()), ".blf")
    head = path.read_bytes()[:144]
    packed = zlib.compress(bytes(1 << 26))
    start = struct.pack("<4sHHLL", b"LOBJ", 16, 1, 32 + len(packed), 10)
    with pytest.raises(LogError, match="holds no CAN message"):
        read(log(tmp_path, head + start + struct.pack("<H6xL4x", 2, 1 << 26) + packed))


def test_a_damaged_database_gives_what_it_can(tmp_path):
    path = tmp_path / "whole"
    write_can.by_python_can(path, write_can.frames(sent(800)), ".db")
    content, whole = path.read_bytes(), read(path).channels["rate_of_turn/11:rate"]
    found = read(log(tmp_path, content[: len(content) // 2]))
    y = found.channels["rate_of_turn/11:rate"].y
    np.testing.assert_array_equal(y, whole.y[: len(y)])
    assert 0.2 * len(whole.y) < len(y) < 0.6 * len(whole.y)
    assert any("the database is damaged" in remark for remark in found.remarks)
    with pytest.raises(LogError, match="SQLite cannot read"):
        read(log(tmp_path, content[:4096]))


def outcome(path):
    """How many lines an error has, none without; the channels without."""
    try:
        return 0, list(read(path).channels.values())
    except LogError as error:
        return len(str(error).splitlines()), []


@pytest.mark.parametrize("form", write_can.FORMATS, ids=lambda form: form.name)
def test_damage_gives_a_recording_or_one_line(tmp_path, form):
    form.write(tmp_path / "whole", series(20))
    content = (tmp_path / "whole").read_bytes()
    rng = np.random.default_rng(7)
    for _ in range(3 if form.name == "mf4" else 25):  # a process for each file of MF4
        path = log(tmp_path, damaged(content, rng))
        lines, channels = outcome(path)
        assert lines <= 1
        assert all(len(channel.t) == len(channel.y) for channel in channels)


# DBC

DBC = """VERSION ""
BU_: A
BO_ 291 Steering: 8 A
 SG_ Switch M : 0|4@1+ (1,0) [0|15] "" A
 SG_ Rudder m1 : 8|12@1- (0.1,-5) [0|0] "deg" A
 SG_ Order m2 : 15|12@0- (0.1,0) [0|0] "deg" A
 SG_ Rate : 32|32@1- (1,0) [0|0] "rad/s" A
BO_ 2314276107 Mirror: 8 A
 SG_ Low : 1|7@1+ (1,0) [0|0] "" A
 SG_ Middle : 13|22@0- (0.01,3) [0|0] "m" A
BO_ 292 Wide: 8 A
 SG_ Wide : 7|64@0- (1,0) [0|0] "" A
SIG_VALTYPE_ 291 Rate : 1;
"""


def test_dbc_as_cantools_reads_it(tmp_path):
    rng = np.random.default_rng(3)
    dbc = tmp_path / "bus.dbc"
    dbc.write_text(DBC, encoding="ascii")
    database = cantools.database.load_string(DBC, "dbc", strict=False)
    lines, expected = [], {}
    for k in range(400):
        ids = ("09F10D0B", "123", "124", "123")[k % 4]
        data = rng.integers(0, 256, 8, np.uint8).tobytes()
        if k % 2:
            data = bytes([k // 2 % 4]) + data[1:4] + struct.pack("<f", k / 7)
        lines.append(f"({k:010d}.000000) can0 {ids}#{data.hex()}")
        message = database.get_message_by_frame_id(int(ids, 16))
        try:
            values = message.decode(data, decode_choices=False)
        except cantools.database.DecodeError:  # a multiplexer that selects nothing
            values = {"Switch": data[0] & 15, "Rate": struct.unpack("<f", data[4:])[0]}
        for name, value in values.items():
            expected.setdefault(f"{message.name}:{name}", []).append((k * 10**9, value))
    recording = read(log(tmp_path, lines), None, Aids(dbc=dbc))
    assert set(recording.channels) == set(expected)
    for name, samples in expected.items():
        channel = recording.channels[name]
        t, y = zip(*samples, strict=True)
        assert channel.t.tolist() == list(t)
        np.testing.assert_allclose(channel.y, y, rtol=1e-12)
    rudder = recording.channels["Steering:Rudder"]
    assert (rudder.unit, rudder.description) == ("deg", "frame 0x123 Steering, signal Rudder")
    assert recording.channels["Mirror:Low"].unit is None


def test_dbc_keeps_buses_apart_and_counts_short_frames(tmp_path):
    dbc = tmp_path / "bus.dbc"
    dbc.write_text(DBC, encoding="ascii")
    lines = [f"({k}.0) can{k % 2} 123#01102000" + "00000000" * (k < 4) for k in range(6)]
    lines.append("(9.0) can0 125#00")
    recording = read(log(tmp_path, lines), None, Aids(dbc=dbc))
    assert set(recording.channels) == {
        f"Steering/can{k}:{signal}" for k in (0, 1) for signal in ("Switch", "Rudder", "Rate")
    }
    assert len(recording.channels["Steering/can0:Rudder"].y) == 3
    assert len(recording.channels["Steering/can0:Rate"].y) == 2
    assert recording.remarks == (
        "Steering/can0: 1 of 3 frames are shorter than its 8 bytes, the signals they lack are left "
        "out",
        "Steering/can1: 1 of 3 frames are shorter than its 8 bytes, the signals they lack are left "
        "out",
        "1 of 7 frames are not described in bus.dbc",
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("no file", "is no DBC file that can be read"),
        ("", "is no DBC file that can be read"),
        ('VERSION ""\n', "describes none of the log's 1 frames"),
    ],
)
def test_a_bad_dbc_is_one_line(tmp_path, text, words):
    dbc = tmp_path / "bus.dbc"
    dbc.write_text(text, encoding="ascii")
    with pytest.raises(LogError, match=words) as info:
        read(log(tmp_path, [LINE]), None, Aids(dbc=dbc))
    assert "\n" not in str(info.value)


def test_dbc_without_cantools_says_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "cantools", None)
    with pytest.raises(LogError, match=r"pip install 'trialid\[dbc\]'"):
        read(log(tmp_path, [LINE]), None, Aids(dbc=tmp_path / "bus.dbc"))


# real records

DATA = Path(__file__).parents[3] / "shared/data"
YACHT = DATA / "ydvr_yacht/00090013.candump.log"
BOAT = DATA / "canboat_n2k"
NAMES = {
    127245: ("angleOrder order", "position position"),
    127250: ("heading {}", "deviation deviation", "variation variation"),
    127251: ("rate rate",),
    127257: ("yaw yaw", "pitch pitch", "roll roll"),
    128259: ("speedWaterReferenced water", "speedGroundReferenced ground"),
    129025: ("latitude latitude", "longitude longitude"),
    129026: ("cog {}_cog", "sog sog"),
    130306: ("windSpeed {}_speed", "windAngle {}_angle"),
}
MESSAGES = {
    127245: "rudder", 127250: "heading", 127251: "rate_of_turn", 127257: "attitude",
    128259: "speed", 129025: "position", 129026: "cog_sog", 130306: "wind",
}  # fmt: skip
WIND = {
    "True (ground referenced to North)": "true_north",
    "Magnetic (ground referenced to Magnetic North)": "magnetic_north",
    "True (boat referenced)": "true_boat",
    "True (water referenced)": "true_water",
}


def by_the_oracle(lines, stamp):
    """Samples by channel, (ns, value or None), of lines the oracle decodes one by one."""
    decoder, found = NMEA2000Decoder(include_pgns=list(NAMES)), {}
    for line in lines:
        message = decoder.decode(line)
        if message is None:
            continue
        values = {field.id: field.value for field in message.fields}
        place = f"{MESSAGES[message.PGN]}/{message.source}"
        if "instance" in values:
            place += f"/{255 if values['instance'] is None else values['instance']}"
        words = values.get("reference", values.get("cogReference")) or ""
        for pair in NAMES[message.PGN]:
            theirs, ours = pair.split()
            name = f"{place}:{ours.format(WIND.get(words, words.lower()))}"
            found.setdefault(name, []).append((stamp(line), values[theirs]))
    return {
        name: samples
        for name, samples in found.items()
        if any(value is not None for _, value in samples)
    }


def agree(recording, oracle):
    mine = {
        name: channel
        for name, channel in recording.channels.items()
        if name.partition("/")[0] in MESSAGES.values()
    }
    assert set(mine) == set(oracle)
    for name, samples in oracle.items():
        t, y = zip(*samples, strict=True)
        np.testing.assert_array_equal(mine[name].t, t, err_msg=name)
        y = np.array([np.nan if value is None else value for value in y])
        np.testing.assert_allclose(mine[name].y, y, rtol=1e-12, atol=1e-12, err_msg=name)


def of_candump(line):
    return int(line[1:].partition(")")[0].replace(".", "")) * 1000


def of_canboat(line):
    stamp = datetime.fromisoformat(line.partition(",")[0])
    return int(stamp.timestamp()) * 10**9 + stamp.microsecond * 1000


@pytest.mark.real_data
@pytest.mark.skipif(not YACHT.exists(), reason="no real records beside the repository")
def test_the_yacht_value_by_value():
    recording = read(YACHT)
    lines = YACHT.read_text(encoding="ascii").splitlines()
    agree(recording, by_the_oracle(lines, of_candump))
    assert not [remark for remark in recording.remarks if "lines" in remark]
    turn = {k: recording.channels[f"rate_of_turn/{k}:rate"] for k in (11, 128)}
    rates = {k: len(c.t) / ((c.t[-1] - c.t[0]) / 1e9) for k, c in turn.items()}
    assert rates == {11: pytest.approx(20, rel=0.02), 128: pytest.approx(10, rel=0.02)}


@pytest.mark.real_data
@pytest.mark.skipif(not BOAT.exists(), reason="no real records beside the repository")
@pytest.mark.parametrize("name", ["furuno-130842.raw", "furuno-130842-wide-turn.raw"])
def test_the_boat_value_by_value(name):
    lines = (BOAT / name).read_text(encoding="ascii").splitlines()
    lines = [line for line in lines if line and not line.startswith("#")]
    agree(read(BOAT / name), by_the_oracle(lines, of_canboat))


@pytest.mark.real_data
@pytest.mark.skipif(not BOAT.exists(), reason="no real records beside the repository")
def test_the_log_with_comments_value_by_value():
    path = BOAT / "candumpSample3.txt"
    recording = read(path)
    lines = [line for line in path.read_text(encoding="ascii").splitlines() if line[:1] == "("]
    assert len(lines) == 2368
    agree(recording, by_the_oracle(lines, of_candump))
    assert not [remark for remark in recording.remarks if "lines" in remark]
    with CanutilsLogReader(path) as theirs, pytest.raises(ValueError, match="values to unpack"):
        list(theirs)  # which is why there is a reader of our own


# what python-can gets wrong in files of its own


def test_asc_by_python_can_one_millisecond_after_the_second(tmp_path, monkeypatch):
    monkeypatch.setenv("TZ", "America/New_York")
    time.tzset()
    try:
        start = 1_700_000_020_001_000_000
        write_can.FORMATS[5].write(tmp_path / "log", series(start=start))
        with ASCReader(tmp_path / "log", relative_timestamp=False) as theirs:
            late = next(iter(theirs)).timestamp - start / 1e9
        recording = read(tmp_path / "log", None, Aids(zone="America/New_York"))
    finally:
        monkeypatch.undo()
        time.tzset()
    assert late == pytest.approx(0.099, abs=1e-3)
    assert abs(recording.channels[RUDDER].t[0] - start) < 1_000_000


def test_csv_with_numpy_stamps(tmp_path):
    sent = write_can.frames(write_can.messages(series(40)))
    for message in sent[::2]:
        message.timestamp = np.float64(message.timestamp)
    write_can.by_python_can(tmp_path / "log", sent, ".csv")
    with (
        CSVReader(tmp_path / "log") as theirs,
        pytest.raises(ValueError, match="could not convert"),
    ):
        list(theirs)
    recording = read(tmp_path / "log")
    assert len(recording.channels["rate_of_turn/11:rate"].y) == 40
    assert not [remark for remark in recording.remarks if "lines" in remark]


def test_frames_of_python_can_that_are_not_data(tmp_path):
    data = write_can.frames(write_can.messages(series(20)))
    more = [
        can.Message(timestamp=data[-1].timestamp + 0.1, arbitration_id=5, is_error_frame=True),
        can.Message(timestamp=data[-1].timestamp + 0.2, arbitration_id=5, is_remote_frame=True),
    ]
    for suffix in (".log", ".asc", ".blf", ".csv", ".db"):  # its TRC leaves them out
        path = tmp_path / suffix[1:]
        write_can.by_python_can(path, [*data, *more], suffix)
        recording = read(path)
        assert len(recording.channels["rate_of_turn/11:rate"].y) == 20
        told = " ".join(recording.remarks)
        assert "1 remote frames" in told
        assert "1 error frames" in told
        assert "lines are not frames" not in told


def test_the_database_is_opened_for_reading_only(tmp_path):
    write_can.by_python_can(tmp_path / "log", write_can.frames(sent()), ".db")
    before = (tmp_path / "log").read_bytes()
    (tmp_path / "log").chmod(0o400)
    read(tmp_path / "log")
    assert (tmp_path / "log").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["log"]
