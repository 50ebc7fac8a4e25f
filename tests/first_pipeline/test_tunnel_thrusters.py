"""A bow thruster beside a rudder, wind beside two drives: read, or told, never left out."""

import re
from pathlib import Path

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.ship.particulars import read_ship
from trialid.workflow.first_pipeline import starter

PERIOD = 0.2
T = np.arange(0.0, 400.0, PERIOD)
RUDDER = (0, 15, -15, 0, 0, 10, -10, 15, -15, 0)
THRUST = (0, 0, 0, 60, -60, 40, -80, 0, 80, -40)


def held(steps: tuple[int, ...]) -> np.ndarray:
    """Steps of 40 s each."""
    return np.repeat(np.array(steps, float), len(T) // len(steps))


def log(
    path: Path, column: str, *, sense: float = 1.0, at: float = 1.0, moves: float = 1.0
) -> Path:
    """A boat's table: she turns by both, each by itself; `at` -1 is a thruster at her stern."""
    thrust, rudder, r = moves * held(THRUST), held(RUDDER), np.zeros(len(T))
    for k in range(len(T) - 1):
        turning = 0.02 * rudder[k] + at * 4e-5 * thrust[k] * abs(thrust[k]) - 0.15 * r[k]
        r[k + 1] = r[k] + PERIOD * turning
    rng = np.random.default_rng(3)
    rows = {
        "time_s": T,
        "rudder_deg": rudder,
        column: sense * thrust,
        "yaw_rate_deg_s": r + 0.02 * rng.standard_normal(len(T)),
        "stw_mps": 2.5 + 0.02 * rng.standard_normal(len(T)),
    }
    np.savetxt(
        path,
        np.column_stack([*rows.values()]),
        delimiter=",",
        header=",".join(rows),
        comments="",
        fmt="%.5f",
    )
    return path


def texts(folder: Path, *logs: Path, ship: Path | None = None) -> tuple[str, str]:
    """Pipeline and ship file begun for logs."""
    pipeline = folder / "p.toml"
    given = Given(length=None if ship else 30.0)
    made = starter([inspect_log(one) for one in logs], pipeline, ship, given)
    text = re.sub(r" += \{", " = {", made.files[pipeline])
    return text, made.files.get(folder / "p_ship.toml", "")


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("column", ["bow_thr_pct", "bow_thruster [%]", "Bugstrahlruder [%]"])
def test_a_bow_thruster_is_an_input_and_the_turn_tells_its_side(tmp_path, column, sense) -> None:
    text, ship = texts(tmp_path, log(tmp_path / "a.csv", column, sense=sense))
    assert f'bow_thruster = {{ channel = "{column.split(" [")[0]}", unit = "%" }}' in text
    assert "# bow_thruster" not in text.replace("# bow_thruster: ", "")
    (tmp_path / "ship.toml").write_text(ship, encoding="utf-8")
    (tunnel,) = read_ship(tmp_path / "ship.toml").actuators
    assert (tunnel.kind, tunnel.x, tunnel.command) == ("tunnel", 12.0, "share")
    assert tunnel.direction == pytest.approx(sense * np.pi / 2.0)


def test_a_stern_thruster_turns_her_the_other_way(tmp_path) -> None:
    _, ship = texts(tmp_path, log(tmp_path / "a.csv", "stern_thr_pct", at=-1.0))
    assert "at = [-12.0, 0.0]" in ship
    assert "direction = 90.0" in ship


@pytest.mark.parametrize(
    ("column", "moves", "why"),
    [
        ("bow_thr_pct", 0.02, "the motion does not show"),  # too weak to turn her
        ("bow_thruster", 1.0, "not every log has it with its unit"),
        ("side_thruster_pct", 1.0, "nothing reads it"),
    ],
)
def test_one_that_is_not_read_is_told_with_what_to_do(tmp_path, column, moves, why) -> None:
    text, ship = texts(tmp_path, log(tmp_path / "a.csv", column, moves=moves))
    (line,) = [one for one in text.splitlines() if why in one]
    assert line.startswith("# left to you: ")
    assert "`trialid guide actuators`" in line
    assert "[[actuator]]" not in ship


def test_a_file_of_hers_gives_the_name_and_the_place(tmp_path) -> None:
    made = log(tmp_path / "a.csv", "bow_thr_pct")
    _, ship = texts(tmp_path, made)
    own = tmp_path / "own.toml"
    own.write_text(ship.replace('"bow_thruster"', '"tunnel_1"'), encoding="utf-8")
    assert "\ntunnel_1 " in texts(tmp_path, made, ship=own)[0]
    own.write_text(ship[: ship.index("[[actuator]]")], encoding="utf-8")
    assert "her file has no tunnel at that end" in texts(tmp_path, made, ship=own)[0]


def test_wind_of_a_boat_with_two_drives_is_read(tmp_path) -> None:
    drives = held(THRUST) / 100.0
    r, u = np.zeros(len(T)), np.full(len(T), 1.0)
    for k in range(len(T) - 1):
        r[k + 1] = r[k] + PERIOD * (0.2 * drives[k] - 0.4 * r[k])
    rows = {
        "time_s": T,
        "thr_port_pct": 50.0 + 40.0 * drives,
        "thr_stbd_pct": 50.0 - 40.0 * drives,
        "yaw_rate_deg_s": np.rad2deg(r),
        "stw_mps": u + 0.1 * np.sin(0.1 * T),
        "apparent_wind_speed_mps": 6.0 + np.sin(0.05 * T),
        "apparent_wind_angle_deg": 40.0 * np.sin(0.02 * T),
    }
    path = tmp_path / "a.csv"
    values = np.column_stack([*rows.values()])
    np.savetxt(path, values, delimiter=",", header=",".join(rows), comments="", fmt="%.5f")
    text, _ = texts(tmp_path, path)
    assert 'channel = "thr_port_pct"' in text
    assert 'V_aw = { channel = "apparent_wind_speed_mps", unit = "m/s" }' in text
    assert 'gamma_aw = { channel = "apparent_wind_angle_deg", unit = "deg" }' in text


def test_a_thruster_alone_is_no_rudder(tmp_path) -> None:
    made = log(tmp_path / "a.csv", "bow_thr_pct")
    text = made.read_text(encoding="utf-8").replace("rudder_deg", "other")
    made.write_text(text, encoding="utf-8")
    with pytest.raises(LogError, match="she seems to steer by thrusters"):
        texts(tmp_path, made)
