"""Of a boat whose water speed nobody logs, sway is simulated where receiver and compass tell it."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from made_boat import PERIOD, T, begun, pushes, table

from trialid import pipeline_file
from trialid.errors import LogError
from trialid.inspection import inspect_log
from trialid.progress import silent
from trialid.workflow.read_trials import align_trials

CURRENT = (0.25, -0.15)
PLACE = (59.9, 10.7)
"""Degrees north and east."""
RADIUS = 6_371_000.0
"""[m] Of a globe, good enough for a pond."""


def drifted(acts: np.ndarray) -> Mapping[str, np.ndarray]:
    """A boat that goes outwards in her turns: speeds, rate, heading, and where she is [m]."""
    u, v, r, psi = (np.zeros(len(T)) for _ in range(4))
    u[0] = 1.0
    left, right = (acts * np.abs(acts)).T
    for k in range(len(T) - 1):
        u[k + 1] = u[k] + PERIOD * (0.25 * (left[k] + right[k]) - 0.12 * u[k] * abs(u[k]))
        r[k + 1] = r[k] + PERIOD * (0.3 * (left[k] - right[k]) - 0.6 * r[k] + 0.1 * v[k])
        v[k + 1] = v[k] + PERIOD * (-0.5 * u[k] * r[k] - 0.8 * v[k])
        psi[k + 1] = psi[k] + PERIOD * r[k]
    north = u * np.cos(psi) - v * np.sin(psi) + CURRENT[0]
    east = u * np.sin(psi) + v * np.cos(psi) + CURRENT[1]
    x, y = (PERIOD * np.cumsum(one) for one in (north, east))
    return {"u": u, "v": v, "r": r, "psi": psi, "north": north, "east": east, "x": x, "y": y}


def logged(path: Path, seed: int, told: str) -> Path:
    """A log of drives, gyro and compass, and of the receiver what is `told`."""
    acts = pushes(seed)
    seen, rng = drifted(acts), np.random.default_rng(seed)
    noise = lambda size: size * rng.standard_normal(len(T))  # noqa: E731
    columns = {"motor_left_pct": 100.0 * acts[:, 0], "motor_right_pct": 100.0 * acts[:, 1]}
    columns["yaw_rate_dps"] = np.rad2deg(seen["r"]) + noise(0.3)
    columns["heading_deg"] = (np.rad2deg(seen["psi"]) + noise(0.3)) % 360.0
    if told == "course":
        north, east = seen["north"] + noise(0.02), seen["east"] + noise(0.02)
        columns["sog_mps"] = np.hypot(north, east)
        columns["cog_deg"] = np.rad2deg(np.arctan2(east, north)) % 360.0
    elif told == "globe":
        size = np.cos(np.deg2rad(PLACE[0]))
        columns["latitude"] = PLACE[0] + np.rad2deg((seen["x"] + noise(0.02)) / RADIUS)
        columns["longitude"] = PLACE[1] + np.rad2deg((seen["y"] + noise(0.02)) / RADIUS / size)
    elif told == "plane":
        columns |= {"x [m]": seen["y"] + noise(0.02), "y [m]": seen["x"] + noise(0.02)}
    rows = np.column_stack([T, *columns.values()])
    head = ",".join(("t [s]", *columns))
    np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.9g")
    return path


@pytest.mark.parametrize(("told", "shown"), [("course", {"sog", "cog"}), ("globe", {"lat", "lon"})])
def test_speeds_ahead_and_aside_are_made_of_what_the_receiver_tells(
    tmp_path: Path, told: str, shown: set[str]
) -> None:
    made = begun(tmp_path, *(logged(tmp_path / f"{i}.csv", i, told) for i in (2, 3)))
    assert {"sog", "cog", "lat", "lon", "u", "v"} & {
        one.quantity for one in made.trials[0].signals
    } == shown
    pipeline = pipeline_file.load(tmp_path / "p.toml")
    assert pipeline.model.states == pipeline.identify.outputs == ("u", "v", "r")
    assert "current" in pipeline.identify.nuisance
    for seed, trial in zip((2, 3), align_trials(pipeline, silent), strict=True):
        true = drifted(pushes(seed))
        t = trial.opening + trial.period * np.arange(trial.samples)
        at = {n: np.interp(t, T, x) for n, x in true.items()}
        ahead = CURRENT[0] * np.cos(at["psi"]) + CURRENT[1] * np.sin(at["psi"])
        aside = CURRENT[1] * np.cos(at["psi"]) - CURRENT[0] * np.sin(at["psi"])
        for name, over in (("u", ahead), ("v", aside)):
            off = (trial.signals[name] - at[name] - over)[trial.valid[name]]
            assert np.std(off) < 0.25 * np.std(at[name] + over), name
        assert any("u, v: her velocity over the ground by" in one for one in trial.remarks)


def test_the_axis_to_the_north_is_the_one_by_which_she_goes(tmp_path: Path) -> None:
    made = begun(tmp_path, logged(tmp_path / "ros.csv", 2, "plane"))
    by_name = {one.quantity: one.source.name for one in made.trials[0].signals}
    assert (by_name["x"], by_name["y"]) == ("y", "x")


def test_without_speed_or_position_nothing_is_begun(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="no speed is recognised"):
        begun(tmp_path, logged(tmp_path / "bare.csv", 2, ""))


def test_positions_that_tell_no_speed_begin_nothing(tmp_path: Path) -> None:
    """Fixes of three metres: their slopes are of longer than a turn."""
    path = logged(tmp_path / "coarse.csv", 2, "globe")
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    rng = np.random.default_rng(1)
    rows[:, -2:] += 3e-5 * rng.standard_normal((len(T), 2))
    head = path.read_text(encoding="utf-8").splitlines()[0]
    np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.9g")
    with pytest.raises(LogError, match="no speed is recognised"):
        begun(tmp_path, path)


def test_a_sway_that_does_not_show_is_not_simulated(tmp_path: Path) -> None:
    """Of a boat that goes where she heads it is noise of the receiver."""
    path = logged(tmp_path / "0.csv", 2, "course")
    seen = drifted(pushes(2))
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    rows[:, 6] = np.rad2deg(seen["psi"]) % 360.0
    head = path.read_text(encoding="utf-8").splitlines()[0]
    begun(tmp_path, table(path, dict(zip(head.split(",")[1:], rows[:, 1:].T, strict=True))))
    assert pipeline_file.load(tmp_path / "p.toml").model.states == ("u", "r")


def test_fixes_that_are_none_take_no_sway_away(tmp_path: Path) -> None:
    path = logged(tmp_path / "lost.csv", 2, "globe")
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    rows[300:305, -2:] = 0.0
    head = path.read_text(encoding="utf-8").splitlines()[0]
    np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.9g")
    begun(tmp_path, path)
    assert pipeline_file.load(tmp_path / "p.toml").model.states == ("u", "v", "r")


@pytest.mark.parametrize(("name", "read"), [("steering", False), ("steering_angle", True)])
def test_what_turns_her_beside_two_drives_is_not_lost(
    tmp_path: Path, name: str, read: bool
) -> None:
    """An angle is a rudder; a word alone is told beside two drives that differ."""
    path = logged(tmp_path / "a.csv", 2, "course")
    lines = path.read_text(encoding="utf-8").splitlines()
    turned = np.rad2deg(0.3 * np.gradient(drifted(pushes(2))["r"], PERIOD))
    with_it = [
        f"{lines[0]},{name}",
        *(f"{x},{y:.3f}" for x, y in zip(lines[1:], turned, strict=True)),
    ]
    path.write_text("\n".join(with_it), encoding="utf-8")
    [trial] = begun(tmp_path, path).trials
    assert ("delta" in {one.quantity.removesuffix("_order") for one in trial.signals}) is read
    beside = {one.source.name for one, _ in trial.beside}
    assert read or name in beside


@pytest.mark.parametrize(("name", "taken"), [("thruster_port", []), ("x7", ["x7"])])
def test_a_drive_is_no_rate_of_turn(tmp_path: Path, name: str, taken: list[str]) -> None:
    """In a turn by one step both go alike: `2 sources of yaw rate r`, one of them a thruster."""
    acts = np.full((len(T), 2), 0.6)
    acts[len(T) // 3 :] = 0.8, 0.4
    seen = drifted(acts)
    columns = {name: np.rad2deg(seen["r"]), "heading_deg": np.rad2deg(seen["psi"]) % 360.0}
    path = table(tmp_path / "step.csv", columns)
    assert [one.name for one in inspect_log(path).sources("r")] == taken
