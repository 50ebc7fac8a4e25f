"""A `result.json` changed by hand: a report, or one line; never a traceback."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from edited import edited
from limits import LONGEST_MESSAGE, time_limit

from trialid.cli.console import render
from trialid.errors import TrialidError
from trialid.report.pages.folder import read_run, write_one
from trialid.report.terminal.summary import summary
from trialid.result import json_file

ROOT = Path(__file__).parents[2]
PIPELINE = """ship = "{ship}"
[model]
states = ["v", "r"]
effects = ["linear_hull", "linear_rudder"]
[identify]
free = ["Nr", "Ndelta"]
outputs = ["r"]
[diagnose]
candidates = ["yaw_drag_rar"]
[[trial]]
name = "a"
logs = ["log.csv"]
speed = 7.0
[trial.signals]
delta = {{ channel = "d", unit = "deg", positive = "starboard" }}
r = {{ channel = "r", unit = "deg/s" }}
"""
EACH_TIME, STUDY = 150, 2_000


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A small run."""
    home = tmp_path_factory.mktemp("run")
    rng, rate, rows = np.random.default_rng(1), 0.0, ["t,d,r"]
    for k in range(400):
        rudder = 10.0 if math.sin(0.05 * k) > 0 else -10.0
        rate += 0.5 * (0.003 * rudder - rate / 20)
        rows.append(f"{0.5 * k},{rudder},{rate + rng.normal(0, 0.01):.4f}")
    (home / "log.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    ship = (ROOT / "sample_data/ships/s175q.toml").as_posix()
    (home / "p.toml").write_text(PIPELINE.format(ship=ship), encoding="utf-8")
    subprocess.run(
        [sys.executable, "-m", "trialid", "run", "p.toml", "--quiet"],
        cwd=home, env={**os.environ, "PYTHONPATH": str(ROOT)}, check=True,
    )  # fmt: skip
    return home / "runs" / "p"


def shown(folder, place):
    """Whether a report and a summary come out, else the message."""
    try:
        with time_limit():
            found = json_file.read(folder / "result.json")
            done = read_run("a", folder, found)
            render(summary(found))
            write_one(done, place)
    except TrialidError as error:
        return str(error)
    return None


def check(folder, tmp_path, count, seed):
    sound = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    try:
        refused = 0
        for number in range(count):
            rng = np.random.default_rng((seed, number))
            (folder / "result.json").write_text(json.dumps(edited(sound, rng)), encoding="utf-8")
            message = shown(folder, tmp_path / "report")
            refused += message is not None
            assert message is None or (message.isprintable() and len(message) < LONGEST_MESSAGE)
        assert 0.05 * count < refused < count
    finally:
        (folder / "result.json").write_text(json.dumps(sound), encoding="utf-8")


@pytest.mark.study(turn=6)
def test_results_changed_by_hand(folder, tmp_path):
    assert shown(folder, tmp_path / "sound") is None
    check(folder, tmp_path, EACH_TIME, 5)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", range(6, 11))
def test_many_results_changed_by_hand(folder, tmp_path, seed):
    check(folder, tmp_path, STUDY, seed)


def test_infinite_is_no_number_of_json(folder, tmp_path):
    """JSON has none; Python reads it all the same."""
    path = folder / "result.json"
    sound = path.read_text(encoding="utf-8")
    try:
        for number in ("Infinity", "NaN", "1e999"):
            data = json.loads(sound)
            data["fit"]["V"] = "HERE"
            path.write_text(json.dumps(data).replace('"HERE"', number), encoding="utf-8")
            assert "not JSON" in shown(folder, tmp_path / "report")
    finally:
        path.write_text(sound, encoding="utf-8")
