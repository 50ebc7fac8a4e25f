"""Velocities called u and v that go to the north and to the east: refused, and not begun with."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid import pipeline_file
from trialid.alignment.agreement.axes import check_axes
from trialid.errors import AlignmentError
from trialid.inspection import inspect_log
from trialid.progress import silent
from trialid.ship.estimate import Given
from trialid.trial import Trial
from trialid.workflow.first_pipeline import Starter, starter
from trialid.workflow.read_trials import align_trials

T = np.arange(0.0, 500.0, 0.5)
TURN = np.where(T > 80.0, 20.0, 0.0)
ZIGZAG = 10.0 * np.sign(np.sin(0.03 * T))


def sailed(orders: np.ndarray) -> dict[str, np.ndarray]:
    """Rudder, heading, yaw rate and velocities of a ship that loses a third of 6 m/s in a turn."""
    delta, r = geared(orders), np.zeros(len(T))
    for k in range(len(T) - 1):
        r[k + 1] = r[k] + 0.5 * (0.06 * delta[k] - r[k]) / 15.0
    psi = np.deg2rad(np.cumsum(0.5 * r))
    u, v = 6.0 - 2.0 * np.abs(r) / 1.2, -0.4 * r
    north, east = u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi)
    x, y = np.cumsum(0.5 * north), np.cumsum(0.5 * east)
    found = {"delta": delta, "r": r, "psi": psi, "u": u, "v": v, "north": north, "east": east}
    return found | {"x": x, "y": y}


def trial(orders: np.ndarray, u: str, v: str | None, heading: str = "psi") -> Trial:
    found = sailed(orders)
    signals = {"u": found[u], heading: found[heading]} | ({"v": found[v]} if v else {})
    if heading == "r":
        signals["r"] = np.deg2rad(signals["r"])
    valid = {name: np.ones(len(T), dtype=bool) for name in signals}
    return Trial("t", "fit", 0.5, signals, valid)


@pytest.mark.parametrize("heading", ["psi", "r"])
@pytest.mark.parametrize(
    ("orders", "u", "v", "told"),
    [
        (TURN, "north", None, True),
        (TURN, "u", None, False),
        (TURN, "north", "east", True),
        (TURN, "u", "v", False),
        (ZIGZAG, "north", "east", True),
        (ZIGZAG, "u", "v", False),
        (ZIGZAG, "north", None, False),  # which no zig-zag tells from a speed that is lost
    ],
)
def test_a_velocity_of_the_earth_goes_round_with_the_heading(orders, u, v, told, heading) -> None:
    found = list(check_axes(trial(orders, u, v, heading)))
    assert [one.kind for one in found] == ["axes"] * told
    assert all(one.severity == "error" for one in found)


def test_a_current_along_a_speed_over_ground_is_none() -> None:
    """Of half her speed."""
    made = trial(TURN, "u", None)
    over_ground = made.signals["u"] + 3.0 * np.cos(made.signals["psi"])
    assert not list(check_axes(replace(made, signals={**made.signals, "u": over_ground})))


@pytest.mark.parametrize("seed", range(20))
def test_a_boat_that_hardly_moves_and_turns_tells_nothing(seed: int) -> None:
    """Her course winds about by chance, and so does her heading."""
    made, rng = trial(TURN, "u", "v"), np.random.default_rng(seed)
    drifting = np.cumsum(0.02 * rng.standard_normal((3, len(T))), axis=1)
    signals = {"u": 0.1 * drifting[0], "v": 0.1 * drifting[1], "psi": drifting[2] * 5.0}
    assert not list(check_axes(replace(made, signals=signals)))


def log(path: Path, orders: np.ndarray, u: str, v: str) -> Path:
    found = sailed(orders)
    table = [T, found["x"], found["y"], np.rad2deg(found["psi"]), found[u], found[v], found["r"]]
    heads = "t,x [m],y [m],heading [deg],u [m/s],v [m/s],r [deg/s],rudder_deg"
    rows = np.column_stack([*table, found["delta"]])
    np.savetxt(path, rows, delimiter=",", header=heads, comments="", fmt="%.6g")
    return path


def begun(folder: Path, u: str, v: str) -> Starter:
    logs = [log(folder / f"{n}.csv", o, u, v) for n, o in (("zz", ZIGZAG), ("turn", TURN))]
    made = starter([inspect_log(one) for one in logs], folder / "p.toml", None, Given(length=100.0))
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return made


def test_a_pipeline_begins_without_them_and_with_the_speed_of_the_positions(tmp_path: Path) -> None:
    """The turn tells it, and of the zig-zag beside it too; from 6 m/s to 4 she loses."""
    text = begun(tmp_path, "north", "east").files[tmp_path / "p.toml"]
    assert text.count("# left to you: u; it goes round with the heading") == 2
    assert text.count("# left to you: v; it goes round with the heading") == 2
    assert text.count("\nover_ground = true") == 2
    assert pipeline_file.load(tmp_path / "p.toml").identify.outputs == ("r",)
    trials = align_trials(pipeline_file.load(tmp_path / "p.toml"), silent)
    for one, orders in zip(trials, (ZIGZAG, TURN), strict=True):
        known = one.valid["u"]
        assert known.mean() > 0.9
        assert one.signals["u"][known] == pytest.approx(sailed(orders)["u"][known], abs=0.4)


def test_those_of_the_ship_are_read(tmp_path: Path) -> None:
    text = begun(tmp_path, "u", "v").files[tmp_path / "p.toml"]
    assert "goes round" not in text
    assert text.count('u     = { channel = "u", unit = "m/s" }') == 2


def test_a_run_refuses_them_in_one_line(tmp_path: Path) -> None:
    begun(tmp_path, "u", "v")
    log(tmp_path / "turn.csv", TURN, "north", "east")
    with pytest.raises(AlignmentError, match="'turn': u and v: round with the heading"):
        align_trials(pipeline_file.load(tmp_path / "p.toml"), silent)
