"""How fast MCAP logs are read, beside the libraries: `python tests/benchmarks/ingest_mcap.py`.

`--large` writes a log of 1 GB, reads it in a process of its own and prints the peak memory.
"""

import argparse
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "ingest"))

import sample_writers  # noqa: E402
import write_mcap  # noqa: E402
from mcap.writer import CompressionType, Writer  # noqa: E402

from trialid.ingest import adapter_of, read  # noqa: E402
from trialid.ingest.adapter import NO_AIDS  # noqa: E402

write_logs = sample_writers.write_logs
Row = tuple[str, float, float, float]
"""What, ours [messages/s], the library's, the ratio that is asked for."""

START = 1_700_000_000_000_000_000
STEP = 20_000_000
WANTED = ("/imu:angular_velocity", "/imu:orientation", "/rudder:data", "/joints:position")
COUNT = 28_000
"""Messages of each of the three topics: 560 s at 50 Hz."""
CHUNK = 2**20
"""What the library's writer puts into a chunk unless told."""


def ros2_log(path: Path, count: int, compression: CompressionType, noise: bool = False) -> int:
    """Imu, Float64 and JointState, `count` of each; how many messages that is."""
    rng = np.random.default_rng(1)
    kinds = {**write_mcap.KINDS, "rudder": ("std_msgs/msg/Float64", write_logs.FLOAT64)}
    zero = {"header": write_mcap.header(START)}
    imu = bytearray(write_mcap.encoder("imu")(zero))
    joints = {**zero, "name": ["rudder", "sail"], "position": [0.0, 0.0], "velocity": [0.0, 0.0]}
    joint = bytearray(write_mcap.encoder("joints")(joints))
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


def _rate(count: int, work: Callable[[], object], repeats: int = 1) -> float:
    best = np.inf
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return count / best


def measure(scale: float = 1.0) -> list[Row]:
    """Ours against the plain library, both on the same log in the same process."""
    count = max(300, round(COUNT * scale))
    rows: list[Row] = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log"
        for compression in (CompressionType.ZSTD, CompressionType.LZ4, CompressionType.NONE):
            number = ros2_log(path, count, compression)
            ours = _rate(number, lambda: read(path, WANTED), 3)
            library = _rate(number, lambda: _ros2_library(path))
            rows.append((f"ros2 {compression.name.lower()}, needed channels", ours, library, 5.0))
        ours = _rate(number, lambda: read(path), 3)
        rows.append(("ros2 none, all channels", ours, library, 5.0))
        number = keelson_log(path, count)
        library = _rate(number, lambda: _protobuf_library(path))
        rows.append(("keelson", _rate(number, lambda: read(path), 3), library, 1.0))
        number = json_log(path, count)
        library = _rate(number, lambda: _json_library(path))
        rows.append(("json", _rate(number, lambda: read(path), 3), library, 0.5))
    return rows


PEAK = """
import resource, sys, time
from pathlib import Path
from trialid.ingest import adapter_of, read
path, wanted = Path(sys.argv[1]), tuple(sys.argv[2].split("|")) if sys.argv[2] else None
start = time.perf_counter()
recording = read(path, wanted)
samples = sum(len(channel.y) for channel in recording.channels.values())
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(f"{len(recording.channels)} channels, {samples} samples, "
      f"{time.perf_counter() - start:.1f} s, peak {peak:.0f} MB")
"""


def large(size: float = 1e9) -> None:
    """Peak memory of reading a log of `size` bytes: the needed channels, then each batch."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log"
        for compression in (CompressionType.NONE, CompressionType.ZSTD):
            number = ros2_log(path, round(size / 580), compression, noise=True)
            words = f"{compression.name}: {path.stat().st_size / 1e6:.0f} MB, {number} messages"
            print(words, flush=True)
            _peak("needed channels", path, WANTED)
            start = time.perf_counter()
            batches = tuple(adapter_of(path).batches(path, NO_AIDS))
            print(f"  {len(batches)} batches planned in {time.perf_counter() - start:.1f} s")
            for i, wanted in enumerate(batches, 1):
                _peak(f"batch {i}", path, wanted)


def _peak(what: str, path: Path, wanted: tuple[str, ...] | None) -> None:
    command = [sys.executable, "-c", PEAK, str(path), "|".join(wanted or ())]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    print(f"  {what}: {done.stdout.strip()}", flush=True)


def main() -> None:
    """Print the table, or with --large the peak memory."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--large", action="store_true", help="memory of reading 1 GB")
    parser.add_argument("--scale", type=float, default=1.0, help="share of the usual size")
    given = parser.parse_args()
    if given.large:
        large(1e9 * given.scale)
        return
    print(f"{'':32}{'ours':>12}{'library':>12}{'ratio':>8}{'asked':>8}   messages/s")
    for what, ours, library, asked in measure(given.scale):
        print(f"{what:32}{ours:12.0f}{library:12.0f}{ours / library:8.1f}{asked:8.1f}")


if __name__ == "__main__":
    main()
