"""Revolutions in the logs: read where every trial has them and they are not always the same."""

import re
from pathlib import Path

import numpy as np
import pytest
from test_sway_recorded import T, turned

from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import starter

LEFT = "# left to you: n"
Column = tuple[str, float]
"""The head of a column of revolutions and their value; a wave of 1 % is on them."""


def begun(folder: Path, *logs: tuple[Column, ...], wave: float = 0.01) -> str:
    """The pipeline's text; a log each for these columns beside rudder, rate of turn and speed."""
    for k, shafts in enumerate(logs):
        delta, r, _ = turned(k).T
        own = [value * (1.0 + wave * np.sin(0.1 * T)) for _, value in shafts]
        heads = ["t", "rudder_deg", "rate of turn [deg/s]", "stw [m/s]", *(h for h, _ in shafts)]
        table = np.column_stack([T, delta, r, np.full(len(T), 6.0), *own])
        np.savetxt(folder / f"{k}.csv", table, "%.6g", ",", header=",".join(heads), comments="")
    surveys = [inspect_log(folder / f"{k}.csv") for k in range(len(logs))]
    made = starter(surveys, folder / "p.toml", None, Given(length=100.0), 6.0)
    return made.files[folder / "p.toml"]


def read(text: str) -> list[str]:
    """Names of shafts among the signals, of all trials."""
    return re.findall(r"(?m)^(n|n_p|n_s) +=", text)


RPM = "shaft speed [rpm]"


@pytest.mark.parametrize("wave", [0.0, 0.01])
def test_trials_at_different_revolutions_are_read(tmp_path: Path, wave: float) -> None:
    """Each stands still by itself, and yet the two tell what the screw does."""
    text = begun(tmp_path, ((RPM, 60.0),), ((RPM, 80.0),), wave=wave)
    assert read(text) == ["n", "n"]
    assert "by its name, the run seeks what the screw does" in text
    assert LEFT not in text


def test_revolutions_that_change_within_a_trial_are_read(tmp_path: Path) -> None:
    assert read(begun(tmp_path, ((RPM, 60.0),), wave=0.1)) == ["n"]


def test_revolutions_that_a_governor_holds_are_left_to_the_user(tmp_path: Path) -> None:
    text = begun(tmp_path, ((RPM, 60.0),), ((RPM, 60.0),))
    assert not read(text)
    assert text.count(LEFT) == 2


def test_units_are_held_against_each_other(tmp_path: Path) -> None:
    """One hertz is 60 rpm."""
    assert not read(begun(tmp_path, ((RPM, 60.0),), (("shaft speed [rps]", 1.0),)))


def test_revolutions_that_a_trial_has_not_are_left_to_the_user(tmp_path: Path) -> None:
    text = begun(tmp_path, ((RPM, 60.0),), (), wave=0.1)
    assert not read(text)
    assert text.count(LEFT) == 1


def test_revolutions_without_a_unit_are_left_to_the_user(tmp_path: Path) -> None:
    text = begun(tmp_path, (("shaft speed", 60.0),), (("shaft speed", 80.0),), wave=0.1)
    assert not read(text)
    assert text.count(LEFT) == 2


def test_of_two_screws_both_are_read(tmp_path: Path) -> None:
    both = (("rpm_port [rpm]", 60.0), ("rpm_stbd [rpm]", 62.0))
    slower = (("rpm_port [rpm]", 40.0), ("rpm_stbd [rpm]", 41.0))
    assert read(begun(tmp_path, both, slower)) == ["n_p", "n_s"] * 2
    alone = (("rpm_port [rpm]", 60.0),)
    assert not read(begun(tmp_path, both, alone))


DEPTH = "water depth [m]"
READ_DEPTH = re.compile(r"(?m)^h +=")


@pytest.mark.parametrize("wave", [0.0, 0.01])
def test_a_depth_that_differs_between_trials_is_read(tmp_path: Path, wave: float) -> None:
    """Of an outsider's barge in 4.2 and in 200 m one trial contradicted the others."""
    text = begun(tmp_path, ((DEPTH, 200.0),), ((DEPTH, 4.2),), wave=wave)
    assert len(READ_DEPTH.findall(text)) == 2
    assert "by its name, the run seeks what shallow water does" in text


@pytest.mark.parametrize(
    ("head", "depths"), [(DEPTH, (4.2, 4.2)), ("depth below keel [m]", (200.0, 4.2))]
)
def test_a_depth_that_is_one_or_of_the_keel_is_left_to_the_user(
    tmp_path: Path, head: str, depths: tuple[float, float]
) -> None:
    text = begun(tmp_path, *(((head, depth),) for depth in depths), wave=0.0)
    assert not READ_DEPTH.findall(text)
    assert text.count("# left to you: h; of the water, not below the keel") == 2
