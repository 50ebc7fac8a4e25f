"""Archives of NumPy's: what is read, what is left out, and what is never opened."""

import os
import pickle
import zipfile

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import draft_template, read

T = 0.5 * np.arange(20.0)
MOTION = {"delta": np.sin(T), "r": np.cos(T)}


def saved(tmp_path, **arrays):
    path = tmp_path / "log.npz"
    np.savez_compressed(path, **arrays)
    return path


def test_vectors_of_the_length_of_the_time_are_channels(tmp_path):
    log = read(saved(tmp_path, t=T, **MOTION, eta=np.outer(T, [1.0, 2.0]), L=160.0, other=T[:7]))
    assert log.adapter == "npz"
    assert list(log.channels) == ["delta", "r", "eta[0]", "eta[1]"]
    np.testing.assert_array_equal(log.channels["r"].y, MOTION["r"])
    np.testing.assert_array_equal(log.channels["r"].t, (1e9 * T).astype(np.int64))
    assert "other" in str(log.remarks)


def test_a_time_may_be_of_dates(tmp_path):
    dates = np.datetime64("2026-04-11T12:08:20") + (1000 * T).astype("timedelta64[ms]")
    found = read(saved(tmp_path, time=dates, **MOTION)).channels["delta"]
    assert found.t[0] == dates[0].astype("datetime64[ns]").astype(np.int64)
    np.testing.assert_array_equal(np.diff(found.t), np.full(19, 500_000_000))


def test_fields_of_an_array_are_channels(tmp_path):
    rows = np.zeros(20, [("t", "f8"), ("delta", "f4"), ("mode", "U4")])
    rows["t"], rows["delta"] = T, MOTION["delta"]
    assert list(read(saved(tmp_path, log=rows)).channels) == ["log.delta"]


class Opened:
    """What leaves a folder behind when it is unpickled."""

    def __init__(self, place):
        self.place = str(place)

    def __reduce__(self):
        return os.mkdir, (self.place,)


def test_objects_are_left_out_and_never_opened(tmp_path):
    place = tmp_path / "opened"
    pickle.loads(pickle.dumps(Opened(place)))
    place.rmdir()  # it was there
    log = read(saved(tmp_path, t=T, **MOTION, more=np.array([Opened(place)], object)))
    assert list(log.channels) == ["delta", "r"]
    assert "more" in str(log.remarks)
    assert not place.exists()


def test_a_damaged_array_takes_no_other_with_it(tmp_path):
    path = tmp_path / "log.npz"
    np.savez(path, t=T, **MOTION, v=np.sin(2 * T))
    raw = bytearray(path.read_bytes())
    at = raw.index(MOTION["r"].tobytes())
    raw[at : at + 8] = bytes(8)
    path.write_bytes(raw)
    log = read(path)
    assert list(log.channels) == ["delta", "v"]
    assert "recovered 3 of 4 arrays" in str(log.remarks)


def test_a_header_that_promises_more_than_follows_is_damage(tmp_path):
    path = saved(tmp_path, t=T)
    with zipfile.ZipFile(path) as file:
        body = file.read("t.npy").replace(b"(20,)", b"(9999999999999,)").replace(b" " * 11, b"", 1)
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("t.npy", body)
    with pytest.raises(LogError, match="no array in it can be read"):
        read(path)


def test_more_than_a_log_can_be_is_not_unpacked(tmp_path):
    path = saved(tmp_path, t=np.zeros(40_000_000))
    assert path.stat().st_size < 1_000_000
    with pytest.raises(LogError, match="320 MB of arrays"):
        read(path)


@pytest.mark.parametrize("keep", [40, 0.5, 0.98])
def test_an_archive_that_is_cut_short_is_one_line(tmp_path, keep):
    path = saved(tmp_path, t=T, **MOTION)
    raw = path.read_bytes()
    path.write_bytes(raw[: int(keep if keep > 1 else keep * len(raw))])
    with pytest.raises(LogError, match="no archive of arrays that can be read"):
        read(path)


def test_a_template_names_what_an_archive_does_not(tmp_path):
    path = saved(tmp_path, seconds_on=T, **MOTION)
    with pytest.raises(LogError, match="no time vector among seconds_on, delta, r"):
        read(path)
    assert '"seconds_on"' in draft_template(path)
