"""Tables that programs of ROS write: stamps in two columns, counted since 1970, under topics."""

from pathlib import Path

import numpy as np
import pytest

from trialid import ingest
from trialid.errors import LogError

BEGIN = 1_746_606_930
STAMPS = [BEGIN * 10**9 + 100_000_000 * k for k in range(20)]
DELTA = [f"{0.1 * k:.1f}" for k in range(20)]


def write(path: Path, heads: str, *columns: list[str] | list[int]) -> Path:
    rows = (",".join(map(str, row)) for row in zip(*columns, strict=True))
    path.write_text("\n".join([heads, *rows]) + "\n", encoding="utf-8")
    return path


SECONDS, PARTS = ([n // 10**9 for n in STAMPS], [n % 10**9 for n in STAMPS])
NONE = [""] * 20


@pytest.mark.parametrize(
    ("heads", "columns"),
    [
        ("header_stamp_sec,header_stamp_nanosec,delta", (SECONDS, PARTS, DELTA)),
        ("header.stamp.secs,header.stamp.nsecs,delta", (SECONDS, PARTS, DELTA)),
        ("seconds,nanoseconds,delta", (SECONDS, PARTS, DELTA)),
        ("%time,field.header.stamp,delta", (STAMPS, STAMPS, DELTA)),
        ("rosbagTimestamp,stamp,secs,nsecs,delta", (STAMPS, NONE, SECONDS, PARTS, DELTA)),
        ("__time,/boat/delta", ([f"{n / 1e9:.3f}" for n in STAMPS], DELTA)),
        ("timestamp,delta", ([n // 10**6 for n in STAMPS], DELTA)),
        ("timestamp,delta", ([n // 10**3 for n in STAMPS], DELTA)),
    ],
)
def test_the_stamps_are_read(tmp_path: Path, heads: str, columns: tuple[list[int], ...]) -> None:
    path = write(tmp_path / "log.csv", heads, *columns)
    found = ingest.read(path).channels
    delta = next(one for name, one in found.items() if name.endswith("delta"))
    np.testing.assert_allclose(delta.t - STAMPS[0], np.subtract(STAMPS, STAMPS[0]), atol=1000)
    np.testing.assert_allclose(delta.t[0], STAMPS[0], atol=1000)
    np.testing.assert_allclose(delta.y, [float(x) for x in DELTA])


def test_a_unit_that_only_the_size_tells_is_said(tmp_path: Path) -> None:
    path = write(tmp_path / "log.csv", "t,delta", [n // 10**6 for n in STAMPS], DELTA)
    assert (
        "its times are ms since 1970 by their size: no unit is stated" in ingest.read(path).remarks
    )
    plain = write(tmp_path / "plain.csv", "t,delta", SECONDS, DELTA)
    assert not any("1970" in words for words in ingest.read(plain).remarks)


@pytest.mark.parametrize(
    ("heads", "columns", "words"),
    [
        ("t,delta", ([5 * 10**17 + k for k in range(20)], DELTA), "is no time in seconds"),
        ("sec,nanosec,delta", (SECONDS, [10**9, *PARTS[1:]], DELTA), "are no nanoseconds of one"),
        ("sec,nanosec,delta", (["1.5", *SECONDS[1:]], PARTS, DELTA), "are no whole seconds"),
        ("a_sec,b_nanosec,delta", (SECONDS, PARTS, DELTA), "no time column"),
        (
            "a_sec,a_nanosec,b_sec,b_nanosec,delta",
            (SECONDS, PARTS, SECONDS, PARTS, DELTA),
            "no time column",
        ),
    ],
)
def test_what_is_no_stamp_is_refused(
    tmp_path: Path, heads: str, columns: tuple[list[int], ...], words: str
) -> None:
    with pytest.raises(LogError, match=words):
        ingest.read(write(tmp_path / "log.csv", heads, *columns))
