"""A table that holds a quantity several times: each column in its own unit, to its own side."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from trialid.inspection import inspect_log
from trialid.inspection.read_alike import unit_and_side
from trialid.ship.estimate.particulars_given import Given
from trialid.workflow.first_pipeline import starter

T = np.arange(0.0, 200.0, 0.5)
RUDDER = 20.0 * np.sin(T / 9.0)
RATE = 3.0 * np.sin(T / 9.0 - 0.6)
SPEED = 3.0 - 0.4 * np.sin(T / 9.0) ** 2
TURNED = 40.0 + np.cumsum(RATE) * 0.5


def table(path: Path, **columns: np.ndarray) -> Path:
    """The columns beside their time, noise on each."""
    rng = np.random.default_rng(4)
    noisy = [y + 0.003 * np.std(y) * rng.standard_normal(len(T)) for y in columns.values()]
    rows = np.column_stack([T, *noisy])
    np.savetxt(path, rows, "%.6f", ",", header=",".join(["time", *columns]), comments="")
    return path


@pytest.mark.parametrize(
    ("quantity", "known", "unit", "other", "told"),
    [
        ("delta", RUDDER, "deg", np.deg2rad(RUDDER), ("rad", False)),
        ("delta", RUDDER, "deg", -RUDDER, ("deg", True)),
        ("delta", np.deg2rad(RUDDER), "rad", -RUDDER, ("deg", True)),
        ("r", RATE, "deg/s", 60.0 * RATE, ("deg/min", False)),
        ("u", SPEED, "m/s", SPEED * 3600.0 / 1852.0, ("kn", False)),
        ("u", SPEED, "m/s", 3.6 * SPEED, ("km/h", False)),
        ("delta", RUDDER, "deg", 3.0 * RUDDER, (None, False)),
        ("delta", RUDDER, "deg", np.cos(T / 9.0), (None, None)),
        ("delta", RUDDER, "?", np.deg2rad(RUDDER), (None, False)),
    ],
)
def test_unit_and_side_are_those_of_the_same_motion(tmp_path, quantity, known, unit, other, told):
    survey = inspect_log(table(tmp_path / "a.csv", one=known, another=other))
    one, another = survey.channels["one"], survey.channels["another"]
    assert unit_and_side(another, one, unit, quantity) == told


def test_what_is_commented_out_is_read_as_it_moves(tmp_path: Path) -> None:
    columns = {
        "rudder": RUDDER,
        "delta": -np.deg2rad(RUDDER),
        "-rudder": -RUDDER,
        "heading": TURNED,
        "yaw_rate": RATE,
        "psi": np.deg2rad(TURNED),
        "stw_mps": SPEED,
    }
    survey = inspect_log(table(tmp_path / "a.csv", **columns))
    begun = starter([survey], tmp_path / "p.toml", None, Given(length=6.0), None)
    lines = begun.files[tmp_path / "p.toml"].splitlines()
    others = [line.removeprefix("# or ") for line in lines if line.startswith("# or ")]
    sources = [source for line in others for source in tomllib.loads(line).values()]
    read = {source["channel"]: source for source in sources}
    assert read["delta"] == {"channel": "delta", "unit": "rad", "positive": "port"}
    assert read["-rudder"] == {"channel": "-rudder", "unit": "deg", "positive": "port"}
    assert read["psi"] == {"channel": "psi", "unit": "rad"}
    assert not any("combine" in line for line in others)  # three that are read in three ways
