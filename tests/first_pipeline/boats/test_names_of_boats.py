"""What builders of unmanned boats call their channels."""

from pathlib import Path

import numpy as np
import pytest
from made_boat import T, begun, late, pushes, sailed, table

from trialid import pipeline_file
from trialid.errors import LogError
from trialid.inspection import inspect_log
from trialid.inspection.drives import drives_among, drives_of


def logged(path: Path, names: dict[str, str], rate: float = 1.0) -> Path:
    """A log of a boat under these names for `left`, `right`, `r`, `psi` and `speed`."""
    p = late(pushes(2), 0.4)
    seen = sailed(p)
    columns = {"left": 100.0 * p[:, 0], "right": 100.0 * p[:, 1], "r": seen["r"] * rate}
    columns |= {"psi": np.rad2deg(seen["psi"]) % 360.0, "speed": seen["u"] / 0.514444}
    return table(path, {name: columns[of] for of, name in names.items()})


GERMAN = {"left": "Motor links [%]", "right": "Motor rechts [%]", "r": "Drehrate [rad/s]"}
GERMAN |= {"psi": "Kurs [°]", "speed": "Fahrt [kn]"}
ROBOT = {"left": "left_motor_pct", "right": "right_motor_pct", "r": "gyro_z_rps"}
ROBOT |= {"psi": "heading_deg", "speed": "gps_speed_kn"}


def test_names_in_german(tmp_path: Path) -> None:
    text = begun(tmp_path, logged(tmp_path / "a.csv", GERMAN)).files[tmp_path / "p.toml"]
    assert 'channel = "Motor links", unit = "%"' in text
    assert 'channel = "Fahrt", unit = "kn"' in text
    assert 'channel = "Kurs", unit = "°"' in text  # it goes through north, and its unit is a sign


@pytest.mark.parametrize(("scale", "unit"), [(1.0, "rad/s"), (0.5 / np.pi, "rps")])
def test_a_heading_tells_radians_from_turns(tmp_path: Path, scale: float, unit: str) -> None:
    made = begun(tmp_path, logged(tmp_path / "a.csv", ROBOT, scale))
    text = made.files[tmp_path / "p.toml"]
    assert f'channel = "gyro_z_rps", unit = "{unit}"' in text
    assert 'channel = "gps_speed_kn", unit = "kn"' in text
    assert not made.to_fill


def test_without_a_heading_they_are_asked_for(tmp_path: Path) -> None:
    names = {of: name for of, name in ROBOT.items() if of != "psi"}
    made = begun(tmp_path, logged(tmp_path / "a.csv", names))
    assert 'channel = "gyro_z_rps", unit = "?"' in made.files[tmp_path / "p.toml"]
    assert any(": r, " in one for one in made.to_fill)


def test_pulses_without_a_name_are_told_of(tmp_path: Path) -> None:
    """Of a log with `RCOU_C1` and `RCOU_C3` no rudder was found, and no word of thrusters."""
    pulses, seen = 1500.0 + 400.0 * pushes(2), sailed(pushes(2))
    columns = {"RCOU_C1": pulses[:, 0], "RCOU_C3": pulses[:, 1], "Press": 1013.0 + np.sin(T)}
    columns |= {"ATT_Yaw": np.rad2deg(seen["psi"]) % 360.0, "speed_kn": seen["u"] / 0.514444}
    with pytest.raises(LogError, match="RCOU_C1, RCOU_C3 may be pulse widths") as caught:
        begun(tmp_path, table(tmp_path / "a.csv", columns))
    assert "call them thruster_port and thruster_starboard" in str(caught.value)


def test_a_steering_command_is_no_thruster(tmp_path: Path) -> None:
    columns = {"throttle_pct": pushes(1)[:, 0], "steer_cmd_pct": pushes(1)[:, 1]}
    survey = inspect_log(table(tmp_path / "a.csv", columns | {"yaw_rate_dps": np.sin(T)}))
    assert drives_among(survey) == ["throttle_pct"]
    assert drives_of(survey) == ()


def test_revolutions_that_drive_her_are_read_once(tmp_path: Path) -> None:
    """They change, and are a thruster's: no shaft beside it has them, too."""
    turns = 1000.0 * late(pushes(2), 0.4)
    seen = sailed(turns / 1000.0)
    columns = {"rpm_port [rpm]": turns[:, 0], "rpm_stbd [rpm]": turns[:, 1], "r [rad/s]": seen["r"]}
    text = begun(tmp_path, table(tmp_path / "a.csv", columns | {"stw [m/s]": seen["u"]}))
    signals = pipeline_file.load(tmp_path / "p.toml").trials[0].signals
    assert {"thruster_port", "thruster_starboard"} <= {*signals}, text
    assert not {"n_p", "n_s"} & {*signals}
