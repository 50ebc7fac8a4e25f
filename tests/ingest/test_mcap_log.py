import struct

import numpy as np
import pytest
from mcap.writer import Writer
from sample_writers import imu, write_logs

from trialid.errors import LogError
from trialid.ingest import read

START = 1_700_000_000_000_000_000
STEP = 20_000_000
LATE = 30_000_000


def stamps(count, start=START):
    return start + np.arange(count, dtype=np.int64) * STEP


def values(count, seed=1):
    return np.random.default_rng(seed).normal(size=count)


def raw_mcap(path, encoding, messages, schema=("", "", b""), topic="/raw", **options):
    """A file of ready payloads: (log time, publish time, payload) each."""
    with path.open("wb") as file:
        writer = Writer(file, **options)
        writer.start()
        number = writer.register_schema(*schema) if schema[1] else 0
        channel = writer.register_channel(topic, encoding, number)
        for log, publish, payload in messages:
            writer.add_message(channel, log, payload, publish)
        writer.finish()
    return path


def test_keelson_round_trip_with_its_units_and_own_stamps(tmp_path):
    path, t, y = tmp_path / "log", stamps(500), values(500)
    rudder = "rise/@v0/ship/pubsub/rudder_angle_deg/rudder/0"
    turn = "rise/@v0/ship/pubsub/yaw_rate_degps/gyro"
    write_logs.write_keelson_mcap(path, {rudder: (t, y), turn: (t + 7, y[::-1])}, LATE)
    recording = read(path)
    assert recording.adapter == "mcap"
    assert recording.remarks == ()
    channel = recording.channels[f"{rudder}:value"]
    assert channel.unit == "deg"
    assert channel.clock == "message timestamp"
    np.testing.assert_array_equal(channel.t, t)
    np.testing.assert_array_equal(channel.y, y.astype(np.float32))
    assert recording.channels[f"{turn}:value"].unit == "deg/s"
    np.testing.assert_array_equal(recording.channels[f"{turn}:value"].t, t + 7)


def test_a_zero_is_a_value_in_protobuf_not_an_absent_field(tmp_path):
    path = tmp_path / "log"
    write_logs.write_keelson_mcap(path, {"a": (stamps(3), np.array([0.0, 1.0, 0.0]))})
    np.testing.assert_array_equal(read(path).channels["a:value"].y, [0.0, 1.0, 0.0])


def test_ros2_round_trip_header_stamp_and_publish_time(tmp_path):
    path, t, y = tmp_path / "log", stamps(400), values(400)
    none = np.zeros(400)
    moved = imu(t, 0.1 * y, none, none, y, none, -y)
    write_logs.write_ros2_mcap(path, {"/rudder": (t, 2 * y)}, {"/imu": moved}, LATE)
    channels = read(path).channels
    np.testing.assert_array_equal(channels["/rudder:data"].y, 2 * y)
    np.testing.assert_array_equal(channels["/rudder:data"].t, t + LATE)
    assert channels["/rudder:data"].clock == "publish time"
    np.testing.assert_array_equal(channels["/imu:angular_velocity.z"].y, -y)
    np.testing.assert_array_equal(channels["/imu:angular_velocity.z"].t, t)
    assert channels["/imu:angular_velocity.z"].clock == "header stamp"
    assert channels["/imu:angular_velocity.z"].unit == "rad/s"
    np.testing.assert_allclose(2 * np.arcsin(channels["/imu:orientation.x"].y), 0.1 * y, atol=1e-12)
    assert not any("stamp" in name or "frame_id" in name for name in channels)


@pytest.mark.parametrize("schema", [True, False])
def test_json_round_trip_null_is_not_available(tmp_path, schema):
    path, t, y = tmp_path / "log", stamps(200), values(200)
    y[7] = np.nan
    write_logs.write_json_mcap(path, {"/speed": (t, y)}, LATE, schema=schema)
    channel = read(path).channels["/speed:value"]
    np.testing.assert_array_equal(channel.t, t)
    np.testing.assert_array_equal(channel.y, y)
    assert channel.clock == "message timestamp"


def test_json_fields_are_dotted_and_indexed_and_only_numbers(tmp_path):
    text = b'{"a":{"b":[1,2.5,{"c":3}]},"on":true,"name":"x","stamp":{"sec":1,"nsec":2},"d":null}'
    path = raw_mcap(tmp_path / "log", "json", [(START, START, text)])
    channels = read(path).channels
    assert {name: float(c.y[0]) for name, c in channels.items() if name != "/raw:d"} == {
        "/raw:a.b[0]": 1.0,
        "/raw:a.b[1]": 2.5,
        "/raw:a.b[2].c": 3.0,
    }
    assert np.isnan(channels["/raw:d"].y[0])


def test_a_field_that_only_some_messages_have_keeps_their_stamps(tmp_path):
    texts = [b'{"rudder":1}', b'{"yaw":2}', b'{"rudder":3}']
    messages = [(START + i, START + i, text) for i, text in enumerate(texts)]
    channels = read(raw_mcap(tmp_path / "log", "json", messages)).channels
    np.testing.assert_array_equal(channels["/raw:rudder"].t, [START, START + 2])
    np.testing.assert_array_equal(channels["/raw:yaw"].t, [START + 1])


@pytest.mark.parametrize(
    ("offset", "clock"),
    [
        (0, "header stamp"),
        (-4_900, "header stamp"),
        (5_100, "publish time: header stamps are 5.1 s off the log time"),
        (None, "publish time: header stamps are not set in 100% of the messages"),
        (-1_699_999_999_000, "publish time: header stamps are 1970"),
    ],
)
def test_header_stamp_counts_only_near_the_log_time(tmp_path, offset, clock):
    path, t = tmp_path / "log", stamps(100)
    stamp = np.zeros(100, np.int64) if offset is None else t + offset * 1_000_000
    messages = [(log, log + 1, _stamped(s, 1.5)) for log, s in zip(t.tolist(), stamp, strict=True)]
    recording = read(raw_mcap(path, "cdr", messages, STAMPED))
    channel = recording.channels["/raw:value"]
    assert channel.clock == clock
    np.testing.assert_array_equal(channel.t, stamp if clock == "header stamp" else t + 1)


def test_header_stamps_that_run_backwards_are_not_believed(tmp_path):
    t = stamps(100)
    messages = [(log, log, _stamped(START + 10**9 - i * STEP, 0.0)) for i, log in enumerate(t)]
    channel = read(raw_mcap(tmp_path / "log", "cdr", messages, STAMPED)).channels["/raw:value"]
    assert channel.clock == "publish time: header stamps run backwards"


def test_one_unset_header_stamp_costs_one_message_and_is_said(tmp_path):
    t = stamps(200).tolist()
    messages = [(log, log, _stamped(log if i else 0, float(i))) for i, log in enumerate(t)]
    recording = read(raw_mcap(tmp_path / "log", "cdr", messages, STAMPED))
    np.testing.assert_array_equal(recording.channels["/raw:value"].y, np.arange(1.0, 200.0))
    assert recording.remarks == ("/raw: 1 messages without a usable header stamp left out",)


def test_log_time_when_nothing_was_published(tmp_path):
    messages = [(log, 0, b'{"x":1}') for log in stamps(10).tolist()]
    channel = read(raw_mcap(tmp_path / "log", "json", messages)).channels["/raw:x"]
    assert channel.clock == "log time"
    np.testing.assert_array_equal(channel.t, stamps(10))


STAMPED = (
    "my_msgs/msg/Stamped",
    "ros2msg",
    b"std_msgs/Header header\nfloat64 value\n"
    b"================================================================================\n"
    b"MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n",
)


def _stamped(stamp, value):
    seconds, nanos = divmod(int(stamp), 10**9)
    head = struct.pack("<4xiII4s", seconds, nanos, 4, b"imu\0")
    body = b"\x00\x01\x00\x00" + head[4:]
    return body + b"\0" * (-(len(body) - 4) % 8) + struct.pack("<d", value)


def test_only_wanted_channels_are_read(tmp_path):
    path, t, y = tmp_path / "log", stamps(50), values(50)
    moved = imu(t, *([y] * 6))
    write_logs.write_ros2_mcap(path, {"/rudder": (t, y), "/other": (t, y)}, {"/imu": moved})
    recording = read(path, ["/rudder:data", "/imu:angular_velocity"])
    axes = {f"/imu:angular_velocity.{axis}" for axis in "xyz"}
    covariances = {f"/imu:angular_velocity_covariance[{i}]" for i in range(9)}
    assert recording.channels.keys() == {"/rudder:data"} | axes | covariances


@pytest.mark.parametrize(
    ("encoding", "schema", "reason"),
    [
        ("cbor", ("", "", b""), "encoding 'cbor' is none of cdr, protobuf, json"),
        ("cdr", ("x/Y", "ros2idl", b"module x {}"), "its schema is ros2idl, not ros2msg"),
        ("cdr", ("", "", b""), "its schema is missing, not ros2msg"),
        ("protobuf", ("x.Y", "protobuf", b"\xff\xff"), "its schema cannot be used"),
        ("protobuf", ("", "", b""), "its schema is missing"),
    ],
)
def test_a_channel_nobody_can_decode_does_not_stop_the_others(tmp_path, encoding, schema, reason):
    path = tmp_path / "log"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        number = writer.register_schema(*schema) if schema[1] else 0
        writer.add_message(writer.register_channel("/a", encoding, number), START, b"\x00\x01", 1)
        good = writer.register_channel("/b", "json", 0)
        writer.add_message(good, START, b'{"x": 4}', START)
        writer.finish()
    recording = read(path)
    assert list(recording.channels) == ["/b:x"]
    (remark,) = recording.remarks
    assert remark.startswith("/a: left out, ")
    assert reason in remark


def test_one_bad_message_costs_one_message(tmp_path):
    texts = [b'{"x": 1}', b'{"x": ', b"[1]", b'{"x": 2}']
    messages = [(START + i, START + i, text) for i, text in enumerate(texts)]
    recording = read(raw_mcap(tmp_path / "log", "json", messages))
    np.testing.assert_array_equal(recording.channels["/raw:x"].y, [1.0, 2.0])
    (remark,) = recording.remarks
    assert remark.startswith("/raw: 2 of 4 messages cannot be decoded (Expecting value")


def test_a_restarted_recorder_writes_the_topic_twice(tmp_path):
    path = tmp_path / "log"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        for k in range(2):
            channel = writer.register_channel("/x", "json", 0, {"run": str(k)})
            for i in range(3):
                t = START + 3 * k + i
                writer.add_message(channel, t, b'{"v": %d}' % (3 * k + i), t)
        writer.finish()
    channel = read(path).channels["/x:v"]
    np.testing.assert_array_equal(channel.y, np.arange(6.0))
    np.testing.assert_array_equal(channel.t, START + np.arange(6))


def test_the_suffix_plays_no_part(tmp_path):
    path = tmp_path / "log.csv"
    write_logs.write_json_mcap(path, {"/x": (stamps(5), values(5))})
    assert read(path).adapter == "mcap"


def test_a_log_without_messages_is_said_to_be_one(tmp_path):
    path = raw_mcap(tmp_path / "log", "json", [])
    with pytest.raises(LogError, match=r"log: holds no readable message: it is whole"):
        read(path)
