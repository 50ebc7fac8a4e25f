"""NMEA 0183 and Signal K logs: what was written comes back, the clocks, the traps of recorders."""

from functools import reduce
from operator import xor
from pathlib import Path

import numpy as np
import pytest
from damage import damaged
from sentence_checksums import forged
from write_nmea0183 import FORMATS, checksum, iso, sentence, with_iso

from trialid.alignment import align
from trialid.errors import LogError
from trialid.ingest import Aids, read

START = 1_700_000_000_000_000_000
SECOND = 1_000_000_000
REAL = Path(__file__).parents[3] / "shared/data/signalk_nmea0183/gofree-merrimac.log"

SHAPES = {
    "delta": (10, lambda t: 0.3 * np.sin(0.2 * t)),
    "r": (10, lambda t: 0.01 * np.sin(0.2 * t - 0.5)),
    "phi": (10, lambda t: 0.05 * np.sin(0.6 * t)),
    "u": (2, lambda t: 7 + 0.3 * np.sin(0.05 * t)),
    "psi": (10, lambda t: 0.02 - 0.05 * np.cos(0.2 * t - 0.5)),
}
LATEST_FIRST = 0.028


def motions(seconds=120.0):
    series = {}
    for k, (name, (rate, shape)) in enumerate(SHAPES.items()):
        stamps = START + np.rint(np.arange(0, seconds, 1 / rate) * 1e3).astype(np.int64) * 1_000_000
        stamps = stamps + k * 7_000_000
        series[name] = (stamps, shape((stamps - START) / 1e9))
    return series


def log(tmp_path, content, name="log"):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode("latin-1"))
    return path


def rot(rate, talker="TI", status="A"):
    return sentence(talker, "ROT", [f"{rate}", status])


def stamped(count=40, step=100_000_000):
    return [(START + i * step, rot(float(i))) for i in range(count)]


def read_text(tmp_path, text, **aids):
    return read(log(tmp_path, text), None, Aids(**aids))


@pytest.mark.parametrize("form", FORMATS, ids=lambda form: form.name)
def test_what_was_written_comes_back(tmp_path, form):
    series = motions()
    made = form.write(tmp_path / "log", series)
    recording = read(tmp_path / "log")
    assert all("left out" in remark for remark in recording.remarks[:1])
    assert len(recording.remarks) <= 1
    for source in made.sources:
        stamps, _ = series[source.quantity]
        np.testing.assert_array_equal(recording.channels[source.channel].t, stamps)
    trial = align("zigzag", "fit", [recording], made.sources, 0.1)
    for name, (_, shape) in SHAPES.items():
        valid = trial.valid[name]
        assert valid.mean() > 0.97
        error = trial.signals[name] - shape(trial.t + LATEST_FIRST)
        error = np.abs(np.angle(np.exp(1j * error)))
        assert (
            error[valid].max() < 1.2 * made.resolution[name] + 1e-3 * np.abs(shape(trial.t)).max()
        )


PREFIXES = {
    "ISO": (lambda t: iso(t) + " ", "line stamps"),
    "ISO with offset": (
        lambda t: iso(t + 2 * 3600 * SECOND).replace("Z", "+02:00") + "\t",
        "line stamps",
    ),
    "no zone": (
        lambda t: iso(t).replace("T", " ").replace("Z", ": "),
        "line stamps, no zone stated: taken as UTC",
    ),
    "slashes": (
        lambda t: iso(t).replace("-", "/").replace("T", " ")[:-1] + ",",
        "line stamps, no zone stated: taken as UTC",
    ),
    "seconds": (lambda t: f"{t // SECOND}.{t // 1_000_000 % 1000:03d} ", "line stamps"),
    "milliseconds": (lambda t: f"{t // 1_000_000}: ", "line stamps"),
    "microseconds": (lambda t: f"({t // 1000}) ", "line stamps"),
    "nanoseconds": (lambda t: f"{t} ", "line stamps"),
    "brackets": (lambda t: f"[{iso(t)}] ", "line stamps"),
    "names around": (lambda t: f"INNAV\t{iso(t)}\tSEAPATH330\t", "line stamps"),
    "colon": (
        lambda t: "seap " + iso(t)[:-1].replace("T", ":") + " ",
        "line stamps, no zone stated: taken as UTC",
    ),
}


@pytest.mark.parametrize("name", PREFIXES)
@pytest.mark.parametrize("end", ["\r\n", "\n", "\r"])
def test_stamps_before_the_sentences(tmp_path, name, end):
    prefix, words = PREFIXES[name]
    recording = read_text(tmp_path, "".join(prefix(t) + text + end for t, text in stamped()))
    channel = recording.channels["ROT/TI:rate"]
    assert recording.adapter == "nmea0183"
    np.testing.assert_array_equal(channel.t, [t for t, _ in stamped()])
    np.testing.assert_array_equal(channel.y, np.arange(40.0))
    assert channel.clock == words
    assert (channel.unit, channel.quantity, channel.positive) == ("deg/min", "r", "starboard")
    assert recording.remarks == ()


def test_a_zone_for_stamps_that_state_none(tmp_path):
    text = "".join(iso(t)[:-1] + " " + text + "\n" for t, text in stamped())
    channel = read_text(tmp_path, text, zone="Europe/Oslo").channels["ROT/TI:rate"]
    np.testing.assert_array_equal(channel.t, [t - 3600 * SECOND for t, _ in stamped()])
    assert channel.clock == "line stamps, zone Europe/Oslo"


def test_a_time_of_day_stays_one_and_goes_on_over_midnight(tmp_path):
    start = 86_400 * SECOND - 2 * SECOND
    text = "".join(iso(start + i * SECOND // 10)[11:-1] + " R " + rot(i) + "\n" for i in range(40))
    channel = read_text(tmp_path, text).channels["ROT/TI:rate"]
    np.testing.assert_array_equal(channel.t, start + np.arange(40) * (SECOND // 10))
    assert channel.clock == "line stamps, time of day, no date"


def tagged(tag, text):
    return f"\\{tag}*{checksum(tag)}\\{text}\r\n"


def test_tag_blocks_in_whole_seconds_and_two_sources(tmp_path):
    text = "".join(tagged(f"s:GP000{1 + i % 2},c:{START // SECOND + i}", rot(i)) for i in range(40))
    recording = read_text(tmp_path, text)
    assert sorted(recording.channels) == ["ROT/GP0001.TI:rate", "ROT/GP0002.TI:rate"]
    channel = recording.channels["ROT/GP0002.TI:rate"]
    np.testing.assert_array_equal(channel.y, np.arange(1, 40, 2))
    np.testing.assert_array_equal(channel.t, START + np.arange(1, 40, 2) * SECOND)
    assert channel.clock == "tag block time, whole seconds"


def test_a_damaged_tag_block_takes_its_sentence_with_it(tmp_path):
    lines = [tagged(f"s:GP0001,c:{START // SECOND + i}", rot(i)) for i in range(40)]
    lines[7] = lines[7].replace("c:17", "c:18")
    recording = read_text(tmp_path, "".join(lines))
    np.testing.assert_array_equal(
        recording.channels["ROT/TI:rate"].y, np.delete(np.arange(40.0), 7)
    )
    assert recording.remarks[0].startswith("recovered 40 of about 41 sentences: 1 with a wrong")


def test_tag_block_and_line_stamp(tmp_path):
    """The sender's time where it is fine enough; the recorder's is when it was received."""
    text = "".join(
        f"{iso(t + 30_000_000)} " + tagged(f"s:TI0001,c:{t // 1_000_000}", text)
        for t, text in stamped()
    )
    channel = read_text(tmp_path, text).channels["ROT/TI:rate"]
    np.testing.assert_array_equal(channel.t, [t for t, _ in stamped()])
    np.testing.assert_array_equal(channel.received, channel.t + 30_000_000)
    coarse = "".join(
        f"{iso(t)} " + tagged(f"s:TI0001,c:{t // SECOND}", text) for t, text in stamped()
    )
    channel = read_text(tmp_path, coarse).channels["ROT/TI:rate"]
    np.testing.assert_array_equal(channel.t, [t for t, _ in stamped()])
    assert channel.clock == "line stamps"


def test_datagrams_without_line_ends(tmp_path):
    body = "".join(
        "UdPbC\0" + tagged(f"s:TI0001,c:{t // 1_000_000}", text).rstrip() for t, text in stamped()
    )
    channel = read_text(tmp_path, body + "\r\n").channels["ROT/TI:rate"]
    np.testing.assert_array_equal(channel.t, [t for t, _ in stamped()])


def test_two_sentences_on_one_line_share_its_stamp(tmp_path):
    text = "".join(f"{iso(t)} {text}{rot(0.5, 'HE')}\n" for t, text in stamped())
    channels = read_text(tmp_path, text).channels
    np.testing.assert_array_equal(channels["ROT/HE:rate"].t, channels["ROT/TI:rate"].t)


def zda(t, year="2023"):
    clock = iso(t)[11:].replace(":", "")[:-2]
    return sentence("GP", "ZDA", [clock, "14", "11", year, "00", "00"])


def rmc(t, status="A", date="141123"):
    clock = iso(t)[11:].replace(":", "")[:-2]
    fields = [clock, status, "5310.81", "N", "00525.70", "E", "5.0", "90.0", date, "0.7", "E", "A"]
    return sentence("GP", "RMC", fields)


def unstamped(tick, seconds=20, per_second=8):
    """A tick a second, and sentences at equal steps between, every second one of them a rate."""
    lines, other = [], sentence("YX", "MTW", ["8.0", "C"])
    for i in range(seconds):
        lines.append(tick(i))
        lines += [rot(i + k / per_second) if k % 2 else other for k in range(1, per_second)]
    return "".join(line + "\r\n" for line in lines)


@pytest.mark.parametrize("name", ["ZDA", "RMC"])
def test_the_receiver_as_clock(tmp_path, name):
    tick = {"ZDA": zda, "RMC": rmc}[name]
    recording = read_text(tmp_path, unstamped(lambda i: tick(START + i * SECOND)))
    channel = recording.channels["ROT/TI:rate"]
    np.testing.assert_allclose((channel.t - START) / 1e9, channel.y, atol=1e-8)
    assert channel.clock == f"times of GP{name}, interpolated by place in the log"
    assert recording.remarks[0].endswith("good to about 1 s")
    assert recording.remarks[1] == "7 of 160 sentences without a usable time left out"


def test_a_receiver_that_jumps(tmp_path):
    """What lies beside the jump has no time; nothing is stretched over it."""

    def tick(i):
        return zda(START + (i if i < 10 else i + 60) * SECOND)

    recording = read_text(tmp_path, unstamped(tick))
    channel = recording.channels["ROT/TI:rate"]
    true = channel.y + np.where(channel.y < 9.9, 0, 60)
    np.testing.assert_allclose((channel.t - START) / 1e9, true, atol=1e-8)
    assert len(channel.t) == 18 * 4
    assert "the times of GPZDA jump 1 times; what lies there has no time" in recording.remarks


def test_the_date_a_receiver_made_up_before_its_first_fix_is_not_taken(tmp_path):
    def tick(i):
        return rmc(START + i * SECOND, "V", "060180") if i < 5 else rmc(START + i * SECOND)

    channel = read_text(tmp_path, unstamped(tick)).channels["ROT/TI:rate"]
    np.testing.assert_allclose((channel.t - START) / 1e9, channel.y, atol=1e-8)
    assert channel.y.min() > 5


def test_times_without_a_date_stay_times_of_day(tmp_path):
    """Two digits are no year of ZDA; over midnight the count goes on."""
    midnight = (START // (86_400 * SECOND) + 1) * 86_400 * SECOND

    def tick(i):
        return zda(midnight + (i - 10) * SECOND, "23")

    channel = read_text(tmp_path, unstamped(tick)).channels["ROT/TI:rate"]
    np.testing.assert_allclose(channel.t / 1e9, 86_390 + channel.y, atol=1e-8)
    assert channel.clock.endswith("time of day, no date")


def test_no_time_is_refused_in_one_line(tmp_path):
    with pytest.raises(LogError, match="no time in the log: its lines have no stamps") as caught:
        read_text(tmp_path, "".join(text + "\r\n" for _, text in stamped()))
    assert "\n" not in str(caught.value)


def test_numbers_that_are_no_times_are_not_taken_for_times(tmp_path):
    """A counter before the sentence, of ten digits even."""
    lines = "".join(f"{i:010d} {text}\n" for i, (_, text) in enumerate(stamped()))
    with pytest.raises(LogError, match="no time in the log"):
        read_text(tmp_path, lines)


def test_a_wrong_checksum_is_left_out_and_counted(tmp_path):
    lines = [with_iso(t, "", text) for t, text in stamped()]
    lines[3] = lines[3].replace("3.0,A", "8.0,A")
    lines[4] = lines[4].partition("*")[0] + "\r\n"
    lines[5] = lines[5].partition(",A*")[0] + " " + lines[6]
    del lines[6]
    recording = read_text(tmp_path, "".join(lines))
    channel = recording.channels["ROT/TI:rate"]
    np.testing.assert_array_equal(channel.y, [*range(3), *range(6, 40)])
    np.testing.assert_array_equal(channel.t, START + channel.y.astype(np.int64) * SECOND // 10)
    assert recording.remarks == (
        "recovered 37 of about 40 sentences: 1 with a wrong checksum and 2 cut or without one left "
        "out",
    )


def test_the_stamp_of_a_sentence_that_was_cut_is_not_that_of_the_next(tmp_path):
    lines = [with_iso(t, "", text) for t, text in stamped()]
    lines[5:10] = [lines[5].partition(",A*")[0] + lines[9].partition(" ")[2]]
    recording = read_text(tmp_path, "".join(lines))
    np.testing.assert_array_equal(recording.channels["ROT/TI:rate"].y, [*range(5), *range(10, 40)])
    assert recording.remarks[1] == "1 of 36 sentences without a usable time left out"


def test_a_sentence_behind_a_wrong_one_does_not_take_the_stamp_of_the_line_before(tmp_path):
    lines = [with_iso(t, "", text) for t, text in stamped()]
    lines[5] = lines[5].rstrip() + rot(105.0) + "\r\n"
    lines[7] = lines[7].replace("7.0,A", "8.0,A").rstrip() + rot(107.0) + "\r\n"
    channel = read_text(tmp_path, "".join(lines)).channels["ROT/TI:rate"]
    assert channel.t[channel.y == 105.0] == channel.t[channel.y == 5.0]
    assert not {7.0, 107.0} & set(channel.y)


RUN_TOGETHER = {
    "a sentence in a name": b"IIXDR,A,-2.02,D,11\\$TIROT,31.24,A",
    "a line in a name": b"IIXDR,A,1.85,D,\xff\xff1700000001400;N;$TIROT,-2.06,A",
    "a row in a name": b'IIXDR,A,0.57,D,R,NMEA0183,TCP,XDR,"$IIXDR,A,0.85,D,ROLL',
    "another kind": b"IIXDR,A,0.57,D,R!AIVDM,1,1",
    "a mark alone": b"IIXDR,A,0.57,D,R$1",
    "bytes": b"IIXDR,A,0.57,D,\xff\x01R",
}


@pytest.mark.parametrize("body", RUN_TOGETHER.values(), ids=RUN_TOGETHER)
@pytest.mark.parametrize("checked", [True, False], ids=["checked", "bare"])
def test_sentences_run_together_are_none_though_their_checksum_fits(tmp_path, body, checked):
    good = [with_iso(t, "", text).encode() for t, text in stamped()]
    bad = good[7].partition(b"$")[0] + b"$" + body + b"*%02X\r\n" % reduce(xor, body)
    lines = [*good[:7], bad, *good[8:]]
    if not checked:
        lines = [line.partition(b"*")[0] + b"\r\n" for line in lines]
    found = read(log(tmp_path, b"".join(lines)))
    assert list(found.channels) == ["ROT/TI:rate"]
    np.testing.assert_array_equal(found.channels["ROT/TI:rate"].y, [*range(7), *range(8, 40)])
    counted = ("recovered 39 of about 4", "recovered 40 of about 41")  # the last may be sound
    assert any(one.startswith(counted) for one in found.remarks)


def test_a_writer_that_runs_sentences_together_is_counted_once_a_line(tmp_path):
    """As a multiplexer does with VLW: the checksum is that of the whole line."""
    body = "SDVLW,$SDVLW,,N,322.0,N,$SDVLW,$SDVLW,,N,322.0,N,2315.4,N"
    lines = [with_iso(t, "", text) + f"${body}*{checksum(body)}\r\n" for t, text in stamped()]
    recording = read_text(tmp_path, "".join(lines))
    assert len(recording.channels["ROT/TI:rate"].y) == 40
    assert recording.remarks == (
        "recovered 40 of about 80 sentences: 0 with a wrong checksum, 40 with characters no "
        "sentence holds and 0 cut or without one left out",
    )


def test_without_any_checksum_all_is_taken_and_said(tmp_path):
    lines = [f"{iso(t)} {text.partition('*')[0]}\r\n" for t, text in stamped()]
    recording = read_text(tmp_path, "".join(lines))
    np.testing.assert_array_equal(recording.channels["ROT/TI:rate"].y, np.arange(40.0))
    assert recording.remarks[0].startswith("no sentence of this log has a checksum: damage")


def test_only_wrong_checksums_give_nothing(tmp_path):
    with pytest.raises(LogError, match="not one sound NMEA 0183 sentence"):
        read_text(tmp_path, "".join(f"{iso(t)} $TIROT,1,A*00\r\n" for t, _ in stamped()))


def test_damaged_stamps_are_left_out(tmp_path):
    lines = [with_iso(t, "", text) for t, text in stamped()]
    lines[5] = lines[5].replace("2023", "2033")
    lines[9] = lines[9].replace("T22:13", "T22:1x")
    lines[39] = lines[39].replace("T22", "T02")
    recording = read_text(tmp_path, "".join(lines))
    kept = np.delete(np.arange(40.0), [5, 9, 39])
    np.testing.assert_array_equal(recording.channels["ROT/TI:rate"].y, kept)
    assert recording.remarks == ("3 of 40 sentences without a usable time left out",)


def test_opencpn_with_its_columns_swapped_and_several_sources(tmp_path):
    rows = []
    for i, (t, text) in enumerate(stamped()):
        source = ("/dev/ttyUSB0", "TCP 10.0.0.1:3000")[i % 2]
        rows.append(f'{t // 1_000_000},NMEA0183,ROT,{source},"{text}"\n')
    rows.insert(4, "1700000000300,NMEA2000,can0,127245,ff00\n")
    head = "# timestamp_format: EPOCH_MILLIS\nreceived_at,protocol,source,msg_type,raw_data\n"
    recording = read_text(tmp_path, head + "".join(rows))
    assert sorted(recording.channels) == [
        "ROT/TCP_10.0.0.1_3000.TI:rate",
        "ROT/dev_ttyUSB0.TI:rate",
    ]
    assert recording.remarks == ("1 lines of NMEA 2000 left out; log that bus as CAN",)


def test_garbage_before_and_between(tmp_path):
    lines = "".join(with_iso(t, "", text) for t, text in stamped())
    recording = read_text(tmp_path, "4.5,A*1F\r\n\xff\xfe#.,\r\n" + lines + "Connection lost\r\n")
    np.testing.assert_array_equal(recording.channels["ROT/TI:rate"].y, np.arange(40.0))


def test_only_wanted_channels_are_read(tmp_path):
    lines = "".join(
        with_iso(t, "", text) + with_iso(t, "", sentence("HE", "HDT", ["1.0", "T"]))
        for t, text in stamped()
    )
    assert list(read(log(tmp_path, lines), ["HDT/"]).channels) == ["HDT/HE:heading"]
    assert list(read(log(tmp_path, lines), ["ROT/TI:rate"]).channels) == ["ROT/TI:rate"]
    assert read(log(tmp_path, lines), ["RSA/II:starboard"]).channels == {}


def test_ais_alone_tells_nothing(tmp_path):
    ais = "!AIVDM,1,1,1,,13aI8e?P00PGpU:NR6s00?vT2000,0,0*1C\r\n"
    recording = read_text(tmp_path, 30 * ais)
    assert recording.channels == {}
    assert recording.remarks[0].startswith("no sentence in it tells of the motion")


def test_other_texts_are_not_taken(tmp_path):
    for text in ("t,u\n0,1\n1,2\n", "1700000000000;N;$TIROT,1.0,A*2B\n" * 3, "hello $5,000\n" * 9):
        path = log(tmp_path, text)
        try:
            assert read(path).adapter != "nmea0183"
        except LogError as error:
            assert "is none of the formats" in str(error)  # noqa: PT017


def test_blocks_do_not_show(tmp_path, monkeypatch):
    """A log read in small blocks is the same log."""
    path = log(tmp_path, "".join(with_iso(t, "", text) for t, text in stamped(400)))
    whole = read(path).channels["ROT/TI:rate"]
    monkeypatch.setattr("trialid.ingest.nmea0183.nmea0183_recorded.BLOCK", 1000)
    parts = read(path).channels["ROT/TI:rate"]
    np.testing.assert_array_equal(parts.t, whole.t)
    np.testing.assert_array_equal(parts.y, whole.y)


def test_a_signal_k_log_of_all_kinds(tmp_path):
    lines = [
        '1700000000000;I;{"updates":[{"$source":"a/b","values":[{"path":"navigation.rateOfTurn",'
        '"value":0.01},{"path":"steering.rudderAngle","value":null},{"path":"name","value":"x"}]}]}',
        "1700000000100;N;" + rot(6.0),
        "1700000000150;A;2023-11-14T22:13:20.150Z,2,127251,11,255,8,ff,00,20,00,00,ff,ff,ff",
        "1700000000200;A;2023-11-14T22:13:20.150Z,2,127251,11,255,8,ff,00",
        "1700000000250;I;{broken",
        "1700000000300;C;whatever",
        '1700000000400;I;{"updates":[{"source":{"label":"n2k","src":"3"},"values":['
        '{"path":"navigation.attitude","value":{"roll":0.1,"pitch":-0.02,"yaw":null}}]}]}',
    ]
    recording = read_text(tmp_path, "\n".join(lines) + "\n")
    assert recording.adapter == "signal k"
    got = {name: (c.t.tolist(), c.y.tolist()) for name, c in recording.channels.items()}
    assert got.pop("rate_of_turn/11:rate")[0] == [START + 150_000_000]
    assert got == {
        "navigation.rateOfTurn/a_b:value": ([START], [0.01]),
        "ROT/TI:rate": ([START + 100_000_000], [6.0]),
        "navigation.attitude/n2k.3:roll": ([START + 400_000_000], [0.1]),
        "navigation.attitude/n2k.3:pitch": ([START + 400_000_000], [-0.02]),
    }
    roll = recording.channels["navigation.attitude/n2k.3:roll"]
    assert (roll.unit, roll.quantity, roll.positive) == ("rad", "phi", "starboard")
    assert recording.remarks == (
        "1 lines that should be NMEA 2000 messages cannot be read, left out",
        "1 lines that should be deltas cannot be read, left out",
        "lines left out: 1 of kind C; kinds that are read: N, A, I",
    )


CHECKED = [form for form in FORMATS if "deltas" not in form.name and "2000" not in form.name]


@pytest.mark.parametrize("form", CHECKED, ids=lambda form: form.name)
def test_no_damage_makes_a_wrong_sample(tmp_path, form):
    """Values are protected by their checksums; a stamp that is not may be off where blocks join."""
    path = tmp_path / "log"
    made = form.write(path, motions(12.0))
    data, clean = path.read_bytes(), read(path).channels
    written = {source.channel: clean[source.channel] for source in made.sources}
    samples = late = 0
    for seed in range(25):
        content = damaged(data, np.random.default_rng(seed))
        if forged(content, data):
            continue  # what eight bits of exclusive or cannot see is no reader's fault
        path.write_bytes(content)
        try:
            channels = read(path).channels
        except LogError as error:
            assert "\n" not in str(error)  # noqa: PT017
            continue
        for name in written.keys() & channels.keys():
            y, true = channels[name].y, written[name]
            good = np.isfinite(y)
            assert np.isin(y[good], true.y).all()
            off = [
                np.abs(true.t[true.y == v] - t).min()
                for t, v in zip(channels[name].t[good], y[good], strict=True)
            ]
            late += int(np.sum(np.array(off) > 3 * SECOND))
            samples += len(off)
    assert samples > 5000
    assert late < 0.002 * samples


@pytest.mark.real_data
@pytest.mark.skipif(not REAL.exists(), reason="real records are not here")
def test_a_real_log_with_broken_negative_numbers():
    recording = read(REAL)
    heel = recording.channels["XDR/II/HEEL:angle"]
    assert (len(heel.y), heel.unit, heel.quantity) == (141, "deg", "phi")
    assert set(heel.y) == {0.5}
    assert "XDR/II/RUDDER:angle" not in recording.channels
    complaint = "141 of 141 values are no numbers (the first: '-4.-3'); not available"
    assert f"XDR/II/RUDDER:angle: {complaint}" in recording.remarks
    heading = recording.channels["HDG/SD:heading"]
    assert len(heading.y) == 1373
    assert heading.clock == "times of GPRMC, interpolated by place in the log"
    assert (heading.t[-1] - heading.t[0]) / 1e9 == pytest.approx(140.5, abs=1)
    assert str(heading.t[:1].astype("M8[ns]")[0]).startswith("2014-04-16T19:57:19")
