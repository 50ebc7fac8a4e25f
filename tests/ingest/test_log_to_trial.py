"""One motion in logs of every format gives one trial."""

from pathlib import Path

import numpy as np
import pytest
from sample_writers import imu, write_logs

from trialid.alignment import SignalSource, align
from trialid.ingest import LogFile, read, read_together

START = 1_700_000_000_000_000_000
REAL = Path(__file__).parents[3] / "shared/data/kvlcc2_roll_decay/model_test_21337.csv"


def rudder(t):
    return np.radians(10) * np.sin(0.06 * t)


def turn(t):
    return 0.01 * np.sin(0.06 * t - 0.9)


def roll(t):
    return 0.05 * np.sin(0.5 * t)


def at(rate):
    """Times [s] and stamps [ns]."""
    t = np.arange(0, 300, 1 / rate)
    return t, START + np.rint(t * 1e9).astype(np.int64)


def keelson(folder):
    prefix, degrees = "rise/@v0/ship/pubsub", np.degrees
    (slow, slow_ns), (fast, fast_ns) = at(10), at(50)
    channels = {
        f"{prefix}/rudder_angle_deg/gear": (slow_ns, degrees(rudder(slow))),
        f"{prefix}/yaw_rate_degps/gyro": (fast_ns, degrees(turn(fast))),
        f"{prefix}/roll_deg/gyro": (fast_ns, degrees(roll(fast))),
    }
    write_logs.write_keelson_mcap(folder / "log", channels, 10_000_000)
    return [folder / "log"], [
        SignalSource("delta", f"{prefix}/rudder_angle_deg/gear:value", None, "starboard"),
        SignalSource("r", f"{prefix}/yaw_rate_degps/gyro:value"),
        SignalSource("phi", f"{prefix}/roll_deg/gyro:value"),
    ]


def ros2(folder):
    """Axes of REP-103: the rate of turn counts to port; a rudder without a stamp of its own."""
    (slow, slow_ns), (fast, fast_ns) = at(10), at(50)
    none = np.zeros(len(fast))
    heading = np.cumsum(-turn(fast)) / 50
    moved = imu(fast_ns, roll(fast), none, heading, none, none, -turn(fast))
    write_logs.write_ros2_mcap(
        folder / "log", {"/rudder": (slow_ns, -rudder(slow))}, {"/imu": moved}, 10_000_000
    )
    return [folder / "log"], [
        SignalSource("delta", "/rudder:data", "rad", "port", delay=0.01),
        SignalSource("r", "/imu:angular_velocity.z", "rad/s", "port"),
        SignalSource("phi", "/imu:orientation", as_="roll"),
    ]


def json_and_csv(folder):
    """Two logs of one trial, on one clock."""
    (slow, slow_ns), (fast, _) = at(10), at(50)
    write_logs.write_json_mcap(folder / "a", {"/rudder": (slow_ns, rudder(slow))}, 10_000_000)
    columns = {"r[deg/s]": np.degrees(turn(fast)), "phi[deg]": np.degrees(roll(fast))}
    write_logs.write_csv(folder / "b", START / 1e9 + fast, columns, ";", ",")
    return [folder / "a", folder / "b"], [
        SignalSource("delta", "/rudder:value", "rad", "starboard"),
        SignalSource("r", "r"),
        SignalSource("phi", "phi"),
    ]


@pytest.mark.parametrize("write", [keelson, ros2, json_and_csv])
def test_log_to_trial(tmp_path, write):
    paths, sources = write(tmp_path)
    recordings = read_together(
        [LogFile(path) for path in paths], [source.channel for source in sources]
    )
    trial = align("zigzag", "fit", recordings, sources, 0.5)
    assert len(trial.logs) == len(paths)
    for name, motion in {"delta": rudder, "r": turn, "phi": roll}.items():
        valid = trial.valid[name]
        assert valid.mean() > 0.98
        error = np.abs(trial.signals[name] - motion(trial.t))[valid].max()
        assert error < 1e-3 * np.abs(motion(trial.t)).max()


@pytest.mark.real_data
@pytest.mark.skipif(not REAL.exists(), reason="real records are not here")
def test_a_real_roll_decay_to_a_trial():
    """Its columns carry no units; the pipeline states them."""
    sources = [SignalSource("phi", "phi", "rad"), SignalSource("psi", "psi", "rad")]
    trial = align("roll decay", "fit", [read(REAL)], sources, 0.05)
    assert trial.samples == 1833
    assert trial.valid["phi"].mean() > 0.99
    moving = trial.signals["phi"][trial.t > 30]
    crossings = np.flatnonzero(np.diff(np.sign(moving - moving.mean())))
    half_period = np.mean(np.diff(crossings)) * trial.period
    assert np.pi / half_period == pytest.approx(2.46, rel=0.02)  # rad/s, as published
