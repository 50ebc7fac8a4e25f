"""How fast MCAP logs are read, beside the libraries.

python tests/benchmarks/ingest.py --only mcap
"""

import struct
import tempfile
from pathlib import Path

import numpy as np
from ingest_timing import Row, SizedLogs, fastest
from mcap.writer import CompressionType, Writer
from sample_writers import write_logs
from write_mcap import KINDS, encoder, header

from trialid.ingest import read

START = 1_700_000_000_000_000_000
STEP = 20_000_000
WANTED = ("/imu:angular_velocity", "/imu:orientation", "/rudder:data", "/joints:position")
COUNT = 28_000
"""Messages of each of the three topics: 560 s at 50 Hz."""
CHUNK = 2**20
"""What the library's writer puts into a chunk unless told."""
BYTES = 360
"""Of a message of each topic, in chunks of noise packed by zstd."""


def ros2_log(path: Path, count: int, compression: CompressionType, noise: bool = False) -> int:
    """Imu, Float64 and JointState, `count` of each; how many messages that is."""
    rng = np.random.default_rng(1)
    kinds = {**KINDS, "rudder": ("std_msgs/msg/Float64", write_logs.FLOAT64)}
    zero = {"header": header(START)}
    imu = bytearray(encoder("imu")(zero))
    joints = {**zero, "name": ["rudder", "sail"], "position": [0.0, 0.0], "velocity": [0.0, 0.0]}
    joint = bytearray(encoder("joints")(joints))
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=CHUNK, compression=compression)
        writer.start("ros2")
        ids = {}
        for topic in ("imu", "rudder", "joints"):
            name, text = kinds[topic]
            schema = writer.register_schema(name, "ros2msg", text.encode())
            ids[topic] = writer.register_channel(f"/{topic}", "cdr", schema)
        doubles = (len(imu) - 28) // 8 if noise else 7
        for i in range(count):
            t = START + i * STEP
            stamp = struct.pack("<II", t // 10**9, t % 10**9)
            imu[4:12] = joint[4:12] = stamp
            # 4 of encapsulation, 8 of stamp, 4 + 10 of frame: the numbers begin at the next 8.
            imu[len(imu) - 8 * doubles :] = rng.standard_normal(doubles).tobytes()
            rudder = 0.3 * np.sin(i / 100)
            writer.add_message(ids["imu"], t + 9, bytes(imu), t + 9)
            writer.add_message(ids["rudder"], t + 9, b"\0\1\0\0" + struct.pack("<d", rudder), t + 9)
            writer.add_message(ids["joints"], t + 9, bytes(joint), t + 9)
        writer.finish()
    return 3 * count


def keelson_log(path: Path, count: int) -> int:
    """Protobuf messages of two topics."""
    t = START + np.arange(count, dtype=np.int64) * STEP
    y = np.random.default_rng(2).normal(size=count)
    topics = ("rise/@v0/s/pubsub/rudder_angle_deg/a", "rise/@v0/s/pubsub/yaw_rate_degps/a")
    write_logs.write_keelson_mcap(path, dict.fromkeys(topics, (t, y)), 9)
    return 2 * count


def json_log(path: Path, count: int) -> int:
    """JSON messages of one topic."""
    t = START + np.arange(count, dtype=np.int64) * STEP
    write_logs.write_json_mcap(path, {"/a": (t, np.random.default_rng(2).normal(size=count))}, 9)
    return count


def _ros2_library(path: Path) -> None:
    from mcap_ros2.reader import read_ros2_messages

    for _ in read_ros2_messages(path, log_time_order=False):
        pass


def _protobuf_library(path: Path) -> None:
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _ in reader.iter_decoded_messages(log_time_order=False):
            pass


def _json_library(path: Path) -> None:
    """Only parses: the messages' numbers are not gathered, as ours are."""
    import json

    from mcap.reader import make_reader

    with path.open("rb") as file:
        for *_, message in make_reader(file).iter_messages(log_time_order=False):
            json.loads(message.data)


def measure(scale: float = 1.0) -> list[Row]:
    """Ours against the plain library, both on the same log in the same process."""
    count = max(300, round(COUNT * scale))
    rows: list[Row] = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log"
        for compression in (CompressionType.ZSTD, CompressionType.LZ4, CompressionType.NONE):
            number = ros2_log(path, count, compression)
            theirs = number / fastest(lambda: _ros2_library(path), 1)
            kinds = {"needed": WANTED} | ({"all": None} if compression.name == "NONE" else {})
            for which, wanted in kinds.items():
                ours = number / fastest(lambda wanted=wanted: read(path, wanted))
                what = f"MCAP ROS 2 {compression.name.lower()}, {which} channels"
                rows.append((what, ours, theirs, 5.0))
        for what, write, library, asked in (
            ("MCAP Keelson", keelson_log, _protobuf_library, 1.0),
            ("MCAP JSON", json_log, _json_library, 0.3),
        ):
            number = write(path, count)
            theirs = number / fastest(lambda library=library: library(path), 1)
            rows.append((what, number / fastest(lambda: read(path)), theirs, asked))
    return rows


def sized(path: Path, size: float) -> tuple[str, ...]:
    """A ROS 2 log of that size, its numbers noise, which zstd hardly packs."""
    ros2_log(path, round(size / BYTES), CompressionType.ZSTD, noise=True)
    return WANTED


SIZED: SizedLogs = {"MCAP": sized}
