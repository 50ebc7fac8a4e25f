"""A long log is cut into the manoeuvres it holds, or where she is steered most; one is a trial."""

import dataclasses
import functools
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import sailed_days
from click.testing import CliRunner

from trialid import pipeline_file
from trialid.cli.main import commands
from trialid.trial import Trial
from trialid.workflow.first_pipeline.long_log import FEW, LONG, STRETCH, windows_of
from trialid.workflow.read_trials import align_trials

DAYS = range(6100, 6120)
sail_day = functools.cache(sailed_days.sail_day)
STEERED = 4
"""Of the kinds that a day is sailed of, the first so many are by the rudder."""


@pytest.mark.study(turn="each")
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


@pytest.mark.parametrize(
    "days", [DAYS[:5], pytest.param(DAYS[5:], marks=pytest.mark.study(turn="each"))]
)
def test_what_is_short_or_mostly_manoeuvre_is_one_trial(days: range) -> None:
    for seed in days:
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


def test_manoeuvres_in_which_a_sensor_has_died_are_left_out_and_told() -> None:
    """Of an outsider's day the later half was chosen too, and the run refused all of it."""
    trial, day = sail_day(6103, STEERED)
    whole = windows_of(trial, day.length, day.speed)
    died = whole[-1].begin + 20.0
    known = trial.valid | {"r": trial.valid["r"] & (trial.t < died)}
    found = windows_of(dataclasses.replace(trial, valid=known), day.length, day.speed)
    assert [one.begin for one in found] == [one.begin for one in whole[:-1]]
    told = f"from {whole[-1].begin:.0f} s on, in which r is not measured throughout"
    assert told in found[0].beside
    assert not any(one.beside for one in (*found[1:], *whole))


LENGTH, SPEED, PERIOD = 90.0, 7.5, 0.5


def passage(lengths: float, seed: int) -> tuple[Trial, np.ndarray]:
    """Under an autopilot: noise about zero, as large as `swing` [rad]; a tenth of it in harbour.

    The harbour is first, with the rudder hard over at random; a recorder fails in the largest
    swing.
    """
    rng = np.random.default_rng([seed, 61])
    samples = int(lengths * LENGTH / SPEED / PERIOD)
    stretch = round(STRETCH * LENGTH / SPEED / PERIOD)
    swing = np.repeat(np.deg2rad(rng.uniform(0.2, 3.0, samples // stretch + 1)), stretch)[:samples]
    delta = swing * rng.uniform(-1.0, 1.0, samples)
    u = np.full(samples, SPEED)
    harbour = slice(0, samples // 10)
    delta[harbour], u[harbour] = 0.6 * rng.choice([-1.0, 1.0], samples // 10), 1.0
    signals = {"delta": delta, "r": 0.01 * delta, "u": u}
    valid = {n: np.ones(samples, np.bool_) for n in signals}
    lost = int(np.argmax(np.where(u > 2.0, swing, 0.0)))
    valid["r"][lost : lost + stretch] = False
    return Trial("day", "fit", PERIOD, signals, valid), swing


@pytest.mark.parametrize("seed", range(4))
def test_a_passage_begins_with_the_stretches_in_which_she_is_steered_most(seed: int) -> None:
    trial, swing = passage(40 * STRETCH, seed)
    found = windows_of(trial, LENGTH, SPEED)
    assert len(found) == FEW
    assert all(a.end <= b.begin for a, b in pairwise(found))
    taken = np.zeros(trial.samples, np.bool_)
    for one in found:
        assert one.end - one.begin == pytest.approx(STRETCH * LENGTH / SPEED)
        taken |= (trial.t >= one.begin) & (trial.t < one.end)
    assert not taken[trial.signals["u"] < 2.0].any()
    assert trial.valid["r"][taken].all()
    able = trial.valid["r"] & (trial.signals["u"] > 2.0)
    assert np.median(swing[taken]) > np.quantile(swing[able], 0.75)
    assert swing[taken].min() > np.median(swing[able])


def test_a_shorter_passage_is_one_trial_and_so_is_one_that_is_never_steered() -> None:
    assert not windows_of(passage(1.9 * FEW * STRETCH, 1)[0], LENGTH, SPEED)
    trial, _ = passage(40 * STRETCH, 2)
    still = dataclasses.replace(trial, signals={**trial.signals, "delta": np.zeros(trial.samples)})
    assert not windows_of(still, LENGTH, SPEED)


def with_pauses(pauses: list[tuple[float, float]], *, alone: str = "") -> Trial:
    """Of 100 lengths at the rudder; in pauses [lengths] nothing is measured, or `alone` is not."""
    length = LENGTH / SPEED / PERIOD
    samples = round(100.0 * length)
    t = PERIOD * np.arange(samples)
    signals = {"delta": 0.3 * np.sign(np.sin(t / 40.0)), "r": 0.01 * np.sin(t / 40.0)}
    signals["u"] = np.full(samples, SPEED)
    valid = {n: np.ones(samples, np.bool_) for n in signals}
    for begin, end in pauses:
        for name in [alone] if alone else ["delta", "r"]:  # the speed is stated, not measured
            valid[name][round(begin * length) : round(end * length)] = False
    return Trial("log", "fit", PERIOD, signals, valid)


def test_a_log_in_which_the_recorder_paused_is_as_many_trials_as_it_has_parts() -> None:
    found = windows_of(with_pauses([(30.0, 40.0), (70.0, 75.0)]), LENGTH, SPEED)
    second = LENGTH / SPEED
    ends = [(one.begin / second, one.end / second) for one in found]
    assert ends == [(0.0, 30.0), (40.0, 70.0), (75.0, 100.0)]
    assert {one.why for one in found} == {"recorded without a pause"}


@pytest.mark.parametrize("alone", ["delta", "r"])
def test_a_signal_that_is_missing_alone_parts_no_log(alone: str) -> None:
    assert not windows_of(with_pauses([(30.0, 40.0), (70.0, 75.0)], alone=alone), LENGTH, SPEED)


def test_neither_a_short_hole_nor_scraps_make_trials() -> None:
    assert not windows_of(with_pauses([(30.0, 30.4)]), LENGTH, SPEED)
    assert not windows_of(
        with_pauses([(10.0 * k, 10.0 * k + 1.0) for k in range(10)]), LENGTH, SPEED
    )
    assert not windows_of(with_pauses([(14.0, 20.0)]), LENGTH, SPEED)  # one part alone is whole
