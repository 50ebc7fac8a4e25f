"""An outboard, a jet or one pod: what pushes her steers her, and where it varies is no rudder."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from made_boat import PERIOD, T

from trialid import pipeline_file, read_ship
from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import Starter, starter
from trialid.workflow.first_pipeline.boats.boat_choice import choose
from trialid.workflow.first_pipeline.boats.one_drive import _as_angle
from trialid.workflow.first_pipeline.chosen import CONVENTION
from trialid.workflow.run import run

LENGTH, ARM = 6.0, 3.0
MASS, AHEAD, ASIDE = 2000.0, 1.05, 1.8
"""[kg], and with the water that moves along: over it ahead and aside."""
THRUST, DRAG = 3000.0, 60.0
SWAY, TURN = 450.0, 4000.0
"""Damping of sway by the speed [kg/m], of yaw at rest [kg m^2/s], whose inertia is half of that."""
GAIN = "k_pod_ahead"


JET = 'name = "jet"\nkind = "waterjet"\nat = [-3.0, 0.0]\ncommand = "share"'
SCREW = 'name = "screw"\nkind = "thruster"\nat = [-3.0, 0.0]\ncommand = "share"'


def sailed(seed: int, held: float | None) -> tuple[np.ndarray, ...]:
    """Throttle, angle to port of the push, heading and way of a boat of 6 m with an outboard.

    Her own mechanics: the push sits 3 m aft of the middle.
    """
    rng = np.random.default_rng(seed)
    steps = np.repeat(rng.uniform(0.4, 0.9, len(T) // 200 + 1), 200)[: len(T)]
    share = np.full(len(T), held) if held is not None else steps
    angle = np.repeat(np.deg2rad(rng.uniform(-12.0, 12.0, len(T) // 60 + 1)), 60)[: len(T)]
    for k in range(len(T) - 1):
        angle[k + 1] = angle[k] + PERIOD * np.clip((angle[k + 1] - angle[k]) / PERIOD, -0.4, 0.4)
    u, v, r, psi = (np.zeros(len(T)) for _ in range(4))
    u[0] = 4.0
    for k in range(len(T) - 1):
        push = THRUST * share[k] ** 2
        X, Y = push * np.cos(angle[k]), -push * np.sin(angle[k])
        X += ASIDE * MASS * v[k] * r[k] - DRAG * u[k] * abs(u[k])
        Y -= AHEAD * MASS * u[k] * r[k]
        u[k + 1] = u[k] + PERIOD * X / (AHEAD * MASS)
        v[k + 1] = v[k] + PERIOD * (Y - SWAY * u[k] * v[k]) / (ASIDE * MASS)
        r[k + 1] = r[k] + PERIOD * 2.0 * (ARM * push * np.sin(angle[k]) / TURN - r[k])
        psi[k + 1] = psi[k] + PERIOD * r[k]
    way = PERIOD * np.cumsum((u + 1j * v) * np.exp(1j * psi))
    return share, angle, psi, r, way


def logged(path: Path, seed: int, *, held: float | None = None, side: float = 1.0) -> Path:
    """Its table: to starboard she turns by an angle that is positive, where `side` is 1."""
    share, angle, psi, r, way = sailed(seed, held)
    rng = np.random.default_rng(seed)
    noise = lambda size: size * rng.standard_normal(len(T))  # noqa: E731
    columns = {
        "t [s]": T,
        "outboard_angle_deg": side * np.rad2deg(angle),
        "throttle_pct": 100.0 * share,
        "heading_deg": (np.rad2deg(psi) + noise(0.2)) % 360.0,
        "yaw_rate_dps": np.rad2deg(r) + noise(0.2),
        "x [m]": way.real + noise(0.02),
        "y [m]": way.imag + noise(0.02),
    }
    rows = np.column_stack([*columns.values()])
    np.savetxt(path, rows, delimiter=",", header=",".join(columns), comments="", fmt="%.9g")
    return path


def begun(folder: Path, *logs: Path) -> Starter:
    """The first pipeline of logs, written."""
    given = Given(length=LENGTH)
    made = starter([inspect_log(one) for one in logs], folder / "p.toml", None, given)
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return made


@pytest.mark.study(turn="each")
def test_it_is_begun_as_what_it_is(tmp_path: Path) -> None:
    """Thrust over mass comes back, and half as much is left as to a rudder of the same records."""
    made = begun(tmp_path, *(logged(tmp_path / f"{k}.csv", k) for k in (1, 2, 3)))
    path = tmp_path / "p.toml"
    text = made.files[path]
    assert 'unit = "deg", positive = "port" }' in text
    assert "turns to starboard by it" in text
    assert "over_ground = true" in text
    assert "read as a rudder" not in text
    [one] = read_ship(tmp_path / "p_ship.toml").actuators
    assert (one.name, one.kind, one.command, one.y) == ("drive", "azimuth", "share", 0.0)
    assert one.x == pytest.approx(-0.5 * read_ship(tmp_path / "p_ship.toml").particulars["L"])
    done = run(pipeline_file.load(path))
    fit = done.findings.before.fit
    assert fit.converged
    ship = fit.model.ship
    mass = ship.mass["m"] * 0.5 * ship.particulars["rho"] * LENGTH**3
    assert fit.value(GAIN) / mass == pytest.approx(THRUST / MASS, rel=0.15)
    assert done.result.verdict.effect is None
    left = fit.eps_check_by_output["r"]
    for log in tmp_path.glob("*.csv"):
        text = log.read_text(encoding="utf-8").replace("outboard_angle_deg", "rudder_deg", 1)
        log.write_text(text, encoding="utf-8")
    begun(tmp_path, *sorted(tmp_path.glob("*.csv")))
    of_rudder = run(pipeline_file.load(path)).findings.before.fit
    assert left < 0.7 * of_rudder.eps_check_by_output["r"]


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_its_sense_is_by_the_turn(tmp_path: Path, side: float) -> None:
    """Clockwise from ahead it pushes her stern to starboard."""
    text = begun(tmp_path, logged(tmp_path / "a.csv", 4, side=side)).files[tmp_path / "p.toml"]
    [line] = [one for one in text.splitlines() if one.startswith("drive_angle")]
    assert ('positive = "port"' in line) == (side > 0.0)


@pytest.mark.parametrize("positive", ["starboard", "port"])
def test_a_sense_that_no_turn_shows_is_told_as_taken(tmp_path: Path, positive: str) -> None:
    """By the format alone: it was told as what she turns by."""
    survey = inspect_log(logged(tmp_path / "a.csv", 4))
    rudder = next(s for s in choose(survey, None).signals if s.quantity == "delta")
    unseen = dataclasses.replace(rudder, positive=positive, of_side=CONVENTION)
    angle = _as_angle(unseen, "azimuth")
    assert f"taken to turn her to {positive} where it is positive" in angle.why
    assert "as she turns" not in angle.why
    assert (angle.positive == "port") == (positive == "starboard")


def test_a_throttle_that_is_held_makes_a_rudder_of_it(tmp_path: Path) -> None:
    logs = [logged(tmp_path / f"{k}.csv", k, held=0.7) for k in (5, 6)]
    text = begun(tmp_path, *logs).files[tmp_path / "p.toml"]
    assert "\ndelta " in text
    assert "read as a rudder" in text


def test_one_that_is_held_at_another_in_the_next_log_varies(tmp_path: Path) -> None:
    logs = [logged(tmp_path / f"{k}.csv", k, held=share) for k, share in ((5, 0.8), (6, 0.5))]
    text = begun(tmp_path, *logs).files[tmp_path / "p.toml"]
    assert text.count("\ndrive ") + text.count("\ndrive_order ") == 2
    assert 'effects = ["azimuths", ' in text


def test_a_start_from_rest_and_a_lost_value_hold_nothing_up(tmp_path: Path) -> None:
    log = logged(tmp_path / "a.csv", 5, held=0.7)
    rows = np.loadtxt(log, delimiter=",", skiprows=1)
    rows[:10, 2] = rows[600, 2] = 0.0
    head = log.read_text(encoding="utf-8").partition("\n")[0]
    np.savetxt(log, rows, delimiter=",", header=head, comments="", fmt="%.9g")
    assert "\ndelta " in begun(tmp_path, log).files[tmp_path / "p.toml"]


@pytest.mark.parametrize(
    ("table", "told"),
    [
        (JET, True),
        ('name = "helm"\nkind = "rudder"\nat = [-3.0, 0.0]', False),
        ('name = "jet"\nkind = "waterjet"\nat = [3.0, 0.0]\ncommand = "share"', False),
        (f"{JET}\n[[actuator]]\n{SCREW}", False),
    ],
)
def test_her_own_file_names_it(tmp_path: Path, table: str, told: bool) -> None:
    """The angle of a jet counts as a rudder's does; from the bow it turns her the other way.

    Where another drives her too, nobody knows of which the throttle is.
    """
    begun(tmp_path, logged(tmp_path / "a.csv", 7))
    ship = (tmp_path / "p_ship.toml").read_text(encoding="utf-8").partition("[[actuator]]")[0]
    own = tmp_path / "own.toml"
    own.write_text(f"{ship}\n[[actuator]]\n{table}\n", encoding="utf-8")
    survey = inspect_log(tmp_path / "a.csv")
    text = starter([survey], tmp_path / "q.toml", own, Given()).files[tmp_path / "q.toml"]
    angles = [line for line in text.splitlines() if line.startswith("jet_angle")]
    assert bool(angles) == told
    assert ("read as a rudder" in text) != told
    assert not any("positive" in line for line in angles)
