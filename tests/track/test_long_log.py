"""A long log is cut into the manoeuvres it holds; a log of one manoeuvre is a trial as it is."""

import functools
from itertools import pairwise
from pathlib import Path

import numpy as np
import sailed_days
from click.testing import CliRunner

from trialid import pipeline_file
from trialid.cli.main import commands
from trialid.workflow.first_pipeline.long_log import FEW, LONG, windows_of
from trialid.workflow.read_trials import align_trials

DAYS = range(6100, 6120)
sail_day = functools.cache(sailed_days.sail_day)
STEERED = 4
"""Of the kinds that a day is sailed of, the first so many are by the rudder."""


def test_each_window_holds_manoeuvres_whole_and_none_the_harbour_alone() -> None:
    windows, right = 0, 0
    for seed in DAYS:
        trial, day = sail_day(seed, STEERED)
        for one in windows_of(trial, day.length, day.speed):
            held = [m for m in day.truth if m[2] > one.begin and m[1] < one.end]
            whole = bool(held) and held[0][1] >= one.begin - 1.0 and held[-1][2] <= one.end + 1.0
            windows += 1
            right += whole
    assert windows >= 15
    assert right >= windows - 1


def test_what_is_short_or_mostly_manoeuvre_is_one_trial() -> None:
    for seed in DAYS:
        trial, day = sail_day(seed, STEERED)
        found = windows_of(trial, day.length, day.speed)
        assert len(found) != 1
        assert len(found) <= FEW
        assert sum(one.end - one.begin for one in found) <= 0.5 * trial.duration + 1.0
        assert all(a.end <= b.begin for a, b in pairwise(found))
        if trial.duration < LONG * day.length / day.speed:
            assert not found


def log_of(folder: Path, seed: int) -> tuple[Path, float]:
    """The day as a table of a recorder, and how long the ship is [m]."""
    trial, day = sail_day(seed, STEERED)
    deg = np.rad2deg(1.0)
    columns = {
        "time [s]": trial.t,
        "rudder angle [deg]": deg * trial.signals["delta"],
        "yaw rate [deg/s]": deg * trial.signals["r"],
        "heading [deg]": (deg * trial.signals["psi"]) % 360.0,
        "u [m/s]": trial.signals["u"],
    }
    path = folder / "day.csv"
    table, heads = np.column_stack([*columns.values()]), ",".join(columns)
    np.savetxt(path, table, "%.4f", ",", header=heads, comments="")
    return path, day.length


def test_a_pipeline_begins_with_a_trial_for_each_manoeuvre(tmp_path: Path) -> None:
    path, length = log_of(tmp_path, 6103)
    file = tmp_path / "p.toml"
    asked = ["inspect", str(path), "--init", str(file), "--length", f"{length:.1f}"]
    done = CliRunner().invoke(commands, asked)
    assert done.exit_code == 0, done.output
    pipeline = pipeline_file.load(file)
    assert len(pipeline.trials) >= 3
    assert [t.use for t in pipeline.trials].count("check") == 1
    names = [t.name for t in pipeline.trials]
    assert len({*names}) == len(names)
    assert all(name.startswith("day ") for name in names)
    trials = align_trials(pipeline, lambda *_: None)
    for trial, section in zip(trials, pipeline.trials, strict=True):
        assert section.window is not None
        begin, end = section.window
        assert abs(trial.duration - (end - begin)) < 3.0
        assert np.max(np.abs(trial.signals["delta"])) > np.deg2rad(8.0)
    assert sum(t.duration for t in trials) < 0.5 * sail_day(6103, STEERED)[0].duration
