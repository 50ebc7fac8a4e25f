"""Letters of a ship's motion as capitals, together and alone."""

import numpy as np
import pytest

from trialid.inspection import inspect_log

T = np.arange(0.0, 300.0, 0.5)
R = 0.004 * np.sin(0.05 * T)
COLUMNS = {
    "Time": T,
    "X": 7.0 * T,
    "Y": 20.0 * np.sin(0.05 * T),
    "Psi": np.cumsum(0.5 * R),
    "U": 7.0 - 40.0 * np.abs(R),
    "V": -60.0 * R,
    "R": R,
    "Delta": 0.17 * np.sin(0.05 * T + 0.4),
}


def known(folder, columns):
    path = folder / "log.csv"
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, delimiter=",", header=",".join(columns), comments="", fmt="%.9g")
    channels = inspect_log(path).channels
    return {name: one.guess.quantity for name, one in channels.items() if one.guess}


def without(*names):
    return {name: y for name, y in COLUMNS.items() if name not in names}


def test_together_they_are_the_ships_motion(tmp_path):
    found = {"Psi": "psi", "U": "u", "V": "v", "R": "r", "Delta": "delta"}
    assert known(tmp_path, COLUMNS) == found


@pytest.mark.parametrize("missing", [("Delta",), ("Psi", "R")])
def test_without_a_rudder_or_a_turn_they_mean_nothing(tmp_path, missing):
    assert not {"U", "V", "Delta"} & known(tmp_path, without(*missing)).keys()


@pytest.mark.parametrize("columns", [without("V"), COLUMNS | {"V": COLUMNS["U"]}])
def test_a_speed_without_a_small_one_across_may_be_any(tmp_path, columns):
    assert not {"U", "V"} & known(tmp_path, columns).keys()
