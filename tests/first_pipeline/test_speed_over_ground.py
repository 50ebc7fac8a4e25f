"""A bridge table without units: the stated speed settles what the log leaves open."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid.errors import LogError
from trialid.inspection import inspect_log
from trialid.inspection.channel_names import unit_in_name
from trialid.inspection.relations import unit_of_speed
from trialid.inspection.sketch import EMPTY
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import Starter, starter

T = np.arange(0.0, 900.0, 1.0)
ZIGZAG = 10.0 * np.sign(np.sin(0.03 * T) + 0.3 * np.sin(0.008 * T))
TURN = np.where(T > 60.0, 20.0, 0.0)
APPROACH = 8.0
"""[m/s]"""


def log(path: Path, orders: np.ndarray, left: float, to_unit: float) -> Path:
    """Heading, rudder, shaft and speed over ground of a ship that keeps so much of it in turns."""
    delta, r = geared(orders, 1.0), np.zeros(len(T))
    for k in range(len(T) - 1):
        r[k + 1] = r[k] + (0.03 * delta[k] - r[k]) / 20.0
    turned = np.minimum(1.0, np.cumsum(np.abs(r)) / 200.0)
    speed = APPROACH * (1.0 - (1.0 - left) * turned) * to_unit
    table = np.column_stack([T, np.cumsum(r) % 360.0, delta, speed, np.full(len(T), 80.0) + r])
    heads = "Time,HDG,Rudder,SOG,RPM"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.5g")
    return path


def begun(folder: Path, to_unit: float, speed: float | None, left: float = 0.3) -> Starter:
    logs = [log(folder / "z.csv", ZIGZAG, 0.9, to_unit), log(folder / "t.csv", TURN, left, to_unit)]
    surveys = [inspect_log(one) for one in logs]
    return starter(surveys, folder / "p.toml", None, Given(length=150.0), speed)


@pytest.mark.parametrize(("unit", "to_unit"), [("m/s", 1.0), ("kn", 3600.0 / 1852.0)])
def test_a_stated_speed_tells_the_unit_of_the_one_over_ground(
    tmp_path: Path, unit: str, to_unit: float
) -> None:
    """By how fast she comes, although in the turn she keeps a third of it."""
    made = begun(tmp_path, to_unit, APPROACH)
    text = made.files[tmp_path / "p.toml"]
    assert text.count(f'channel = "SOG", unit = "{unit}"') == 2
    assert "CAREFUL: a speed over ground" in text
    assert f"but her positions or approach speed, here or elsewhere, leave {unit}" in text
    assert "speed = 8" not in text


def test_a_circle_that_begins_slow_has_the_unit_of_the_zigzag_beside_it(tmp_path: Path) -> None:
    """Its log begins when much of the speed is lost, and alone leaves the unit open."""
    out = np.where(T[-1] - 20.0 < T, 0.0, TURN)  # amidships at the end: she steers
    paths = [log(tmp_path / "t.csv", out, 0.3, 1.0), log(tmp_path / "z.csv", ZIGZAG, 0.9, 1.0)]
    head, *rows = paths[0].read_text(encoding="utf-8").splitlines()
    paths[0].write_text("\n".join([head, *rows[250:]]) + "\n", encoding="utf-8")
    for logs, count in ((paths[:1], 0), (paths, 2)):
        given = (tmp_path / "p.toml", None, Given(length=150.0), APPROACH)
        text = starter([inspect_log(one) for one in logs], *given).files[tmp_path / "p.toml"]
        assert text.count('channel = "SOG", unit = "m/s"') == count


def test_drift_and_current_are_read_out_of_a_speed_over_ground(tmp_path: Path) -> None:
    """With the heading as a signal, which also tells the rate's offset."""
    for speed, over in (("SOG", True), ("STW", False)):
        path = log(tmp_path / f"{speed}.csv", ZIGZAG, 0.9, 1.0)
        head, *rows = path.read_text(encoding="utf-8").splitlines()
        turn = np.gradient(np.unwrap(np.deg2rad([float(row.split(",")[1]) for row in rows])))
        rows = [f"{row},{np.rad2deg(r):.5g}" for row, r in zip(rows, turn, strict=True)]
        head = head.replace("SOG", speed) + ",ROT[deg/s]"
        path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
        given = (tmp_path / "p.toml", None, Given(length=150.0), APPROACH)
        text = starter([inspect_log(path)], *given).files[tmp_path / "p.toml"]
        assert ('"drift_in_speed_record"]' in text) is over
        assert '\npsi   = { channel = "HDG"' in text
        assert ("it tells the current in that" in text) is over
        assert (', "current"]  # of each trial' in text) is over
        assert ("tells the offset of the rate" in text) is not over
        assert 'outputs = ["r"]' in text


def test_a_heading_without_a_unit_that_passes_north_is_read_as_one_that_does_not(
    tmp_path: Path,
) -> None:
    """Only its numbers tell that it is in degrees; its jumps by 360 are no turns."""
    path = log(tmp_path / "t.csv", TURN, 0.9, 1.0)
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    rate = np.gradient(np.unwrap(table[:, 1], period=360.0))
    for first in (0.0, 5.0):
        heading = (first - table[:, 1]) % 360.0
        assert np.abs(np.diff(heading)).max() > 350.0
        turned = np.column_stack([T, heading, -table[:, 2], table[:, 3], -rate])
        heads = "Time,HDG,Rudder,SOG,ROT[deg/s]"
        np.savetxt(path, turned, delimiter=",", header=heads, comments="", fmt="%.5g")
        given = (tmp_path / "p.toml", None, Given(length=150.0), APPROACH)
        text = starter([inspect_log(path)], *given).files[tmp_path / "p.toml"]
        assert '\npsi   = { channel = "HDG", unit = "deg" }' in text


def test_a_stated_speed_beside_one_in_the_log_leaves_the_log_s(tmp_path: Path) -> None:
    """In a turn she keeps a third of what was stated, and only the log says so."""
    path = log(tmp_path / "t.csv", TURN, 0.3, 1.0)
    for head in ("SOG [m/s]", "speed [m/s]"):
        told = path.read_text(encoding="utf-8").replace("SOG", head)
        (tmp_path / "s.csv").write_text(told, encoding="utf-8")
        given = (tmp_path / "p.toml", None, Given(length=150.0), APPROACH)
        text = starter([inspect_log(tmp_path / "s.csv")], *given).files[tmp_path / "p.toml"]
        assert f'channel = "{head.split()[0]}", unit = "m/s"' in text
        assert "speed = 8" not in text


def test_a_stated_speed_that_fits_no_unit_stays_the_speed(tmp_path: Path) -> None:
    text = begun(tmp_path, 1.0, 3.0).files[tmp_path / "p.toml"]
    assert "SOG" not in text
    assert text.count("speed = 3") == 2


def test_rpm_is_a_unit_where_a_channel_is_called_so(tmp_path: Path) -> None:
    assert unit_in_name("RPM") == "rpm"
    assert unit_in_name("deg") is None  # of which angle?
    text = begun(tmp_path, 1.0, APPROACH).files[tmp_path / "p.toml"]
    assert '# n = { channel = "RPM", unit = "rpm" }' in text


def test_a_channel_of_which_nothing_was_kept_has_no_unit_by_a_speed(tmp_path: Path) -> None:
    survey = inspect_log(log(tmp_path / "z.csv", ZIGZAG, 0.9, 1.0))
    speed = next(one for one in survey.channels.values() if one.name.endswith("SOG"))
    assert unit_of_speed(speed, APPROACH) == "m/s"
    assert unit_of_speed(dataclasses.replace(speed, sketch=EMPTY), APPROACH) is None


def test_a_turning_circle_that_comes_first_is_not_how_fast_she_comes(tmp_path: Path) -> None:
    """By the middle of that log she came at a third of it, and IMO asked too little."""
    speeds = []
    for names in (("a_turn", "b_zigzag"), ("b_turn", "a_zigzag")):
        logs = [
            log(tmp_path / f"{name}.csv", TURN if "turn" in name else ZIGZAG, 0.3, 1.0)
            for name in names
        ]
        for path in logs:
            told = path.read_text(encoding="utf-8").replace("SOG", "STW[m/s]")
            path.write_text(told, encoding="utf-8")
        surveys = [inspect_log(one) for one in sorted(logs)]
        made = starter(surveys, tmp_path / "p.toml", None, Given(length=150.0), None)
        text = made.files[tmp_path / "p_ship.toml"]
        [line] = [one for one in text.splitlines() if one.startswith("U0 = ")]
        speeds.append(float(line.split()[2]))
    assert speeds[0] == pytest.approx(speeds[1])
    assert speeds[0] == pytest.approx(APPROACH, rel=0.05)


@pytest.mark.parametrize(
    ("head", "value", "knots"), [("STW [m/s]", 8.0, 15.55), ("STW kn", 12, 12)]
)
def test_a_speed_that_is_one_number_throughout_is_offered_as_the_stated_one(
    tmp_path: Path, head: str, value: float, knots: float
) -> None:
    """A log that never moves measures nothing; without it the approach speed is asked for."""
    path = log(tmp_path / "z.csv", ZIGZAG, 0.9, 1.0)
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    table[:, 3] = value
    heads = f"Time,HDG,Rudder [deg],{head},RPM"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.5g")
    with pytest.raises(LogError, match=rf"throughout.*add --speed {knots:.4g} \(knots\)"):
        starter([inspect_log(path)], tmp_path / "p.toml", None, Given(length=150.0))
    table[:, 3] = 0.0
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.5g")
    with pytest.raises(LogError, match="add --speed KNOTS"):
        starter([inspect_log(path)], tmp_path / "p.toml", None, Given(length=150.0))


@pytest.mark.parametrize(
    ("head", "told"), [("through_kn", True), ("fwd [m/s]", True), ("loading_t", False)]
)
def test_what_moves_in_a_unit_of_speeds_and_is_not_read_is_told(
    tmp_path: Path, head: str, told: bool
) -> None:
    """So that nobody states one speed for all who has recorded it."""
    path = log(tmp_path / "z.csv", ZIGZAG, 0.9, 1.0)
    lines = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join([f"Time,HDG,Rudder [deg],{head},RPM", *lines[1:]]), encoding="utf-8")
    with pytest.raises(LogError, match="add --speed KNOTS") as caught:
        starter([inspect_log(path)], tmp_path / "p.toml", None, Given(length=150.0))
    name = head.partition(" ")[0]
    assert (f"in a unit of speeds: '{name}': where one is her" in str(caught.value)) is told
