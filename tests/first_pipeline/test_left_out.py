"""Logs that hold too little to begin with, beside others that do."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from geared_rudder import geared

from trialid import pipeline_file
from trialid.cli import main
from trialid.errors import LogError
from trialid.inspection import inspect_log, inspect_trials
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import Starter, starter

T = np.arange(0.0, 600.0, 1.0)
ZIGZAG = 10.0 * np.sign(np.sin(0.03 * T))


def log(path: Path, orders: np.ndarray) -> Path:
    """Heading, rudder, shaft and speed of a ship of 150 m."""
    delta, r = geared(orders, 1.0), np.zeros(len(T))
    for k in range(len(T) - 1):
        r[k + 1] = r[k] + (0.03 * delta[k] - r[k]) / 20.0
    rng = np.random.default_rng(len(path.stem))
    psi = np.cumsum(r) + 0.1 * rng.standard_normal(len(T))
    speed = 14.0 + 0.05 * rng.standard_normal(len(T))
    table = np.column_stack([T, psi % 360.0, delta, speed, 80.0 + r])
    heads = "Time,HDG [deg],Rudder [deg],STW [kn],RPM"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.5g")
    return path


def begun(folder: Path, *logs: Path) -> Starter:
    given = (folder / "p.toml", None, Given(length=150.0))
    made = starter([inspect_log(one) for one in logs], *given)
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return made


def test_a_log_whose_rudder_stays_is_left_out_beside_one_that_steers(tmp_path: Path) -> None:
    still = log(tmp_path / "a_speed_run.csv", 0.0 * T)
    made = begun(tmp_path, still, log(tmp_path / "zz.csv", ZIGZAG))
    [words] = made.left_out
    assert words.startswith("a_speed_run.csv: no moving rudder or rudder order is recognised")
    assert "('Rudder' does not move)" in words
    assert [one.path.name for one in made.trials] == ["zz.csv"]
    assert f"# left out: {words}" in (tmp_path / "p.toml").read_text(encoding="utf-8")
    assert [one.name for one in pipeline_file.load(tmp_path / "p.toml").trials] == ["zz"]


def rudder_of(path: Path, word: str) -> Path:
    """The log with this in place of every angle of the rudder."""
    head, *rows = log(path, ZIGZAG).read_text(encoding="utf-8").splitlines()
    fields = [row.split(",") for row in rows]
    made = [",".join((*one[:2], word, *one[3:])) for one in fields]
    path.write_text("\n".join((head, *made)), encoding="utf-8")
    return path


def test_a_rudder_in_words_is_said_to_be_text(tmp_path: Path) -> None:
    path = rudder_of(tmp_path / "a.csv", "on")
    [told] = begun(tmp_path, path, log(tmp_path / "zz.csv", ZIGZAG)).left_out
    assert "(column 'Rudder' holds text, left out)" in told


def test_a_rudder_without_a_number_is_none(tmp_path: Path) -> None:
    """It ended in a traceback; `inspect` had said `not available`."""
    path = rudder_of(tmp_path / "a.csv", "nan")
    with pytest.raises(LogError, match="'Rudder' holds no number"):
        begun(tmp_path, path)


def test_a_rudder_that_stays_is_no_thruster(tmp_path: Path) -> None:
    """Her shaft was said to steer her: it is called as what drives a boat is."""
    with pytest.raises(LogError) as error:
        begun(tmp_path, log(tmp_path / "a.csv", 0.0 * T))
    assert "'Rudder' does not move), so no pipeline can be begun; see" in str(error.value)
    assert "thrusters" not in str(error.value)


def test_a_course_over_ground_is_no_heading_and_what_to_do_is_said(tmp_path: Path) -> None:
    path = log(tmp_path / "gps.csv", ZIGZAG)
    text = path.read_text(encoding="utf-8").replace("HDG [deg]", "cog [deg]").replace("STW", "SOG")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LogError) as error:
        begun(tmp_path, path)
    assert "'cog' is no heading, for drift and current are in it" in str(error.value)
    assert "`trialid guide track`" in str(error.value)


def test_start_says_what_is_left_out(tmp_path: Path) -> None:
    log(tmp_path / "still.csv", 0.0 * T)
    log(tmp_path / "zz.csv", ZIGZAG)
    to = ["--pipeline", str(tmp_path / "p.toml"), "--length", "150"]
    done = CliRunner().invoke(main.commands, ["start", str(tmp_path), *to])
    assert done.exit_code == 0, done.output
    assert "Left out: still.csv: no moving rudder" in " ".join(done.output.split())


def test_a_log_in_which_she_does_not_go_her_own_length_is_left_out(tmp_path: Path) -> None:
    whole, short = (log(tmp_path / f"{name}.csv", ZIGZAG) for name in ("zz", "a_test"))
    lines = short.read_text(encoding="utf-8").splitlines(keepends=True)
    for rows, count in ((15, 1), (25, 2)):  # she takes 20 s for it
        short.write_text("".join(lines[: rows + 1]), encoding="utf-8")
        made = begun(tmp_path, short, whole)
        assert len(made.trials) == count
        assert len(made.left_out) == 2 - count
    short.write_text("".join(lines[:16]), encoding="utf-8")
    assert len(begun(tmp_path, short).trials) == 1  # what that is worth the fit says


def test_what_is_no_log_in_a_folder_of_logs_stops_none(tmp_path: Path) -> None:
    log(tmp_path / "zz.csv", ZIGZAG)
    (tmp_path / "remarks.csv").write_text("trial,wind\nzz,3\n", encoding="utf-8")
    said: list[str] = []
    [one] = inspect_trials(tmp_path, say=said.append)
    assert [file.path.name for file in one.files] == ["zz.csv"]
    [words] = said
    assert "remarks.csv: no time column among trial, wind" in words
    (tmp_path / "zz.csv").unlink()
    with pytest.raises(LogError, match="no time column"):
        inspect_trials(tmp_path)


def test_an_empty_log_and_folders_beside_others_are_told(tmp_path: Path) -> None:
    """`3 trials` was said of four files, one of them empty, and nothing of logs in a folder."""
    log(tmp_path / "zz.csv", ZIGZAG)
    (tmp_path / "a.csv").touch()
    (tmp_path / "notes.txt").touch()
    for name in ("day1", "runs"):
        (tmp_path / name).mkdir()
    log(tmp_path / "day1" / "zz.csv", ZIGZAG)
    said: list[str] = []
    assert len(inspect_trials(tmp_path, say=said.append)) == 1
    empty, folder = said
    assert "a.csv: is empty (0 bytes)" in empty
    assert "day1: folders in a folder are not looked into" in folder


def test_roll_decays_at_rest_beside_zigzags_are_left_out_with_what_to_do(tmp_path: Path) -> None:
    """One was held out, and the pipeline was refused: the ship lies still."""
    decay = log(tmp_path / "decay.csv", 0.1 * ZIGZAG)
    rows = np.loadtxt(decay, delimiter=",", skiprows=1)
    rows[:, 3] *= 0.004
    heads = decay.read_text(encoding="utf-8").splitlines()[0]
    np.savetxt(decay, rows, delimiter=",", header=heads, comments="", fmt="%.5g")
    made = begun(tmp_path, decay, log(tmp_path / "zz.csv", ZIGZAG), log(tmp_path / "b.csv", ZIGZAG))
    [words] = made.left_out
    assert words.startswith("decay.csv: she lies still, 0.029 m/s where others have 7.2")
    assert words.endswith("trialid start decay.csv --pipeline roll.toml")
    assert sorted(one.path.name for one in made.trials) == ["b.csv", "zz.csv"]
