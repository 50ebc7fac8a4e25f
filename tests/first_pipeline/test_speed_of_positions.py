"""A log whose positions alone tell the speed, and a channel's unit by it."""

import re
from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid import pipeline_file
from trialid.alignment.track.position import RADIUS
from trialid.inspection import Inspection, inspect_log
from trialid.inspection.positions import approach_by_positions, usual_speed
from trialid.progress import silent
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import starter
from trialid.workflow.read_trials import align_trials

SPEED = 1.2
"""[m/s] Of a boat of 4 m."""
KNOT = 1852.0 / 3600.0


def log(
    path: Path,
    rng: np.random.Generator,
    *,
    scatter: float = 0.1,
    held: int = 1,
    speed: float = SPEED,
    falls: float = 0.0,
) -> Path:
    """Zig-zags of a boat at 5 Hz: her heading, rudder, speed in knots, and fixes that are held."""
    t = np.arange(0.0, 300.0, 0.2)
    delta, r = geared(20.0 * np.sign(np.sin(0.25 * t)), 0.2), np.zeros(len(t))
    for k in range(len(t) - 1):
        r[k + 1] = r[k] + 0.2 * (0.3 * delta[k] - r[k]) / 2.0
    psi = np.cumsum(0.2 * r)
    way = speed * (1.0 - falls * t / t[-1]) * 0.2 * np.exp(1j * np.deg2rad(psi))
    told = np.arange(len(t)) // held * held
    noise = scatter * (rng.standard_normal(len(t)) + 1j * rng.standard_normal(len(t)))
    fixes = (np.cumsum(way) + noise)[told] / RADIUS
    lat, lon = (
        59.9 + np.rad2deg(fixes.real),
        10.7 + np.rad2deg(fixes.imag / np.cos(np.deg2rad(59.9))),
    )
    knots = np.full(len(t), speed / KNOT) + 0.02 * rng.standard_normal(len(t))
    table = np.column_stack([t, lat, lon, knots, psi % 360.0, delta])
    heads = "time,lat,lon,speed,heading,rudder"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.9f")
    return path


def without(survey: Inspection, *names: str) -> Inspection:
    kept = {k: one for k, one in survey.channels.items() if one.name not in names}
    return survey.__class__(**{**vars(survey), "channels": kept})


def begun(folder: Path, survey: Inspection) -> str:
    made = starter([survey], folder / "p.toml", None, Given(length=4.0))
    return made.files[folder / "p.toml"]


@pytest.fixture(scope="module")
def survey(tmp_path_factory: pytest.TempPathFactory) -> Inspection:
    rng = np.random.default_rng(41)
    return inspect_log(log(tmp_path_factory.mktemp("boat") / "zz.csv", rng))


def test_positions_tell_the_unit_of_a_speed(tmp_path: Path, survey: Inspection) -> None:
    text = begun(tmp_path, survey)
    assert 'u     = { channel = "speed", unit = "kn" }' in text
    assert "but her positions or approach speed, here or elsewhere, leave kn" in text
    assert "a current adds to it" in text


def test_a_stated_speed_goes_before_her_positions(tmp_path: Path, survey: Inspection) -> None:
    """With a current they are sailed faster or slower than she goes through the water."""
    made = starter([survey], tmp_path / "p.toml", None, Given(length=4.0), SPEED / KNOT)
    assert 'channel = "speed", unit = "m/s"' in made.files[tmp_path / "p.toml"]


def test_a_circle_in_which_most_of_the_speed_is_lost_has_its_unit(tmp_path: Path) -> None:
    """A tanker's fast ways are too short there; with a constant speed for it nothing was fitted."""
    t = np.arange(0.0, 1200.0, 1.0)
    speed = 8.0 * (1.0 - 0.65 * (1.0 - np.exp(-np.maximum(t - 20.0, 0.0) / 25.0)))
    delta, r = np.where(t > 20.0, 30.0, 0.0), np.where(t > 20.0, 0.5, 0.0)
    psi = np.cumsum(r) + 0.3 * np.sin(0.05 * t)
    way = np.cumsum(speed * np.exp(1j * np.deg2rad(psi))) / RADIUS
    lat, lon = 57.0 + np.rad2deg(way.real), 10.0 + np.rad2deg(way.imag / np.cos(np.deg2rad(57.0)))
    table = np.column_stack([t, lat, lon, speed / KNOT, psi % 360.0, delta + 0.1 * np.sin(t)])
    heads = "time,lat,lon,SOG,heading,rudder"
    path = tmp_path / "turn.csv"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.9f")
    made = starter([inspect_log(path)], tmp_path / "p.toml", None, Given(length=300.0))
    text = made.files[tmp_path / "p.toml"]
    assert 'channel = "SOG", unit = "kn"' in text
    assert "\nspeed = " not in text


@pytest.mark.parametrize(("times", "told"), [(1.0, False), (0.8, False), (0.5, True), (2.0, True)])
def test_a_speed_that_her_positions_contradict_is_told(
    tmp_path: Path, times: float, told: bool
) -> None:
    """A log that states its unit, and counts every second fix twice or so."""
    path = log(tmp_path / "zz.csv", np.random.default_rng(44))
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    table[:, 3] *= times
    heads = "time,lat,lon,speed [kn],heading,rudder"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.9f")
    text = begun(tmp_path, inspect_log(path))
    assert ("her positions are sailed at" in text) is told
    assert (f"{1.0 / times:.1f}" in text.split("sailed at")[-1][:6]) is told


def test_positions_tell_a_speed_that_falls_where_no_channel_does(tmp_path: Path) -> None:
    """At 1.2 m/s to begin with, at 0.7 of it in the end: no one number is it."""
    path = log(tmp_path / "zz.csv", np.random.default_rng(46), scatter=0.02, falls=0.3)
    made = starter(
        [without(inspect_log(path), "speed")], tmp_path / "p.toml", None, Given(length=4.0)
    )
    for where, text in made.files.items():
        where.write_text(text, encoding="utf-8")
    text = made.files[tmp_path / "p.toml"]
    assert "\nover_ground = true" in text
    assert "\nspeed = " not in text
    assert 'outputs = ["psi"]' in text
    [trial] = align_trials(pipeline_file.load(tmp_path / "p.toml"), silent)
    true = SPEED * (1.0 - 0.3 * trial.t / 300.0)
    known = trial.valid["u"]
    assert known.mean() > 0.95
    assert trial.signals["u"][known] == pytest.approx(true[known], abs=0.15)
    assert np.std((trial.signals["u"] - true)[known]) < 0.05
    assert trial.signals["u"][~known] == pytest.approx(true[~known], abs=0.15)


def test_no_speed_is_made_beside_one_that_is_stated_logged_or_a_sway(tmp_path: Path) -> None:
    """A speed through the water beside one over the ground is two; `u` and a logged `v` clash."""
    rng = np.random.default_rng(48)
    here, there = (inspect_log(log(tmp_path / f"{n}.csv", rng, scatter=0.02)) for n in "ab")
    bare = without(here, "speed")
    for surveys, stated in (([bare], SPEED), ([bare, there], None)):
        made = starter(surveys, tmp_path / "p.toml", None, Given(length=4.0), stated)
        assert "over_ground" not in made.files[tmp_path / "p.toml"]
    table = np.loadtxt(here.path, delimiter=",", skiprows=1)
    table[:, 3] = -0.2 * np.gradient(table[:, 4])
    heads = "time,lat,lon,sway speed [m/s],heading,rudder"
    np.savetxt(tmp_path / "c.csv", table, delimiter=",", header=heads, comments="", fmt="%.9f")
    text = begun(tmp_path, inspect_log(tmp_path / "c.csv"))
    assert ("over_ground" in text) != ("\nv " in text)


def test_fixes_too_coarse_for_a_slope_tell_one_speed(tmp_path: Path) -> None:
    path = log(tmp_path / "zz.csv", np.random.default_rng(47), scatter=3.0)
    text = begun(tmp_path, without(inspect_log(path), "speed"))
    assert "over_ground" not in text
    [stated] = [line for line in text.splitlines() if line.startswith("speed = ")]
    assert float(stated.split()[2]) == pytest.approx(SPEED, rel=0.1)
    assert "over ground, by her positions" in stated


@pytest.mark.parametrize("held", [1, 5])
@pytest.mark.parametrize("scatter", [0.01, 0.5])
def test_neither_noise_nor_a_slow_receiver_changes_the_speed(
    tmp_path: Path, scatter: float, held: int
) -> None:
    """Fixes that scatter by half a metre are 0.5 m apart in each of the steps of 0.24 m."""
    rng = np.random.default_rng(42)
    found = inspect_log(log(tmp_path / "zz.csv", rng, scatter=scatter, held=held))
    assert usual_speed(found.channels.values()) == pytest.approx(SPEED, rel=0.03)


def test_a_boat_that_lies_still_has_no_speed(tmp_path: Path) -> None:
    rng = np.random.default_rng(43)
    still = inspect_log(log(tmp_path / "zz.csv", rng, speed=1e-4, scatter=0.5))
    assert usual_speed(still.channels.values()) is None


def test_fixes_that_never_came_have_no_speed(tmp_path: Path) -> None:
    """Of a receiver without a fix: zeros, but for the last digit of one of them."""
    path = log(tmp_path / "zz.csv", np.random.default_rng(45))
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    table[:, 1:3] = 0.0
    table[-1, 1:3] = 1e-9
    heads = "time,lat,lon,speed,heading,rudder"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.9f")
    assert usual_speed(inspect_log(path).channels.values()) is None


def test_one_of_two_is_no_position(survey: Inspection) -> None:
    assert usual_speed(survey.channels.values()) is not None
    assert usual_speed(without(survey, "lon").channels.values()) is None


@pytest.mark.parametrize(
    ("north", "east"), [("x0 [m]", "y0 [m]"), ("x_ned", "y_ned"), ("pos_n", "pos_e")]
)
def test_positions_in_a_plane_tell_it_too(
    tmp_path: Path, survey: Inspection, north: str, east: str
) -> None:
    table = np.loadtxt(survey.path, delimiter=",", skiprows=1)
    table[:, 1] = np.deg2rad(table[:, 1]) * RADIUS
    table[:, 2] = np.deg2rad(table[:, 2]) * RADIUS * np.cos(np.deg2rad(59.9))
    path = tmp_path / "plane.csv"
    heads = f"time,{north},{east},speed,heading,rudder"
    np.savetxt(path, table, delimiter=",", header=heads, comments="")
    told = usual_speed(inspect_log(path).channels.values())
    assert told == pytest.approx(SPEED, rel=0.03)
    heads = "time,acc_x,acc_y,speed,heading,rudder"
    np.savetxt(path, table, delimiter=",", header=heads, comments="")
    assert usual_speed(inspect_log(path).channels.values()) is None


def test_an_hour_in_which_nothing_was_logged_is_no_standing_still(tmp_path: Path) -> None:
    """A clock that was put on in the middle: of the hour there are no positions."""
    path = log(tmp_path / "a.csv", np.random.default_rng(12))
    head, *rows = path.read_text(encoding="utf-8").splitlines()
    late = [
        ",".join([f"{float(row.split(',')[0]) + 3600.0 * (k > 700):.1f}", row.partition(",")[2]])
        for k, row in enumerate(rows)
    ]
    path.write_text("\n".join([head, *late]) + "\n", encoding="utf-8")
    found = inspect_log(path).channels.values()
    assert usual_speed(found) == pytest.approx(SPEED, rel=0.1)
    assert approach_by_positions(found) == pytest.approx(SPEED, rel=0.1)


def turning(
    path: Path, reads: float, *, turn: float, current: complex = 0.6 - 0.8j, ground: bool = False
) -> Path:
    """A ship of 150 m put over at 100 s, in a current; her speed log reads by this factor.

    `ground`: over the ground, as her receiver has it.
    """
    t = np.arange(0.0, 700.0, 1.0)
    r = np.where((t > 100.0) & (np.cumsum(t > 100.0) * 0.7 < turn), 0.7, 0.0)
    psi, u = np.cumsum(r), 8.0 - 2.5 * np.clip((t - 100.0) / 150.0, 0.0, 1.0) * (turn > 0.0)
    v = -0.35 * u * np.deg2rad(r) / np.deg2rad(0.7) / 5.0
    rng = np.random.default_rng(5)
    velocity = (u + 1j * v) * np.exp(1j * np.deg2rad(psi)) + current
    u, way = np.abs(velocity) if ground else u, np.cumsum(velocity)
    fixes = (way + rng.standard_normal(len(t)) + 1j * rng.standard_normal(len(t))) / RADIUS
    table = np.column_stack(
        [t, 20.0 * np.sin(0.03 * t), psi % 360.0, reads * u / KNOT, np.rad2deg(fixes.real)]
    )
    table = np.column_stack([table, np.rad2deg(fixes.imag)])
    heads = f"time_s,rudder_deg,heading_deg,{'sog' if ground else 'stw'}_kn,lat,lon"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.9f")
    return path


@pytest.mark.parametrize("reads", [1.0, 1.0 / 1.944])
def test_a_speed_over_ground_and_one_in_another_unit_have_no_factor(
    tmp_path: Path, reads: float
) -> None:
    """A current is in it and in the ways alike; a unit that is wrong is told as that."""
    survey = inspect_log(turning(tmp_path / "a.csv", reads, turn=400.0, ground=reads == 1.0))
    text = starter([survey], tmp_path / "p.toml", None, Given(length=150.0)).files[
        tmp_path / "p.toml"
    ]
    assert "by her positions she goes" not in text
    assert ("positions are sailed at" in text) is (reads != 1.0)


@pytest.mark.parametrize(
    ("reads", "turn", "told"),
    [(1.12, 400.0, 1 / 1.12), (0.9, 220.0, 1 / 0.9), (1.0, 400.0, None), (1.12, 100.0, None)],
)
def test_a_speed_log_that_is_off_is_told_by_a_full_turn(
    tmp_path: Path, reads: float, turn: float, told: float | None
) -> None:
    """An outsider's read 12 % high beside positions, and no word was said: all gains were off.

    A current of 1 m/s is taken out; where she does not turn it is not, and nothing is said.
    """
    survey = inspect_log(turning(tmp_path / "turn.csv", reads, turn=turn))
    made = starter([survey], tmp_path / "p.toml", None, Given(length=150.0))
    found = re.search(r"by her positions she goes ([\d.]+)", made.files[tmp_path / "p.toml"])
    if told is None:
        assert found is None
    else:
        assert found is not None
        assert float(found[1]) == pytest.approx(told, rel=0.02)
