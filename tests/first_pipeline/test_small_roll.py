"""A roll that hardly moves is left to the user; one that does, in any trial, is an output."""

from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid import pipeline_file
from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import Starter, starter

T = np.arange(0.0, 400.0, 0.5)


def log(path: Path, roll: float, unit: str = "deg") -> Path:
    """A zig-zag in which the ship heels by so much to either side [deg]."""
    delta, r = geared(10.0 * np.sign(np.sin(0.05 * T))), np.zeros(len(T))
    for k in range(len(T) - 1):
        r[k + 1] = r[k] + 0.5 * (0.05 * delta[k] - r[k]) / 15.0
    phi = roll * r / np.abs(r).max() / (1.0 if unit == "deg" else 180.0 / np.pi)
    table = np.column_stack([T, delta, r, phi])
    heads = f"t,rudder_deg,rate of turn [deg/s],roll [{unit}]"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.6g")
    return path


def begun(folder: Path, *rolls: float, unit: str = "deg") -> Starter:
    logs = [log(folder / f"z{i}.csv", roll, unit) for i, roll in enumerate(rolls)]
    made = starter(
        [inspect_log(p) for p in logs], folder / "p.toml", None, Given(length=100.0), 6.0
    )
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return made


@pytest.mark.parametrize("unit", ["deg", "rad"])
def test_she_hardly_rolls(tmp_path: Path, unit: str) -> None:
    made = begun(tmp_path, 0.2, 0.4, unit=unit)
    found = pipeline_file.load(tmp_path / "p.toml")
    assert found.identify.outputs == ("r",)
    assert "GM" not in found.identify.free
    text = made.files[tmp_path / "p.toml"]
    lines = [t for t in text.splitlines() if t.startswith(("# left to you: phi", "# phi"))]
    told, line = lines[:2]
    assert "she rolls by 0.78 deg at most" in told
    assert line == f'# phi = {{ channel = "roll", unit = "{unit}" }}'


@pytest.mark.parametrize("rolls", [(0.7,), (0.2, 0.7), (0.7, 0.2)])
def test_she_rolls_in_one_of_them(tmp_path: Path, rolls: tuple[float, ...]) -> None:
    begun(tmp_path, *rolls)
    found = pipeline_file.load(tmp_path / "p.toml")
    assert found.identify.outputs == ("r", "phi")
    assert "GM" in found.identify.free
