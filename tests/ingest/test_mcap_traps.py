"""Logs as recorders and accidents make them: what must not be believed, lost or mixed up."""

import io
import struct
import time
import zlib

import numpy as np
import pytest
import write_mcap
from damage import damaged
from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer
from sample_writers import imu, write_logs

from trialid.alignment import align
from trialid.errors import LogError
from trialid.ingest import read
from trialid.ingest.adapter import NO_AIDS
from trialid.ingest.mcap import mcap_batches, mcap_chunk, mcap_log, mcap_stretches
from trialid.names import units
from trialid.names.quantities import SIGNALS

START = 1_700_000_000_000_000_000
STEP = 20_000_000
COUNT = 300
T = START + np.arange(COUNT, dtype=np.int64) * STEP
FLOAT32, FLOAT64 = "float32 data\n", "float64 data\n"


def mcap(path, write, **options):
    """A file whose messages `write` adds to the library's writer."""
    with path.open("wb") as file:
        writer = Writer(file, **options)
        writer.start()
        write(writer)
        writer.finish()
    return path


def float64(writer, topic, kind="std_msgs/msg/Float64", text=FLOAT64):
    schema = writer.register_schema(kind, "ros2msg", text.encode())
    return writer.register_channel(topic, "cdr", schema)


def data(value, kind="<d"):
    return b"\0\1\0\0" + struct.pack(kind, value)


def rudder(writer, times=T):
    channel = float64(writer, "/rudder")
    for i, t in enumerate(times.tolist()):
        writer.add_message(channel, t, data(float(i)), t)


def series():
    rng = np.random.default_rng(5)
    t = T + rng.integers(0, 10**6, COUNT)
    return {name: (t, rng.normal(size=COUNT)) for name in write_mcap.UNITS}


@pytest.fixture(params=write_mcap.FORMATS, ids=lambda one: one.name)
def written(request, tmp_path, monkeypatch):
    monkeypatch.setattr(write_logs, "CHUNK_SIZE", 2048)
    motion = series()
    return tmp_path / "log", motion, request.param.write(tmp_path / "log", motion)


def test_what_was_written_comes_back(written):
    """Every format gives the same trial, each sample at its stamp, within its resolution."""
    path, motion, log = written
    recording = read(path)
    assert recording.remarks == ()
    for source in log.sources:
        if source.as_ is None:
            t, y = motion[source.quantity]
            channel = recording.channels[source.channel]
            si = SIGNALS[source.quantity].unit
            factor = units.factor(channel.unit or source.unit, si)
            side = -1 if source.positive == "port" else 1
            error = np.abs(side * factor * channel.y - y).max()
            assert error <= log.resolution[source.quantity]
            np.testing.assert_array_equal(channel.t, t)
            np.testing.assert_array_equal(channel.received, t + write_mcap.LATE)
            assert "stamp" in channel.clock
    assert motion.keys() == {source.quantity for source in log.sources}


@pytest.mark.parametrize("one", write_mcap.FORMATS, ids=lambda one: one.name)
def test_a_trial_written_in_every_format_is_the_same_trial(tmp_path, one):
    slow = START + np.arange(COUNT, dtype=np.int64) * 5 * STEP
    seconds = (slow - START) / 1e9
    motions = {
        "delta": 0.2 * np.sin(0.5 * seconds),
        "r": 0.02 * np.sin(0.5 * seconds - 0.9),
        "phi": 0.1 * np.sin(0.7 * seconds),
        "u": 5 + 0.1 * np.sin(0.3 * seconds),
        "psi": 1 - 0.04 * np.cos(0.5 * seconds - 0.9),
    }
    motion = {name: (slow, y) for name, y in motions.items()}
    log = one.write(tmp_path / "log", motion)
    trial = align("zigzag", "fit", [read(tmp_path / "log")], log.sources, 0.2)
    for name, (_, y) in motion.items():
        valid = trial.valid[name]
        assert valid.mean() > 0.9
        true = np.interp(trial.t, seconds, y)
        assert np.abs(trial.signals[name] - true)[valid].max() < 2e-3 + log.resolution[name]


@pytest.mark.parametrize("index", [IndexType.ALL, IndexType.NONE])
@pytest.mark.parametrize("compression", list(CompressionType))
def test_with_indexes_and_without(tmp_path, index, compression):
    path = mcap(
        tmp_path / "log", rudder, index_types=index, compression=compression, chunk_size=999
    )
    channel = read(path).channels["/rudder:data"]
    np.testing.assert_array_equal(channel.y, np.arange(COUNT))
    np.testing.assert_array_equal(channel.t, T)


def test_indexes_that_lie_change_nothing(tmp_path):
    """They carry no checksum; each change of one gives the same samples."""
    whole = mcap(tmp_path / "log", rudder, chunk_size=4000).read_bytes()
    index = next(iter(_summary(whole).chunk_indexes)).message_index_offsets[1]
    for i in range(40):
        content = bytearray(whole)
        content[index + 9 + 6 + 8 + i] ^= 1 << i % 8
        (tmp_path / "log").write_bytes(content)
        np.testing.assert_array_equal(
            read(tmp_path / "log").channels["/rudder:data"].y, np.arange(COUNT)
        )


def _summary(content):
    return make_reader(io.BytesIO(content)).get_summary()


def test_the_index_is_used_where_it_fills_the_chunk(monkeypatch, tmp_path):
    path = mcap(tmp_path / "log", rudder, chunk_size=4000)
    walked = mcap_chunk.walk_records
    spans = []
    monkeypatch.setattr(
        mcap_chunk, "walk_records", lambda d, a, b: spans.append(b - a) or walked(d, a, b)
    )
    read(path)
    assert 0 < sum(spans) < 200  # the schema and the channel, not the messages


def test_a_wrong_record_length_costs_the_chunk_it_hits(tmp_path):
    whole = bytearray(mcap(tmp_path / "log", rudder, chunk_size=2000).read_bytes())
    third = _summary(bytes(whole)).chunk_indexes[2]
    for length in (0, 100, 5000, 2**40, 2**64 - 1):
        at = third.chunk_start_offset
        (tmp_path / "log").write_bytes(
            whole[: at + 1] + length.to_bytes(8, "little") + whole[at + 9 :]
        )
        recording = read(tmp_path / "log")
        (remark,) = recording.remarks
        lost = COUNT - len(recording.channels["/rudder:data"].y)
        assert 0 < lost < 60
        assert remark.startswith(f"recovered {COUNT - lost} of {COUNT} messages, ")


def test_a_chunk_that_stands_twice_is_read_once(tmp_path):
    whole = mcap(tmp_path / "log", rudder, chunk_size=2000).read_bytes()
    two = _summary(whole).chunk_indexes[1]
    at, end = two.chunk_start_offset, two.chunk_start_offset + two.chunk_length
    (tmp_path / "log").write_bytes(whole[:end] + whole[at:end] + whole[end:])
    recording = read(tmp_path / "log")
    np.testing.assert_array_equal(recording.channels["/rudder:data"].y, np.arange(COUNT))
    assert any("stand twice in the file and are read once" in r for r in recording.remarks)


def test_two_logs_in_one_file(tmp_path):
    first = mcap(tmp_path / "a", rudder, chunk_size=2000).read_bytes()
    later = mcap(tmp_path / "b", lambda w: rudder(w, T + 10**12), chunk_size=2000).read_bytes()
    (tmp_path / "log").write_bytes(first + later)
    recording = read(tmp_path / "log")
    np.testing.assert_array_equal(
        recording.channels["/rudder:data"].t, np.concatenate([T, T + 10**12])
    )
    assert "something stands behind it" in recording.remarks[0]


def test_without_a_summary_the_lost_are_counted_by_the_index(tmp_path):
    whole = mcap(tmp_path / "log", rudder, chunk_size=2000).read_bytes()
    three = _summary(whole).chunk_indexes[2]
    content = bytearray(whole[: whole.rindex(b"\x0f\x04\0\0\0\0\0\0\0")])
    content[three.chunk_start_offset + three.chunk_length // 2] ^= 4
    (tmp_path / "log").write_bytes(content)
    recording = read(tmp_path / "log")
    (remark,) = recording.remarks
    found = len(recording.channels["/rudder:data"].y)
    assert remark.startswith(
        f"recovered {found} of about {COUNT} messages, lost 2023-11-14 22:13:2"
    )


def bomb(path, compression, said, packed):
    """A log whose second chunk says it holds `said` bytes."""
    crc = zlib.crc32(b"")
    head = struct.pack("<QQQI", START, START + 10**9, said, crc)
    body = head + struct.pack("<I", len(compression)) + compression.encode()
    body += struct.pack("<Q", len(packed)) + packed
    whole = mcap(path, rudder, chunk_size=2000).read_bytes()
    at = _summary(whole).chunk_indexes[1].chunk_start_offset
    path.write_bytes(whole[:at] + struct.pack("<BQ", 6, len(body)) + body + whole[at:])
    return path


@pytest.mark.parametrize("said", [1000, 10**8, 2**63])
@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_a_bomb_is_a_loss(tmp_path, compression, said):
    import lz4.frame
    import zstandard

    zeros = bytes(10**8)
    if compression == "zstd":
        pack = zstandard.ZstdCompressor(write_content_size=False)
        packed = pack.compress(zeros)
    else:
        packed = lz4.frame.compress(zeros, store_size=False)
    path = bomb(tmp_path / "log", compression, said, packed)
    del zeros
    start = time.process_time()
    recording = read(path)
    assert time.process_time() - start < 5
    np.testing.assert_array_equal(recording.channels["/rudder:data"].y, np.arange(COUNT))
    assert "damaged at byte" in recording.remarks[0]


def test_one_topic_of_two_kinds_is_two_sources(tmp_path):
    def write(writer):
        one = float64(writer, "/rudder")
        two = float64(writer, "/rudder", "std_msgs/msg/Float32", FLOAT32)
        for i, t in enumerate(T.tolist()):
            writer.add_message(one, t, data(float(i)), t)
            writer.add_message(two, t, data(-float(i), "<f"), t)

    path = mcap(tmp_path / "log", write)
    channels = read(path).channels
    assert channels.keys() == {"/rudder/std_msgs/Float64:data", "/rudder/std_msgs/Float32:data"}
    np.testing.assert_array_equal(
        channels["/rudder/std_msgs/Float32:data"].y, -np.arange(float(COUNT))
    )
    assert list(read(path, ["/rudder/std_msgs/Float32:data"]).channels) == [
        "/rudder/std_msgs/Float32:data"
    ]


def test_a_channel_number_that_changes_its_meaning(tmp_path):
    """A log joined to another that numbers its channels anew."""
    first = mcap(tmp_path / "a", rudder, chunk_size=2000).read_bytes()

    def other(writer):
        channel = float64(writer, "/speed")
        for t in T.tolist():
            writer.add_message(channel, t, data(7.0), t)

    second = mcap(tmp_path / "b", other, chunk_size=2000).read_bytes()
    (tmp_path / "log").write_bytes(first + second)
    channels = read(tmp_path / "log").channels
    np.testing.assert_array_equal(channels["/rudder:data"].y, np.arange(COUNT))
    np.testing.assert_array_equal(channels["/speed:data"].y, np.full(COUNT, 7.0))


def test_times_out_of_order_twice_and_before_1970_stay_as_they_are(tmp_path):
    times = [5, 3, 3, 2**64 - 10, 4]

    def write(writer):
        channel = float64(writer, "/rudder")
        for i, t in enumerate(times):
            writer.add_message(channel, t, data(float(i)), t)

    channel = read(mcap(tmp_path / "log", write)).channels["/rudder:data"]
    assert channel.t.tolist() == [5, 3, 3, -10, 4]
    np.testing.assert_array_equal(channel.y, np.arange(5))


def test_json_that_is_no_json(tmp_path):
    texts = [
        b'{"x": NaN, "y": Infinity}',
        b'{"x": ' + b"[" * 100_000,
        b'{"x": 1' + b"0" * 5000 + b"}",
        b'{"x": 1e999, "stamp": NaN}',
        b'{"x": 2, "stamp": {"sec": "a", "nsec": null}}',
        b"\xff\xfe",
        b'{"x": 3}',
    ]

    def write(writer):
        channel = writer.register_channel("/a", "json", 0)
        for i, text in enumerate(texts):
            writer.add_message(channel, START + i, text, START + i)

    recording = read(mcap(tmp_path / "log", write))
    np.testing.assert_array_equal(recording.channels["/a:x"].y, [np.nan, np.inf, 3])
    (remark,) = recording.remarks
    assert remark.startswith("/a: 4 of 7 messages cannot be decoded")


JOINTS = b'{"name": ["%s", "%s"], "position": [%d, %d], "joints": [{"name": "a", "v": 1}]}'


def test_elements_are_called_by_the_names_beside_them(tmp_path):
    encode = write_mcap.encoder("joints")

    def write(writer):
        schema = writer.register_schema(
            "sensor_msgs/msg/JointState", "ros2msg", write_mcap.JOINT_STATE.encode()
        )
        ros, plain = (
            writer.register_channel("/ros", "cdr", schema),
            writer.register_channel("/json", "json", 0),
        )
        for i, names in enumerate([("sail", "helm"), ("helm", "sail"), ("", "helm")]):
            message = {"name": list(names), "position": [i + 0.25, i + 0.5], "effort": [1.0]}
            t = START + i
            writer.add_message(ros, t, encode({"header": write_mcap.header(t), **message}), t)
            text = JOINTS % (*(name.encode() for name in names), i, i + 10)
            writer.add_message(plain, t, text, t)

    channels = read(mcap(tmp_path / "log", write)).channels
    assert channels["/ros:position[helm]"].y.tolist() == [0.5, 1.25]
    assert channels["/ros:position[sail]"].y.tolist() == [0.25, 1.5]
    assert channels["/ros:position[0]"].y.tolist() == [2.25]  # one of the two has no name
    assert channels["/ros:effort[0]"].y.tolist() == [1, 1, 1]
    assert channels["/json:position[helm]"].y.tolist() == [10, 1]
    assert channels["/json:joints[a].v"].y.tolist() == [1, 1, 1]


def test_sentences_are_left_out_and_said_to_be_sentences(tmp_path):
    def write(writer):
        rudder(writer)
        text = "std_msgs/Header header\nstring sentence\n" + write_mcap.STAMP
        schema = writer.register_schema("nmea_msgs/msg/Sentence", "ros2msg", text.encode())
        channel = writer.register_channel("/nmea", "cdr", schema)
        writer.add_message(channel, START, b"\0\1\0\0" + bytes(20), START)

    recording = read(mcap(tmp_path / "log", write))
    assert list(recording.channels) == ["/rudder:data"]
    assert recording.remarks[0].startswith("/nmea: left out, it holds NMEA 0183 sentences")


def test_what_ros_and_keelson_define_is_said(tmp_path):
    path, none = tmp_path / "log", np.zeros(COUNT)
    still = imu(T, *[none] * 6)
    write_logs.write_ros2_mcap(path, {"/rudder": (T, none)}, {"/imu": still})
    channels = read(path).channels
    turn, roll = (channels[f"/imu:angular_velocity.{axis}"] for axis in "zx")
    assert (turn.unit, turn.quantity, turn.positive) == ("rad/s", "r", "port")
    assert (roll.quantity, roll.positive) == ("p", "starboard")
    assert turn.description == (
        "sensor_msgs/Imu angular_velocity.z on /imu, axes of REP-103, positive to port"
    )
    assert (channels["/rudder:data"].unit, channels["/rudder:data"].quantity) == (None, None)
    topic = "rise/@v0/ship/pubsub/rudder_angle_deg/gear/0"
    write_logs.write_keelson_mcap(path, {topic: (T, none)})
    helm = read(path).channels[f"{topic}:value"]
    assert (helm.unit, helm.quantity, helm.positive) == ("deg", "delta", "starboard")
    assert helm.description == "Keelson rudder_angle_deg of ship, source gear/0"


def test_batches_together_give_every_channel(tmp_path, monkeypatch):
    path = tmp_path / "log"
    moved = imu(T, *[np.sin(np.arange(COUNT) / 9)] * 6)
    write_logs.write_ros2_mcap(path, {"/rudder": (T, T * 1.0), "/b": (T, T * 2.0)}, {"/imu": moved})
    whole = read(path).channels
    assert mcap_log.batches(path, NO_AIDS) == (None,)
    monkeypatch.setattr(mcap_batches, "SMALL", 0)
    monkeypatch.setattr(mcap_batches, "BUDGET", COUNT * 8 * 8)
    batches = tuple(mcap_log.batches(path, NO_AIDS))
    assert len(batches) > 5
    parts = [read(path, wanted).channels for wanted in batches]
    assert set().union(*parts) == whole.keys()
    for channel in (channel for part in parts for channel in part.values()):
        np.testing.assert_array_equal(channel.y, whole[channel.name].y)
        np.testing.assert_array_equal(channel.t, whole[channel.name].t)


@pytest.mark.parametrize("stretch", [1, 3000])
def test_how_much_is_decoded_together_changes_nothing(tmp_path, monkeypatch, stretch):
    path = tmp_path / "log"
    moved = imu(T, *[np.sin(np.arange(COUNT) / 9)] * 6)
    write_logs.write_ros2_mcap(path, {"/rudder": (T[::3], T[::3] * 1.0)}, {"/imu": moved})
    whole = read(path).channels
    monkeypatch.setattr(write_logs, "CHUNK_SIZE", 1500)
    write_logs.write_ros2_mcap(path, {"/rudder": (T[::3], T[::3] * 1.0)}, {"/imu": moved})
    monkeypatch.setattr(mcap_stretches, "STRETCH", stretch)
    for name, channel in read(path).channels.items():
        np.testing.assert_array_equal(channel.y, whole[name].y)
        np.testing.assert_array_equal(channel.t, whole[name].t)


def test_mutilated_logs_give_nothing_wrong_and_nothing_silently(written):
    """Only LogError comes out; samples are those of the whole log, and what is lost is said."""
    path, _, _ = written
    whole = path.read_bytes()
    true = {name: _samples(channel) for name, channel in read(path).channels.items()}
    count = sum(map(len, true.values()))
    for seed in range(12):
        path.write_bytes(damaged(whole, np.random.default_rng(seed), keep=16))
        try:
            recording = read(path)
        except LogError:
            continue
        for name, channel in recording.channels.items():
            assert _samples(channel) <= true[name]
            assert len(_samples(channel)) == len(channel.t)
        assert recording.remarks or count == sum(len(c.t) for c in recording.channels.values())


def _samples(channel):
    return set(zip(channel.t.tolist(), channel.y.tolist(), strict=True))
