"""Signal K deltas alone: stamps of their sources, and lines without one."""

import json

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import read

START = 1_777_888_800_000_000_000


def delta(value, stamp, path="navigation.rateOfTurn"):
    update = {"$source": "imu", "values": [{"path": path, "value": value}]}
    told = {} if stamp is None else {"timestamp": stamp}
    return json.dumps({"context": "vessels.self", "updates": [{**told, **update}]}) + "\n"


def saved(folder, *lines):
    (folder / "log.jsonl").write_text("".join(lines), encoding="utf-8")
    return folder / "log.jsonl"


STAMPS = [f"2026-05-04T10:00:0{i}.{i}Z" for i in range(5)]


def test_updates_have_the_stamps_of_their_sources(tmp_path):
    found = read(saved(tmp_path, *(delta(0.1 * i, t) for i, t in enumerate(STAMPS))))
    rate = found.channels["navigation.rateOfTurn/imu:value"]
    assert (rate.unit, rate.quantity, rate.positive) == ("rad/s", "r", "starboard")
    assert rate.t.tolist() == [START + i * 1_100_000_000 for i in range(5)]
    np.testing.assert_array_equal(rate.y, [0.1 * i for i in range(5)])


def test_a_line_that_is_longer_than_any_delta_is_left_out(tmp_path):
    long = delta(0.7, STAMPS[0]).rstrip()[:-1] + f', "more": "{"x" * 2_000_000}"}}\n'
    found = read(saved(tmp_path, *(delta(0.1, t) for t in STAMPS), long))
    assert len(found.channels["navigation.rateOfTurn/imu:value"].y) == 5
    assert found.remarks[0].startswith("1 deltas or updates cannot be read")


@pytest.mark.parametrize("stamp", [None, "10:00:01", "2026-05-04T10:00:01+02:00", "2026-13-04T"])
def test_an_update_without_a_stamp_in_utc_is_left_out(tmp_path, stamp):
    lines = [*(delta(0.1, t) for t in STAMPS), delta(0.7, stamp), "{damaged\n"]
    found = read(saved(tmp_path, *lines))
    assert len(found.channels["navigation.rateOfTurn/imu:value"].y) == 5
    assert found.remarks[0].startswith("2 deltas or updates cannot be read")
    with pytest.raises(LogError, match="no delta with a number and a `timestamp`"):
        read(saved(tmp_path, delta(0.7, stamp)))
