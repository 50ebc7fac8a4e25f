"""Rudders of small numbers and no unit: degrees of a quiet passage, radians, a share of full."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid import pipeline_file
from trialid.errors import LogError, TrialidError
from trialid.inspection import Inspection, inspect_log
from trialid.progress import silent
from trialid.ship.estimate import Given
from trialid.trial import Trial
from trialid.workflow.first_pipeline import Starter, starter
from trialid.workflow.read_trials import align_trials


def log(path: Path, angle: float, factor: float = 1.0, name: str = "rudder") -> Path:
    """Zig-zags of a ship of 95 m at 8 m/s, rudder in degrees, or as many times `factor`."""
    t = np.arange(0.0, 900.0, 0.5)
    delta, r = geared(angle * np.sign(np.sin(0.04 * t)), 0.5), np.zeros(len(t))
    for k in range(len(t) - 1):
        r[k + 1] = r[k] + 0.5 * (0.06 * delta[k] - r[k]) / 15.0
    psi = np.cumsum(0.5 * r) % 360.0
    table = np.column_stack([t, np.full(len(t), 8.0) + 0.01 * np.sin(t), r, psi, factor * delta])
    heads = f"time,u_mps,yaw_rate_dps,heading_deg,{name}"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.9f")
    return path


def begun(folder: Path, *surveys: Inspection) -> tuple[str, Starter]:
    made = starter(surveys, folder / "p.toml", None, Given(length=95.0))
    return made.files[folder / "p.toml"], made


def rudders(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith("delta")]


def test_a_quiet_passage_is_read_as_the_other_log(tmp_path: Path) -> None:
    quiet, other = log(tmp_path / "a.csv", 1.4), log(tmp_path / "b.csv", 2.4)
    text, _ = begun(tmp_path, inspect_log(quiet), inspect_log(other))
    assert all('unit = "deg"' in line for line in rudders(text))
    assert "deg as in b.csv" in text


def test_a_quiet_passage_alone_is_read_by_how_she_turns(tmp_path: Path) -> None:
    text, _ = begun(tmp_path, inspect_log(log(tmp_path / "a.csv", 1.4)))
    assert all('unit = "deg"' in line for line in rudders(text))
    assert "a radian only" in text


def test_radians_stay_radians_with_what_they_may_be_else(tmp_path: Path) -> None:
    survey = inspect_log(log(tmp_path / "a.csv", 20.0, np.deg2rad(1.0)))
    text, _ = begun(tmp_path, survey)
    assert all('unit = "rad"' in line for line in rudders(text))
    assert "CAREFUL: no unit is stated" in text
    assert "can only be rad" not in text


def test_a_share_of_full_is_no_angle(tmp_path: Path) -> None:
    """What an autopilot orders its steering servo: it was read as up to 50 deg."""
    survey = inspect_log(log(tmp_path / "a.csv", 20.0, 1.0 / 25.0))
    share = replace(
        survey.channels["rudder"], description="share of the full deflection that servo 1 orders"
    )
    survey = replace(survey, channels={**survey.channels, "rudder": share})
    text, made = begun(tmp_path, survey)
    assert all('unit = "?"' in line for line in rudders(text))
    assert "gain = the degrees at full" in made.to_fill[0]


def rewritten(path: Path, rows: list[str]) -> Path:
    """The same log with other rows below its header."""
    head = path.read_text(encoding="utf-8").splitlines()[0]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return path


def ran(path: Path) -> Trial:
    pipeline = pipeline_file.load(path)
    return align_trials(pipeline, silent)[0]


def test_a_rudder_in_percent_needs_its_degrees_at_full_and_then_runs(tmp_path: Path) -> None:
    """Of 25 deg at full; no rudder was recognised, and `%` contradicted the pipeline's `deg`."""
    survey = inspect_log(log(tmp_path / "a.csv", 20.0, 4.0, "rudder [%]"))
    text, made = begun(tmp_path, survey)
    assert all('unit = "?"' in line for line in rudders(text))
    assert "the degrees at full / 100" in made.to_fill[0]
    for path, words in made.files.items():
        told = words.replace('"rudder", unit = "?"', '"rudder", unit = "deg", gain = 0.25')
        path.write_text(told, encoding="utf-8")
    assert np.rad2deg(np.abs(ran(tmp_path / "p.toml").signals["delta"]).max()) == pytest.approx(
        20.0
    )
    (tmp_path / "p.toml").write_text(text.replace('"?"', '"deg"'), encoding="utf-8")
    with pytest.raises(TrialidError, match="the log states '%'"):
        ran(tmp_path / "p.toml")


@pytest.mark.parametrize(
    ("factor", "amidships", "why"),
    [
        (0.5, 40.0, "30 to 50 are of one side alone, though she turns to both"),
        (20.0, 1500.0, "1100 to 1900 look like pulse widths [us], about 1500 amidships"),
        (1.0, 40.0, "20 to 60 are of one side alone, though she turns to both"),
        (100.0, 0.0, "-2000 to 2000 are no degrees, which end at 90, and no share of full"),
    ],
)
def test_a_rudder_on_a_scale_of_its_own_needs_its_zero_and_then_runs(
    tmp_path: Path, factor: float, amidships: float, why: str
) -> None:
    """Of a real boat 1077 to 1907 `can only be deg`, and 10 to 70 ended in `rudder_backlash`."""
    path = log(tmp_path / "a.csv", 20.0, factor)
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    table[:, -1] += amidships
    rewritten(path, [",".join(f"{x:.9g}" for x in row) for row in table])
    text, made = begun(tmp_path, inspect_log(path))
    assert all('unit = "?"' in line for line in rudders(text))
    assert why in made.to_fill[0]
    mended = f'unit = "deg", gain = {1 / factor}, offset = {-amidships / factor}'
    for place, words in made.files.items():
        place.write_text(words.replace('unit = "?"', mended), encoding="utf-8")
    delta = np.rad2deg(ran(tmp_path / "p.toml").signals["delta"])
    assert [delta.min(), delta.max()] == pytest.approx([-20.0, 20.0])


@pytest.mark.parametrize("manoeuvre", ["circle", "berth"])
def test_a_rudder_of_one_side_that_she_obeys_is_in_degrees(tmp_path: Path, manoeuvre: str) -> None:
    """In a turn she goes to one side, and at a berth nothing turns her but noise."""
    path = log(tmp_path / "a.csv", 20.0)
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    if manoeuvre == "circle":
        table[:, -1], table[:, 2] = np.abs(table[:, -1]) + 0.5, np.abs(table[:, 2])
    else:
        table[:, -1] = 5.0 + 0.01 * table[:, -1]
    table[:, 3] = np.cumsum(0.5 * table[:, 2]) % 360.0
    rewritten(path, [",".join(f"{x:.9g}" for x in row) for row in table])
    text, _ = begun(tmp_path, inspect_log(path))
    assert all('unit = "deg"' in line for line in rudders(text))


def test_a_rudder_counted_from_0_to_360_is_to_either_side(tmp_path: Path) -> None:
    """It was read as an order, which jumps, and nine tenths of it were beyond 90 deg."""
    path = log(tmp_path / "a.csv", 20.0, name="rudder_deg")
    rows = [line.rsplit(",", 1) for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    survey = inspect_log(rewritten(path, [f"{a},{float(b) % 360.0:.9f}" for a, b in rows]))
    rudder = survey.channels["rudder_deg"]
    assert (rudder.low, rudder.high) == (pytest.approx(-20.0), pytest.approx(20.0))
    text, made = begun(tmp_path, survey)
    assert 'channel = "rudder_deg", unit = "deg", positive = "starboard"' in text
    assert rudders(text)[0].startswith("delta ")
    for one, words in made.files.items():
        one.write_text(words, encoding="utf-8")
    trial = ran(tmp_path / "p.toml")
    assert np.rad2deg(
        [trial.signals["delta"].min(), trial.signals["delta"].max()]
    ) == pytest.approx([-20.0, 20.0])
    assert "delta: counted from 0 to 360, negative above 180" in trial.remarks


def test_a_side_beside_the_number_is_read(tmp_path: Path) -> None:
    """As a bridge prints it; the column was left out as text, or was of a southern latitude."""
    path = log(tmp_path / "a.csv", 20.0)
    rows = [line.rsplit(",", 1) for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    sided = [f"{a},{abs(float(b)):.1f} {'PS'[float(b) >= 0.0]}" for a, b in rows]
    survey = inspect_log(rewritten(path, sided))
    assert survey.channels["rudder"].low == pytest.approx(-20.0)
    text, _ = begun(tmp_path, survey)
    assert 'channel = "rudder", unit = "deg", positive = "starboard"' in text
    survey = inspect_log(rewritten(path, [f"{a},{abs(float(b)):.1f} S" for a, b in rows]))
    assert survey.channels["rudder"].high == pytest.approx(20.0)
    assert survey.channels["rudder"].low == pytest.approx(0.0)


def test_stamps_cut_to_the_second_hide_no_relation(tmp_path: Path) -> None:
    """At 2 Hz; the heading was left to the user, as the rate seemed not to go by it."""
    path = log(tmp_path / "a.csv", 20.0, name="rudder_deg")
    rows = [line.split(",", 1) for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    survey = inspect_log(rewritten(path, [f"{int(float(a))},{b}" for a, b in rows]))
    text, _ = begun(tmp_path, survey)
    assert '\npsi   = { channel = "heading_deg"' in text


def test_a_rudder_logged_as_it_changes_is_told_from_none(tmp_path: Path) -> None:
    """Nobody fills it up unasked: whether it holds its value between only the user knows."""
    path = log(tmp_path / "a.csv", 5.0, name="rudder_deg")
    rows = [line.rsplit(",", 1) for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    kept = zip(rows, [("", ""), *rows], strict=False)
    sparse = [f"{a},{b if b != before[1] else ''}" for (a, b), before in kept]
    with pytest.raises(LogError, match=r"'rudder_deg' has a value in 1\d% of its rows"):
        begun(tmp_path, inspect_log(rewritten(path, sparse)))
    with pytest.raises(LogError, match="'rudder_deg' does not move"):
        begun(tmp_path, inspect_log(rewritten(path, [f"{a},0.0" for a, _ in rows])))


@pytest.mark.parametrize(("length", "doubted"), [(95.0, False), (31.0, True), (29.0, False)])
def test_a_speed_that_few_ships_have_is_doubted(tmp_path: Path, length: float, doubted: bool):
    """8 m/s of 95 m is a Froude number of 0.26, of 31 m 0.46; a boat may plane."""
    survey = inspect_log(log(tmp_path / "a.csv", 10.0))
    made = starter([survey], tmp_path / "p.toml", None, Given(length=length))
    said = "8.01 m/s of 31 m is a Froude number of 0.46, a fast craft's; as knots it would be 0.24"
    assert (said in made.files[tmp_path / "p.toml"]) is doubted
    assert ("Froude" in made.files[tmp_path / "p.toml"]) is doubted
