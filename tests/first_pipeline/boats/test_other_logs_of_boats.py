"""What a log in which a boat goes straight on does not show, another log of hers does."""

from pathlib import Path

import numpy as np
import pytest
from made_boat import T, begun, late, pushes, sailed, table

from trialid import pipeline_file
from trialid.inspection import inspect_log
from trialid.inspection.drives import drives_among
from trialid.workflow.first_pipeline import Starter

TURNS, STRAIGHT = ("turns.csv", 2, False), ("straight.csv", 3, True)


def logs(
    folder: Path,
    names: tuple[str, str],
    *which: tuple[str, int, bool],
    unit: str = "[%]",
    exchanged: bool = False,
    sway: float | None = None,
) -> list[Path]:
    """Drives under these names, heading, rate without a unit in degrees, speed, perhaps sway.

    Her port drive is the second where they are `exchanged`; `sway` is metres ahead of midships
    where her track touches her circle.
    """
    paths = []
    for name, seed, straight in which:
        acts = late(pushes(seed), 0.4)
        if straight:
            acts[:, 1] = acts[:, 0]
        seen = sailed(acts)
        rng = np.random.default_rng(seed)
        drives = (100.0 * acts)[:, ::-1] if exchanged else 100.0 * acts
        told = drives + 0.2 * rng.standard_normal(drives.shape)
        columns = {f"{n} {unit}".strip(): y for n, y in zip(names, told.T, strict=True)}
        columns["yaw_rate"] = np.rad2deg(seen["r"]) + 0.4 * rng.standard_normal(len(T))
        heading = np.rad2deg(seen["psi"]) + 0.2 * rng.standard_normal(len(T))
        columns["heading"] = (heading + 355.0) % 360.0
        columns["stw [m/s]"] = seen["u"]
        if sway is not None:
            columns["v [m/s]"] = -sway * seen["r"] + 0.02 * rng.standard_normal(len(T))
        paths.append(table(folder / name, columns))
    return paths


def signals_of(made: Starter, log: str) -> dict[str, tuple[str, str | None]]:
    [trial] = [one for one in made.trials if one.path.name == log]
    return {s.quantity: (s.source.name, s.unit) for s in trial.signals}


@pytest.mark.parametrize("exchanged", [False, True])
def test_numbered_drives_stand_where_a_turn_shows_them(tmp_path: Path, exchanged: bool) -> None:
    alone = begun(tmp_path, *logs(tmp_path, ("motor1", "motor2"), STRAIGHT, exchanged=exchanged))
    assert any("which is to port" in one for one in alone.to_fill)
    both = logs(tmp_path, ("motor1", "motor2"), TURNS, STRAIGHT, exchanged=exchanged)
    made = begun(tmp_path, *both)
    assert made.to_fill == ()
    port = "motor2" if exchanged else "motor1"
    for log in ("turns.csv", "straight.csv"):
        assert signals_of(made, log)["thruster_port"] == (port, "%")
    assert "side as in turns.csv, of the same name" in made.files[tmp_path / "p.toml"]


def test_a_rate_of_a_log_straight_on_has_the_unit_of_one_that_turns(tmp_path: Path) -> None:
    """By its size it was in rad/s: noise of half a degree, and r L / U of 0.7."""
    paths = logs(tmp_path, ("motor_left", "motor_right"), TURNS, STRAIGHT)
    made = begun(tmp_path, *paths)
    assert {signals_of(made, p.name)["r"] for p in paths} == {("yaw_rate", "deg/s")}
    assert {signals_of(made, p.name)["psi"][0] for p in paths} == {"heading"}


def test_a_heading_that_no_turn_shows_is_left_out(tmp_path: Path) -> None:
    paths = logs(tmp_path, ("motor_left", "motor_right"), STRAIGHT)
    assert "psi" not in signals_of(begun(tmp_path, *paths), "straight.csv")


def test_a_sway_that_is_logged_is_simulated(tmp_path: Path) -> None:
    paths = logs(tmp_path, ("motor_left", "motor_right"), TURNS, STRAIGHT, sway=0.4)
    text = begun(tmp_path, *paths).files[tmp_path / "p.toml"]
    assert text.count("as in turns.csv, of the same name") == 3  # rate, heading, sway
    model = pipeline_file.load(tmp_path / "p.toml")
    assert model.model.states == ("u", "v", "r")
    assert "sway_drag_vav" in model.model.effects
    assert {"Yv", "Yvav", "Nv", "Xvr"} <= {*model.identify.free}
    assert model.identify.outputs == ("u", "v", "r")


def test_a_sway_that_goes_inwards_somewhere_is_asked_for(tmp_path: Path) -> None:
    """As one positive to port does."""
    names = ("motor_left", "motor_right")
    paths = logs(tmp_path, names, TURNS, STRAIGHT, sway=0.4)
    paths += logs(tmp_path, names, ("other.csv", 4, False), sway=-0.4)
    made = begun(tmp_path, *paths)
    assert "v" not in signals_of(made, "straight.csv")
    assert pipeline_file.load(tmp_path / "p.toml").model.states == ("u", "r")


def test_a_question_is_asked_once(tmp_path: Path) -> None:
    """A shaft's letter and a side are a drive without a unit, too: nothing tells what it is."""
    paths = logs(tmp_path, ("n_left", "n_right"), TURNS, STRAIGHT, unit="")
    asked = begun(tmp_path, *paths).to_fill
    assert len(asked) == 2
    assert asked[0].startswith("turns.csv and 1 more: thruster_port, ")


def test_a_letter_alone_is_no_drive(tmp_path: Path) -> None:
    """`N` is metres to the north as often."""
    path = table(tmp_path / "a.csv", {"N": np.sin(T), "n1": np.cos(T), "n2": np.sin(T + 1.0)})
    assert drives_among(inspect_log(path)) == ["n1", "n2"]
