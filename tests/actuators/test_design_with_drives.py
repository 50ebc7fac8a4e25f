"""Designed tests of a boat with two thrusters and of a ship with two rudders, and their limits."""

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest

from trialid.errors import DesignError, TrialidError
from trialid.pipeline_file import load
from trialid.pipeline_file.design_file import load_design
from trialid.workflow.design.design_folder import write
from trialid.workflow.design.design_run import Plan, plan

BOAT = """
name = "boat"
source = "made up"
system = "dimensional"
rudder_positive = "starboard"
particulars = { L = 2.0, nabla = 0.078, rho = 1025.0, g = 9.81, U0 = 1.0 }
mass = { m = 80.0, I_zz = 18.0, Xudot = -5.5, Nrdot = -30.0 }
coefficients = { k_ahead = 0.011, k_astern = 0.011, Xuu = -100.0, Nr0 = -40.0 }
"""
LEFT = '[[actuator]]\nname = "left"\nkind = "thruster"\nat = [-0.9, -0.4]\n'
RIGHT = LEFT.replace("left", "right").replace("-0.4", "0.4")
FULL = "limit = 900.0\n"
HEAD = """
name = "drives"
ship = "boat.toml"
noise = { u = 0.02, r = 0.2 }
[model]
states = ["u", "r"]
effects = ["thrusters", "surge_resistance", "still_water_yaw"]
[identify]
free = ["k_ahead", "Xuu", "Nr0"]
outputs = ["u", "r"]
nuisance = []
[at_sea]
period = 0.2
approach = 10.0
"""
STEPS = """
[[test]]
name = "steps"
kind = "differential_steps"
duration = 70.0
set = { ahead = [0.5], differences = [0.4, -0.2, 0.0] }
"""
SPIN = """
[[test]]
name = "spins"
kind = "spins"
duration = 70.0
set = { turning = [0.6, -0.6] }
"""


def planned(folder: Path, *tests: str, ship: str = BOAT + LEFT + FULL + RIGHT + FULL) -> Plan:
    (folder / "boat.toml").write_text(ship, encoding="utf-8")
    path = folder / "design.toml"
    path.write_text(HEAD + "".join(tests), encoding="utf-8")
    return plan(load_design(path))


def test_steps_of_the_difference_are_shares_of_what_each_may_get(tmp_path: Path) -> None:
    """More to port turns her to starboard, at about the rate that balance gives."""
    [passage] = planned(tmp_path, STEPS).rated[0].outcome.passages
    signals, t = passage.trial.signals, passage.trial.t
    full = 900.0 * 2.0 * np.pi / 60.0
    at = np.searchsorted(t, [5.0, 20.0, 40.0, 60.0])
    np.testing.assert_allclose(signals["left_order"][at] / full, [0.5, 0.9, 0.3, 0.5])
    np.testing.assert_allclose(signals["right_order"][at] / full, [0.5, 0.1, 0.7, 0.5])
    assert passage.trial.signals["left"] == pytest.approx(signals["left_order"])
    moment = 0.4 * 0.011 * full**2 * (0.9**2 - 0.1**2)
    assert signals["r"][np.searchsorted(t, 29.0)] == pytest.approx(moment / 40.0, rel=0.02)
    assert signals["r"][np.searchsorted(t, 49.0)] < 0.0


def test_a_spin_goes_nowhere(tmp_path: Path) -> None:
    """She runs out in the approach, and turns by what both give together."""
    [passage] = planned(tmp_path, SPIN).rated[0].outcome.passages
    signals, t = passage.trial.signals, passage.trial.t
    half = np.searchsorted(t, 39.0)
    full = 900.0 * 2.0 * np.pi / 60.0
    assert signals["left"][half] == pytest.approx(0.6 * full)
    assert signals["right"][half] == pytest.approx(-0.6 * full)
    moment = 2.0 * 0.4 * 0.011 * (0.6 * full) ** 2
    assert signals["r"][half] == pytest.approx(moment / 40.0, rel=0.02)
    assert signals["r"][-1] == pytest.approx(-moment / 40.0, rel=0.02)
    assert abs(signals["u"][-1] / signals["u"][0]) < 0.1


def test_what_is_beyond_a_limit_may_not_be_run(tmp_path: Path) -> None:
    [rated] = planned(tmp_path, STEPS.replace("0.4,", "0.7,")).rated
    assert rated.outcome.rating is None
    [excess] = rated.outcome.excesses
    assert (excess.limit, excess.t) == ("left", pytest.approx(10.0, abs=0.3))
    assert "1.08e+03 rpm of left are ordered, 900 are allowed" in excess.sentence


def test_a_drive_that_follows_slowly_is_sailed_and_said(tmp_path: Path) -> None:
    slow = BOAT + LEFT + FULL + "rate = 30.0\n" + RIGHT + FULL
    [rated] = planned(tmp_path, STEPS, ship=slow).rated
    [passage] = rated.outcome.passages
    runs = np.abs(np.diff(passage.trial.signals["left"])) / 0.2
    assert runs.max() == pytest.approx(30.0 * 2.0 * np.pi / 60.0)
    assert "the left does not reach" in rated.remarks[0]


@pytest.mark.parametrize(
    ("ship", "says"),
    [
        (BOAT + LEFT + RIGHT + FULL, "actuator 'left' states no limit in the ship file"),
        (BOAT + LEFT + FULL, "the ship has not one thruster to port and one to starboard"),
    ],
)
def test_what_is_lacking_is_one_line(tmp_path: Path, ship: str, says: str) -> None:
    with pytest.raises(DesignError, match=says) as caught:
        planned(tmp_path, STEPS, ship=ship)
    assert "\n" not in str(caught.value)


def test_open_numbers_are_chosen_within_the_limits(tmp_path: Path) -> None:
    free = STEPS.replace("differences = [0.4, -0.2, 0.0] ", "").replace("[0.5],", "[0.5]")
    done = planned(
        tmp_path,
        free + "open = { differences = [-0.9, 0.9] }\nsteps = 4\n",
        "[search]\ncandidates = 60\nseed = 1\n",
    )
    [rated], [fixed] = done.rated, planned(tmp_path, STEPS).rated
    assert rated.found is not None
    assert rated.outcome.excesses == ()
    [passage] = rated.outcome.passages
    for side in ("left_order", "right_order"):
        assert np.abs(passage.trial.signals[side]).max() <= 900.0 * 2.0 * np.pi / 60.0
    errors = [
        max(one.outcome.rating.of(n).error for n in ("k_ahead", "Xuu", "Nr0"))
        for one in (rated, fixed)
    ]
    assert errors[0] < errors[1]


def test_the_papers_say_what_each_drive_gets(tmp_path: Path) -> None:
    done, folder = planned(tmp_path, STEPS), tmp_path / "out"
    data = write(done, folder)
    rows = [*csv.reader(io.StringIO((folder / "steps.csv").read_text(encoding="utf-8")))]
    assert rows[0] == ["t[s]", "left_order[rad/s]", "right_order[rad/s]", "order"]
    assert [row[-1] for row in rows[1:]] == [
        "left 450 rpm, right 450 rpm",
        "left 810 rpm, right 90 rpm",
        "left 270 rpm, right 630 rpm",
        "left 450 rpm, right 450 rpm",
    ]
    page = (folder / "bridge.html").read_text(encoding="utf-8")
    assert "order of left [rpm]" in page
    assert "stop the drives" in page
    assert "amidships" not in page
    assert data["tests"][0]["expected"][0]["orders"][1]["words"] == "left 810 rpm, right 90 rpm"
    assert json.loads((folder / "design.json").read_text(encoding="utf-8")) == data
    text = (folder / "steps.toml").read_text(encoding="utf-8")
    assert 'left = { channel = "NAME IT", unit = "rpm" }' in text
    assert "delta" not in text
    with pytest.raises(TrialidError, match="log-of-steps"):
        load(folder / "steps.toml")


RUDDERS = """
[[actuator]]
name = "port"
kind = "rudder"
at = [-0.9, -0.4]
limit = 20.0

[[actuator]]
name = "stbd"
kind = "rudder"
at = [-0.9, 0.4]
rate = 1.5
"""
ZIGZAG = """
[[test]]
name = "zig-zag"
kind = "zigzag"
duration = 60.0
set = { angle = 25.0, heading = 10.0 }
"""


def test_several_rudders_move_as_one_and_each_keeps_its_limit(tmp_path: Path) -> None:
    head = HEAD.replace('"thrusters", ', '"rudders", ').replace('"k_ahead", ', '"Ndelta", ')
    rudder = "Ydelta = 0.0, Kdelta = 0.0, Ndelta = 30"
    ship = BOAT.replace("k_ahead = 0.011, k_astern = 0.011", rudder)
    (tmp_path / "boat.toml").write_text(ship + RUDDERS, encoding="utf-8")
    path = tmp_path / "design.toml"
    path.write_text(head + "rudder_rate = 3.0\n" + ZIGZAG, encoding="utf-8")
    [rated] = plan(load_design(path)).rated
    [passage] = rated.outcome.passages
    signals = passage.trial.signals
    [excess] = rated.outcome.excesses
    assert excess.limit == "port"
    assert "25 deg of port are ordered, 20 are allowed" in excess.sentence
    rates = [np.rad2deg(np.abs(np.diff(signals[n])).max()) / 0.2 for n in ("port", "stbd")]
    assert rates == pytest.approx([3.0, 1.5])
