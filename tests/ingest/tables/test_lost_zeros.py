"""Clocks whose fractions of a second lost the zeros in front of them."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from trialid import ingest
from trialid.inspection.channel_names import quantity, unit_in_name

BEGIN = datetime(2025, 5, 7, 10, 35, 34, tzinfo=UTC)
STEPS = [0.065064401 + 0.270000007 * k for k in range(60)]


def written(seconds: float, fraction: str) -> str:
    whole, part = divmod(round(1e9 * seconds), 10**9)
    return f"{BEGIN + timedelta(seconds=whole):%Y/%m/%d %H:%M:%S}.{fraction.format(part)}"


def read(path: Path, stamps: list[str]) -> tuple[np.ndarray, tuple[str, ...]]:
    rows = [f"{stamp},{0.1 * k:.1f}" for k, stamp in enumerate(stamps)]
    path.write_text("\n".join(["time,delta", *rows]) + "\n", encoding="utf-8")
    found = ingest.read(path)
    return found.channels["delta"].t, found.remarks


@pytest.mark.parametrize(("fraction", "lost"), [("{:09d}", False), ("{}", True)])
def test_zeros_in_front_of_a_fraction_are_put_back(
    tmp_path: Path, fraction: str, lost: bool
) -> None:
    t, remarks = read(tmp_path / "log.csv", [written(x, fraction) for x in STEPS])
    np.testing.assert_allclose((t - t[0]) * 1e-9, np.subtract(STEPS, STEPS[0]), atol=1e-8)
    assert t[0] * 1e-9 - BEGIN.timestamp() == pytest.approx(STEPS[0], abs=1e-6)
    assert any("lost its zeros in front" in said for said in remarks) is lost


def test_zeros_left_out_at_the_end_are_no_lost_ones(tmp_path: Path) -> None:
    """Halves and quarters of a second, of which one row stands in the wrong place."""
    stamps = [written(0.125 * k, "{:09d}").rstrip("0").rstrip(".") for k in range(1, 40)]
    stamps[10], stamps[11] = stamps[11], stamps[10]
    _, remarks = read(tmp_path / "log.csv", stamps)
    assert not any("zeros" in said for said in remarks)


@pytest.mark.parametrize(
    ("name", "meant"),
    [("twist_angular_z", "r"), ("/odom:twist.twist.angular.x", "p"), ("twist_angular_y", None)],
)
def test_a_rate_of_a_message_of_ros_is_one_in_a_table_too(name: str, meant: str | None) -> None:
    assert quantity(name, unit_in_name(name)) == meant
