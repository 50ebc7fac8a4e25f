"""A trial that begins with a heel that is held is begun at the release, with the reason."""

import numpy as np
from click.testing import CliRunner
from test_first_pipeline import L, trial, written

from trialid import pipeline_file
from trialid.cli.main import commands


def decay(path, held):
    """10 s period, let go from 12 deg; rudder amidships, under way."""
    t = np.arange(0.0, held + 120.0, 0.5)
    free = np.maximum(t - held, 0.0)
    rng = np.random.default_rng(31)
    roll = 12.0 * np.exp(-0.04 * free) * np.cos(0.63 * free) + rng.normal(0.0, 0.05, len(t))
    still = {name: rng.normal(0.0, 0.01, len(t)) for name in ("rudder", "yaw", "heading")}
    columns = {
        "t_in_s": t,
        "rudder_in_deg": still["rudder"],
        "yaw_rate_in_deg_per_s": still["yaw"],
        "heading_in_deg": 90.0 + still["heading"],
        "roll_in_deg": roll,
        "sog_in_m_per_s": np.full(len(t), 7.7) + still["yaw"],
    }
    return written(path, **columns)


def zigzag(path, seed):
    t, delta, r, psi, u = trial(seed=seed)
    columns = {
        "t_in_s": t,
        "rudder_in_deg": delta,
        "yaw_rate_in_deg_per_s": r,
        "heading_in_deg": psi % 360.0,
        "roll_in_deg": 3.0 * r / np.max(np.abs(r)),
        "sog_in_m_per_s": u,
    }
    return written(path, **columns)


def test_the_window_begins_at_the_release(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    logs = [decay(tmp_path / "decay.csv", 15.0)]
    logs += [zigzag(tmp_path / f"zigzag-{k}.csv", k) for k in range(2)]
    words = ["inspect", *map(str, logs), "--init", "begun.toml", "--length", str(L)]
    done = CliRunner().invoke(commands, words)
    assert done.exit_code == 0, done.output
    asked = pipeline_file.load(tmp_path / "begun.toml")
    assert asked.trials[0].name == "decay"
    assert 15.0 <= asked.trials[0].window[0] <= 16.0
    assert [one.window for one in asked.trials[1:]] == [None, None]
    text = (tmp_path / "begun.toml").read_text(encoding="utf-8")
    assert "from where she is let go: phi stands at 12.0 deg" in text
