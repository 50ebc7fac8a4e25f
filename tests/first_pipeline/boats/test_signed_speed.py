"""A speed over ground has no sign: where she goes astern its course tells, and it is said."""

from pathlib import Path

import numpy as np
import pytest
from made_boat import T, begun, pushes, sailed, table

from trialid import pipeline_file
from trialid.alignment.track.astern import astern
from trialid.progress import silent
from trialid.workflow.read_trials import align_trials

REST = "where course and heading are more than 90 deg apart"
CURRENT = (0.3, -0.2)


def receiver(path: Path, astern: float, velocity: str = "", current=(0.0, 0.0)) -> Path:
    """A log of drives, gyro, compass and a receiver; of its speed the parts to east and north."""
    p = pushes(4, astern=astern)
    seen = sailed(p)
    psi = seen["psi"] + 0.4
    north = seen["u"] * np.cos(psi) + current[0]
    east = seen["u"] * np.sin(psi) + current[1]
    rng = np.random.default_rng(len(path.stem))
    noise = 0.01 * rng.standard_normal((2, len(T)))
    north, east = north + noise[0], east + noise[1]
    columns = {"motor_left_pct": 100.0 * p[:, 0], "motor_right_pct": 100.0 * p[:, 1]}
    columns["yaw_rate_dps"] = np.rad2deg(seen["r"])
    if velocity:
        half = (0.5 * np.pi - psi) / 2.0
        zero = np.zeros(len(T))
        columns |= {f"/imu:orientation.{a}": zero for a in "xy"}
        columns |= {"/imu:orientation.z": np.sin(half), "/imu:orientation.w": np.cos(half)}
        columns |= {f"{velocity}.x [m/s]": east, f"{velocity}.y [m/s]": north}
    else:
        columns["heading_deg"] = np.rad2deg(psi) % 360.0
        columns["sog_mps"] = np.hypot(north, east)
        columns["cog_deg"] = np.rad2deg(np.arctan2(east, north)) % 360.0
    return table(path, columns)


@pytest.mark.parametrize("velocity", ["", "/gps:twist.linear"])
def test_a_boat_that_goes_astern_is_read_so_and_told(tmp_path: Path, velocity: str) -> None:
    made = receiver(tmp_path / "back.csv", 0.9, velocity)
    text = begun(tmp_path, made).files[tmp_path / "p.toml"]
    assert "there the run reads u, which has no sign, as astern" in text
    assert "negative where cog says astern" in text
    [trial] = align_trials(pipeline_file.load(tmp_path / "p.toml"), silent)
    [told] = [one for one in trial.remarks if REST in one]
    assert "u: read as negative in" in told
    true = sailed(pushes(4, astern=0.9))["u"]
    t = trial.opening + trial.period * np.arange(trial.samples)
    np.testing.assert_allclose(trial.signals["u"], np.interp(t, T, true), atol=0.08)
    assert trial.signals["u"].min() < -0.3


def test_a_heading_of_ros_is_turned_to_the_north(tmp_path: Path) -> None:
    """It counts from the east: a current to the north was one to the west."""
    made = receiver(tmp_path / "back.csv", 0.9, "/gps:twist.linear")
    assert "counted from the east" in begun(tmp_path, made).files[tmp_path / "p.toml"]
    [trial] = align_trials(pipeline_file.load(tmp_path / "p.toml"), silent)
    t = trial.opening + trial.period * np.arange(trial.samples)
    true = np.interp(t, T, sailed(pushes(4, astern=0.9))["psi"]) + 0.4
    np.testing.assert_allclose(np.cos(trial.signals["psi"] - true), 1.0, atol=1e-3)
    ahead = trial.signals["u"] > 0.3
    assert np.cos(trial.signals["cog"] - true)[ahead].min() > 0.99


def test_a_velocity_in_her_own_axes_is_her_speed(tmp_path: Path) -> None:
    """Odometry has it so: its angle is no course, and nothing is asked."""
    p = pushes(4)
    seen = sailed(p)
    half = (0.5 * np.pi - seen["psi"]) / 2.0
    noise = 0.02 * np.random.default_rng(1).standard_normal(len(T))
    columns = {"motor_left_pct": 100.0 * p[:, 0], "motor_right_pct": 100.0 * p[:, 1]}
    columns |= {"yaw_rate_dps": np.rad2deg(seen["r"])}
    columns |= {f"/odom:orientation.{a}": np.zeros(len(T)) for a in "xy"}
    columns |= {"/odom:orientation.z": np.sin(half), "/odom:orientation.w": np.cos(half)}
    columns |= {"/odom:twist.linear.x [m/s]": seen["u"], "/odom:twist.linear.y [m/s]": noise}
    first = begun(tmp_path, table(tmp_path / "odom.csv", columns))
    assert not first.to_fill


def test_ahead_alone_nothing_is_read_or_said(tmp_path: Path) -> None:
    made = receiver(tmp_path / "ahead.csv", 0.0)
    text = begun(tmp_path, made).files[tmp_path / "p.toml"]
    assert "cog" not in text
    assert 'psi                      = { channel = "heading_deg", unit = "deg" }' in text


@pytest.mark.parametrize("velocity", ["", "/gps:twist.linear"])
def test_a_boat_that_is_carried_across_has_no_speed_ahead(tmp_path: Path, velocity: str) -> None:
    """Her speed over ground is that of the water: it was fitted as hers, and a dead band named."""
    made = receiver(tmp_path / "held.csv", 0.0, velocity, (-2.5, 2.5))
    first = begun(tmp_path, made)
    [asked] = first.to_fill
    assert "course and heading are so far apart" in asked
    [line] = [x for x in first.files[tmp_path / "p.toml"].splitlines() if x.startswith("u ")]
    assert 'unit = "?"' in line


def test_a_signed_speed_keeps_its_sign(tmp_path: Path) -> None:
    made = receiver(tmp_path / "back.csv", 0.9)
    begun(tmp_path, made)
    rows = np.loadtxt(made, delimiter=",", skiprows=1)
    rows[:, 5] = sailed(pushes(4, astern=0.9))["u"]
    head = made.read_text(encoding="utf-8").splitlines()[0]
    np.savetxt(made, rows, delimiter=",", header=head, comments="", fmt="%.6g")
    [trial] = align_trials(pipeline_file.load(tmp_path / "p.toml"), silent)
    assert not any(REST in one for one in trial.remarks)
    assert trial.signals["u"].min() < -0.3


def test_a_course_of_another_heading_signs_nothing() -> None:
    speed, known = np.ones(400), np.ones(400, np.bool_)
    heading = np.linspace(0.0, 12.0, 400)
    back = np.pi * (np.arange(400) < 40)
    found = astern(speed, heading + back, heading, known)
    assert found is not None
    assert found.sum() == 40
    for course in (heading, heading + np.pi, 2.3 * heading, heading + np.pi * (back == 0.0)):
        assert astern(speed, course, heading, known) is None


def test_a_current_is_sought_where_a_boat_has_a_heading(tmp_path: Path) -> None:
    made = [receiver(tmp_path / f"run{i * '_'}.csv", 0.0, "", CURRENT) for i in range(2)]
    begun(tmp_path, *made)
    trials = align_trials(pipeline_file.load(tmp_path / "p.toml"), silent)
    assert all("psi" in one.signals for one in trials)
