"""Logs in which she only rolls: a pipeline for her roll, no rudder asked for."""

import numpy as np
import pytest
from click.testing import CliRunner
from test_first_pipeline import L, written

from trialid import pipeline_file
from trialid.cli.main import commands
from trialid.result.json_file import read
from trialid.workflow.first_pipeline.roll_decay import _decay

PERIOD = 12.0


def swing(heel, seed, held=8.0, square=0.0):
    """Let go after `held` s: time [s] and roll [deg], damped by 0.04 of what is critical."""
    w, dt = 2.0 * np.pi / PERIOD, 0.01
    x, p, roll = np.deg2rad(heel), 0.0, []
    for k in range(16000):
        if k >= held / dt:
            p += dt * (-(w**2) * x - 0.08 * w * p - square * p * abs(p))
            x += dt * p
        roll += [] if k % 20 else [np.rad2deg(x)]
    noise = 0.05 * np.random.default_rng(seed).standard_normal(len(roll))
    return 0.2 * np.arange(len(roll)), np.array(roll) + noise


def decay(path, heel, seed, speed=None, **others):
    t, roll = swing(heel, seed)
    columns = {"t_in_s": t, "roll_in_deg": roll}
    if speed is not None:
        noise = 0.01 * np.random.default_rng(seed + 1).standard_normal(len(t))
        columns["stw_in_m_per_s"] = speed + noise
    return written(path, **(columns | {n: y(t) for n, y in others.items()}))


def started(folder, monkeypatch, logs, *words):
    monkeypatch.chdir(folder)
    given = ["start", *map(str, logs), "--length", str(L), *words]
    return CliRunner().invoke(commands, given)


@pytest.mark.parametrize("rudder", [False, True])
def test_decays_under_way_are_begun_and_fitted_without_a_rudder(tmp_path, monkeypatch, rudder):
    still = {"rudder_in_deg": np.sin} if rudder else {}
    heels = (12.0, -16.0, 8.0)
    logs = [decay(tmp_path / f"d{k}.csv", heel, k, 7.7, **still) for k, heel in enumerate(heels)]
    done = started(tmp_path, monkeypatch, logs)
    assert done.exit_code == 0, done.output
    asked = pipeline_file.load(tmp_path / "first_trial.toml")
    assert asked.model.effects == ("linear_roll",)
    assert asked.identify.free == ("Kp", "GM")
    assert asked.align.period <= PERIOD / 30.0
    assert [t.use for t in asked.trials] == ["check", "fit", "fit"]  # the middle one by its heel
    assert all(8.0 <= t.window[0] <= 9.5 for t in asked.trials)
    assert read(tmp_path / "runs" / "first_trial" / "result.json").fit.eps_rmsn < 0.1


def test_at_rest_damping_at_rest_is_fitted(tmp_path, monkeypatch):
    logs = [decay(tmp_path / f"d{k}.csv", heel, k, 0.0) for k, heel in enumerate((12.0, -8.0))]
    done = started(tmp_path, monkeypatch, logs, "--speed", "15")
    assert done.exit_code == 0, done.output
    asked = pipeline_file.load(tmp_path / "first_trial.toml")
    assert [t.speed for t in asked.trials] == [0.0, 0.0]
    assert asked.identify.free == ("Kp0", "GM")
    assert read(tmp_path / "runs" / "first_trial" / "result.json").fit.eps_rmsn < 0.1


def test_a_new_ship_at_rest_asks_for_the_speed_she_goes_at(tmp_path, monkeypatch):
    done = started(tmp_path, monkeypatch, [decay(tmp_path / "d.csv", 12.0, 1, 0.0)])
    assert done.exit_code != 0
    assert "add --speed KNOTS" in done.stderr


def test_where_no_log_tells_a_speed_one_number_is_not_asked_for_two(tmp_path, monkeypatch):
    """`she rolls at rest; add --speed` was answered by a model that makes way at that speed."""
    logs = [decay(tmp_path / "d.csv", 12.0, 1)]
    done = started(tmp_path, monkeypatch, logs)
    assert "no log tells whether she makes way" in done.stderr
    assert "rolls at rest" not in done.stderr
    assert started(tmp_path, monkeypatch, logs, "--speed", "15").exit_code == 0
    text = (tmp_path / "first_trial.toml").read_text(encoding="utf-8")
    assert "# m/s, as stated; 0 where she rolled at rest: no log has u" in text


def test_where_no_log_tells_a_speed_she_is_read_as_at_rest_and_that_is_said(tmp_path, monkeypatch):
    logs = [decay(tmp_path / "d.csv", 12.0, 1)]
    monkeypatch.chdir(tmp_path)
    CliRunner().invoke(commands, ["ship", "s.toml", "--length", "100", "--speed", "15"])
    given = ["inspect", *map(str, logs), "--init", "d.toml", "--ship", "s.toml"]
    done = CliRunner().invoke(commands, given)
    assert done.exit_code == 0, done.output
    text = (tmp_path / "d.toml").read_text(encoding="utf-8")
    assert "CAREFUL: no log tells a speed, read as at rest" in text


@pytest.mark.parametrize("named", ["rudder_in_deg", "heading_in_deg", "yaw_rate_in_deg_per_s"])
def test_a_ship_that_is_steered_or_turns_is_none_of_these(tmp_path, monkeypatch, named):
    def goes(t):
        return 2.0 * np.sin(0.02 * t) if "rate" in named else 0.3 * t

    log = decay(tmp_path / "d.csv", 12.0, 1, 7.7, **{named: goes})
    done = started(tmp_path, monkeypatch, [log])
    assert "d.csv: no moving" in done.stderr


def test_what_does_not_die_out_is_no_decay():
    t, roll = swing(12.0, 1)
    assert _decay(roll).period == pytest.approx(PERIOD / (t[1] - t[0]), rel=0.05)
    rng = np.random.default_rng(3)
    assert _decay(5.0 * np.sin(0.5 * t)) is None
    assert _decay(5.0 * np.exp(-0.003 * t) * np.cos(0.1 * np.pi * t)) is None
    assert _decay(5.0 * np.exp(-0.01 * t) * np.cos(0.1 * np.pi * t)) is not None
    assert _decay(rng.standard_normal(len(t))) is None
    assert _decay(3.0 - 3.0 * np.exp(-t / 10.0) * np.cos(0.1 * t)) is None
    assert _decay(roll[::-1]) is None


@pytest.mark.parametrize("quiet", [0.0, 21.3])
def test_a_swing_that_is_worked_up_by_hand_is_hers_from_the_greatest_on(
    tmp_path, monkeypatch, quiet
):
    """She lies still, is rolled by hand three times, further each time, and is left alone."""
    _, roll = swing(12.0, 5, held=0.0)
    before = np.arange(0.0, 1.5 * PERIOD, 0.2)
    by_hand = -12.0 * (before / before[-1]) ** 2 * np.cos(2.0 * np.pi * before / PERIOD)
    whole = np.concatenate([np.zeros(int(quiet / 0.2)), by_hand, roll])
    log = written(tmp_path / "d.csv", t_in_s=0.2 * np.arange(len(whole)), roll_in_deg=whole)
    done = started(tmp_path, monkeypatch, [log], "--speed", "15")
    assert done.exit_code == 0, done.output
    [trial] = pipeline_file.load(tmp_path / "first_trial.toml").trials
    begun = quiet + before[-1]
    assert begun - 0.3 <= trial.window[0] <= begun + 1.0
    found = read(tmp_path / "runs" / "first_trial" / "result.json")
    assert found.fit.eps_rmsn < 0.1
