"""A rudder that is at its place at once: the first pipeline reads it as its order."""

import re
from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid.inspection import inspect_log
from trialid.pipeline_file import load
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import starter

T = np.arange(0.0, 600.0, 0.5)
ORDERS = 10.0 * np.sign(np.sin(0.05 * T) + 0.3 * np.sin(0.013 * T))


def begun(folder: Path, length: float, *rudders: np.ndarray, back: float = 0.0) -> str:
    """The pipeline of a log for each of these rudders [deg], of a ship at 6 m/s; it loads.

    Her clock is set back by so much [s] after two minutes.
    """
    stamps = np.where(T < 120.0, T, T - back)
    logs = []
    for i, delta in enumerate(rudders):
        r = np.zeros(len(T))
        for k in range(len(T) - 1):
            r[k + 1] = r[k] + 0.5 * (0.05 * delta[k] - r[k]) / 15.0
        logs.append(folder / f"log{i}.csv")
        heads = "t,rudder_deg,rate of turn [deg/s],stw [m/s]"
        table = np.column_stack([stamps, delta, r, np.full(len(T), 6.0)])
        np.savetxt(logs[-1], table, delimiter=",", header=heads, comments="", fmt="%.6g")
    given = Given(length=length)
    made = starter([inspect_log(one) for one in logs], folder / "p.toml", None, given, 6.0)
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    load(folder / "p.toml")
    return (folder / "p.toml").read_text(encoding="utf-8")


def test_a_rudder_that_jumps_is_read_as_its_order(tmp_path: Path) -> None:
    text = begun(tmp_path, 100.0, ORDERS, ORDERS)
    assert (
        "it jumps by up to 20 deg within 0.5 s, which no ship's gear does (a model's servo may:"
        in text
    )
    assert len(re.findall(r'^delta_order = \{ channel = "rudder_deg"', text, re.MULTILINE)) == 2
    assert not re.search("^delta = ", text, re.MULTILINE)
    assert "values = { T_delta = 0.83 }" in text  # of a ship of 100 m at 6 m/s; 1 from 120 m on


@pytest.mark.parametrize(
    ("length", "rudders"),
    [
        (100.0, (geared(ORDERS), geared(ORDERS))),
        (100.0, (ORDERS, geared(ORDERS), geared(ORDERS))),  # one log of three
        (30.0, (ORDERS, ORDERS)),  # 40 deg/s: a boat has such a gear
    ],
)
def test_a_rudder_is_a_rudder(tmp_path: Path, length: float, rudders: tuple) -> None:
    text = begun(tmp_path, length, *rudders)
    assert "delta = {" in text
    assert "delta_order" not in text


def test_samples_of_two_times_between_one_another_are_no_jumps(tmp_path: Path) -> None:
    """A rudder went from 10 deg to -10 within a sample, where its clock had been set back."""
    text = begun(tmp_path, 100.0, geared(ORDERS), back=100.0)
    assert "delta = {" in text
    assert "delta_order" not in text


@pytest.mark.parametrize("zero", [0.0, 15.0])
def test_an_order_beside_the_rudder_is_left_to_the_user(tmp_path: Path, zero: float) -> None:
    """With it the run seeks the gear; on a scale of its own it is asked for its zero."""
    begun(tmp_path, 100.0, geared(ORDERS))
    table = np.loadtxt(tmp_path / "log0.csv", delimiter=",", skiprows=1)
    heads = "t,rudder_deg,rate of turn [deg/s],stw [m/s],rudder_command"
    both = np.column_stack([table, ORDERS + zero])
    np.savetxt(tmp_path / "log.csv", both, delimiter=",", header=heads, comments="", fmt="%.6g")
    survey = inspect_log(tmp_path / "log.csv")
    made = starter([survey], tmp_path / "q.toml", None, Given(length=100.0), 6.0)
    text = made.files[tmp_path / "q.toml"]
    assert made.to_fill == ()
    unit = "?" if zero else "deg"
    line = f'# delta_order = {{ channel = "rudder_command", unit = "{unit}", positive = "starboard"'
    assert line in text
    assert "the run seeks what the steering gear does" in text
    assert ("FILL IN" in text) == (zero > 0.0)
