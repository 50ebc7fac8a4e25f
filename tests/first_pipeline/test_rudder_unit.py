"""Rudders of small numbers and no unit: degrees of a quiet passage, radians, a share of full."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from geared_rudder import geared

from trialid.inspection import Inspection, inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import Starter, starter


def log(path: Path, angle: float, factor: float = 1.0) -> Path:
    """Zig-zags of a ship of 95 m at 8 m/s, rudder in degrees, or as many times `factor`."""
    t = np.arange(0.0, 900.0, 0.5)
    delta, r = geared(angle * np.sign(np.sin(0.04 * t)), 0.5), np.zeros(len(t))
    for k in range(len(t) - 1):
        r[k + 1] = r[k] + 0.5 * (0.06 * delta[k] - r[k]) / 15.0
    psi = np.cumsum(0.5 * r) % 360.0
    table = np.column_stack([t, np.full(len(t), 8.0) + 0.01 * np.sin(t), r, psi, factor * delta])
    heads = "time,u_mps,yaw_rate_dps,heading_deg,rudder"
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
