import numpy as np
import pytest
from mcap.reader import make_reader
from sample_writers import imu, write_logs

T = 1_700_000_000_000_000_000 + np.arange(3000, dtype=np.int64) * 100_000_000
Y = np.sin(np.arange(3000) / 40)
IMU = imu(T, 0.1 * Y, 0 * Y, *[Y] * 4)
WRITERS = {
    "keelson": lambda path: write_logs.write_keelson_mcap(
        path, {"a": (T, Y), "b": (T[::3], Y[::3])}
    ),
    "ros2": lambda path: write_logs.write_ros2_mcap(path, {"/a": (T[::2], Y[::2])}, {"/imu": IMU}),
    "json": lambda path: write_logs.write_json_mcap(path, {"/a": (T, Y)}),
    "csv": lambda path: write_logs.write_csv(path, (T - T[0]) / 1e9, {"u[m/s]": Y}),
}


@pytest.mark.parametrize("name", WRITERS)
def test_the_same_arrays_give_the_same_bytes(tmp_path, name):
    for copy in ("one", "two"):
        WRITERS[name](tmp_path / copy)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


@pytest.mark.parametrize("name", ["keelson", "ros2", "json"])
def test_small_compressed_chunks_in_the_order_of_time(tmp_path, name):
    path = tmp_path / "log"
    WRITERS[name](path)
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        chunks = reader.get_summary().chunk_indexes
        times = [message.log_time for *_, message in reader.iter_messages(log_time_order=False)]
    assert len(chunks) > 1
    assert {chunk.compression for chunk in chunks} == {"zstd"}
    assert max(chunk.uncompressed_size for chunk in chunks) < 2 * write_logs.CHUNK_SIZE
    assert times == sorted(times)
