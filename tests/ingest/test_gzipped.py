"""Logs packed with gzip."""

import gzip
import tempfile
from pathlib import Path

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import LogFile, draft_template, files_of, gzipped, read
from trialid.inspection import inspect_log

SAMPLES = Path(__file__).parents[2] / "sample_data" / "hidden_effect"
LOGS = sorted(path.name for path in SAMPLES.iterdir() if path.suffix in (".mcap", ".csv"))


def packed(path, folder):
    there = folder / f"{path.name}.gz"
    there.write_bytes(gzip.compress(path.read_bytes(), mtime=0))
    return there


@pytest.fixture
def swept(monkeypatch, tmp_path):
    """A place for temporary files of the test's own, which must be empty at its end."""
    place = tmp_path / "temporary"
    place.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(place))
    yield
    assert list(place.iterdir()) == []


@pytest.mark.usefixtures("swept")
@pytest.mark.parametrize("name", LOGS)
def test_every_sample_log_is_the_same_packed(tmp_path, name):
    plain, there = read(SAMPLES / name), packed(SAMPLES / name, tmp_path)
    found = read(there)
    assert (found.path, found.adapter, found.remarks) == (there, plain.adapter, plain.remarks)
    assert list(found.channels) == list(plain.channels)
    for one, other in zip(found.channels.values(), plain.channels.values(), strict=True):
        np.testing.assert_array_equal(one.t, other.t)
        np.testing.assert_array_equal(one.y, other.y)
    assert inspect_log(there).channels.keys() == inspect_log(SAMPLES / name).channels.keys()
    assert len(files_of(LogFile(tmp_path))) == 1


@pytest.mark.usefixtures("swept")
def test_a_packed_log_that_is_cut_gives_what_is_intact(tmp_path):
    rows = np.random.default_rng(5).standard_normal(20_000)
    text = "t,u\n" + "".join(f"{k},{y}\n" for k, y in enumerate(rows))
    whole = gzip.compress(text.encode())
    path = tmp_path / "log.csv.gz"
    path.write_bytes(whole[: len(whole) // 2])
    found = read(path)
    assert 8_000 < len(found.channels["u"].y) < 12_000
    assert "the packed file is damaged or cut after" in found.remarks[0]
    assert found.channels["u"].y[:50].tolist() == rows[:50].tolist()
    path.write_bytes(whole[:12])
    with pytest.raises(LogError, match="packed with gzip"):
        read(path)


@pytest.mark.usefixtures("swept")
def test_what_is_said_names_the_packed_file(tmp_path):
    path = tmp_path / "log.csv.gz"
    path.write_bytes(gzip.compress(b"x,u\n0,1\n"))
    with pytest.raises(LogError, match=r"log\.csv\.gz: no time column among x, u") as caught:
        read(path)
    assert "trialid-gzip" not in str(caught.value)
    assert '["x", "u"]' in draft_template(path)


@pytest.mark.usefixtures("swept")
def test_the_bound_is_for_what_is_unpacked(tmp_path, monkeypatch):
    text = b"t,u\n" + b"".join(b"%d,0\n" % k for k in range(5_000))
    path = tmp_path / "log.csv.gz"
    path.write_bytes(gzip.compress(text))
    monkeypatch.setattr(gzipped, "SMALL", len(text))
    monkeypatch.setattr(gzipped, "TIMES", 1)
    assert len(read(path).channels["u"].y) == 5_000
    monkeypatch.setattr(gzipped, "SMALL", len(text) - 1)
    with pytest.raises(LogError, match="which no log of its size does"):
        read(path)


@pytest.mark.usefixtures("swept")
def test_a_log_packed_twice_is_no_log(tmp_path):
    path = tmp_path / "log.gz"
    path.write_bytes(gzip.compress(gzip.compress(b"t,u\n0,1\n")))
    with pytest.raises(LogError, match="none of the formats"):
        read(path)
