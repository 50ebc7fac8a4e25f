"""Pulse widths of two motors by their thrust curve: newtons, and gains of one come back of them.

A motor gives less thrust astern, and none for 30 us to either side of its middle: no gain and
offset says that.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from test_own_signals import changed

from trialid import pipeline_file
from trialid.errors import TrialidError
from trialid.ingest import read as read_log
from trialid.progress import silent
from trialid.workflow.quantities_read import quantities_of
from trialid.workflow.read_trials import align_trials
from trialid.workflow.run import run
from trialid.workflow.use.finished_model import finished_model
from trialid.workflow.use.orders import read_orders
from trialid.workflow.use.predict import predict_orders
from trialid.workflow.write_run import write

CURVE = [[1100, -30.0], [1300, -9.0], [1470, 0.0], [1530, 0.0], [1700, 12.0], [1900, 42.0]]
SHIP = """
name = "boat"
source = "made up"
system = "dimensional"
rudder_positive = "starboard"
particulars = { L = 2.0, nabla = 0.08, rho = 1000.0, g = 9.81, U0 = 1.0 }
mass = { m = 80.0, I_zz = 20.0, Xudot = -5.0, Nrdot = -30.0 }
""" + "".join(
    f'[[actuator]]\nname = "{name}"\nkind = "thruster"\nat = [0.0, {y}]\ncommand = "thrust"\n'
    for name, y in (("left", -0.4), ("right", 0.4))
)
PIPELINE = f"""
ship = "boat.toml"
[[trial]]
name = "pulses"
logs = ["a.csv"]
[signals]
left = {{ channel = "pwm_left", unit = "N", curve = {CURVE} }}
right = {{ channel = "pwm_right", unit = "N", curve = {CURVE} }}
u = {{ channel = "u", unit = "m/s" }}
r = {{ channel = "r", unit = "rad/s" }}
[align]
period = 0.2
[model]
states = ["u", "r"]
effects = ["thrusters", "still_water_surge", "still_water_yaw"]
[identify]
free = ["k_ahead", "k_astern", "Xu0", "Nr0"]
outputs = ["u", "r"]
nuisance = ["initial_state"]
"""
TRUTH = {"k_ahead": 1.0, "k_astern": 1.0, "Xu0": -40.0, "Nr0": -25.0}


def thrust(width: np.ndarray) -> np.ndarray:
    """The curve by cases, not by a table."""
    ahead = np.where(width < 1700, 12 / 170 * (width - 1530), 12 + 30 / 200 * (width - 1700))
    astern = np.where(width > 1300, 9 / 170 * (width - 1470), -9 + 21 / 200 * (width - 1300))
    return np.maximum(ahead, 0.0) + np.minimum(astern, 0.0)


@cache
def log() -> str:
    """The boat by her pulse widths, held 4 s."""
    rng = np.random.default_rng(31)
    widths = np.repeat(rng.uniform(1150.0, 1880.0, (40, 2)), 20, axis=0)
    return sailed(widths, thrust, rng, "pwm_left [us],pwm_right [us]")


def sailed(
    orders: np.ndarray,
    thrust: Callable[[np.ndarray], np.ndarray],
    rng: np.random.Generator,
    names: str,
) -> str:
    """85 kg ahead and 50 kg m^2 in yaw against linear drag, from rest; a log."""
    rows, state, h = [f"time_s,u,r,{names}"], np.zeros(2), 0.04
    damping = np.array([40.0 / 85.0, 25.0 / 50.0])
    for k, now in enumerate(orders):
        u, r = state + rng.normal(0.0, (0.01, 0.002))
        rows.append(f"{0.2 * k:.1f},{u:.5f},{r:.6f},{now[0]:.4f},{now[1]:.4f}")
        after = thrust(orders[min(k + 1, len(orders) - 1)])
        for i in range(5):
            left, right = thrust(now) + (after - thrust(now)) * (i + 0.5) / 5.0
            push = np.array([(left + right) / 85.0, 0.4 * (left - right) / 50.0])
            state = ((1.0 - 0.5 * h * damping) * state + h * push) / (1.0 + 0.5 * h * damping)
    return "\n".join(rows) + "\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    files = {"boat.toml": SHIP, "p.toml": PIPELINE, "a.csv": log()}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def test_gains_of_one_come_back_of_stated_thrusts(folder: Path) -> None:
    """The log states microseconds, which a curve in newtons does not contradict."""
    assert read_log(folder / "a.csv").channels["pwm_left"].unit == "us"
    done = run(pipeline_file.load(folder / "p.toml"))
    found = {row.name: row for row in done.findings.before.accuracy.physical}
    for name, true in TRUTH.items():
        assert abs(found[name].value - true) < 3.0 * found[name].standard_error < 0.1 * abs(true)


def test_beyond_the_ends_of_a_curve_nothing_is_known(folder: Path) -> None:
    """A width of 0 is that of an output switched off, not 40 newton astern."""
    path = folder / "a.csv"
    head, *rows = path.read_text(encoding="utf-8").splitlines()
    for k in range(300, 340):
        rows[k] = ",".join([*rows[k].split(",")[:3], "0", "0"])
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    [trial] = align_trials(pipeline_file.load(folder / "p.toml"), silent)
    assert any(one.startswith("left and right not recorded in [") for one in trial.remarks)
    assert trial.valid["left"].all()
    assert np.min(trial.signals["left"]) > -30.0


WRONG = [
    ("[1300, -9.0]", "[1100, -9.0]", "left.curve: the logged numbers must rise"),
    (str(CURVE), "[[1100, 1.0], [1900, 1.0]]", "left.curve: two points or more of different"),
    (", unit =", ", gain = 2.0, unit =", "left.curve: gain or offset is given too; the curve"),
    ('unit = "N", curve', "curve", "left.unit: missing; write the unit of the second number"),
    ('"N", curve', '"deg", curve', "left.unit: unit 'deg' cannot become 'N'"),
]


@pytest.mark.parametrize(("old", "new", "says"), WRONG)
def test_what_is_wrong_with_a_curve_is_one_line(folder: Path, old: str, new: str, says: str):
    path = changed(folder, "p.toml", old, new)
    with pytest.raises(TrialidError, match=says) as caught:
        pipeline_file.load(path)
    assert "\n" not in str(caught.value)


SHARES = (
    PIPELINE.replace(f', unit = "N", curve = {CURVE}', ', unit = "1"')
    .replace("pwm_", "share_")
    .replace('"k_astern", ', "")
    .replace("[identify]", "values = { k_astern = 20.0 }\n[identify]")
)


@pytest.mark.parametrize(("power", "named"), [(1.0, True), (1.5, True), (2.0, False)])
@pytest.mark.parametrize(
    "seed", [41, *(pytest.param(s, marks=pytest.mark.study(turn="each")) for s in (42, 43))]
)
def test_thrust_that_is_in_proportion_to_a_share_is_named(tmp_path, seed, power, named) -> None:
    """What a command of half gives is a quarter of full in the model, as of revolutions."""
    rng = np.random.default_rng(seed)
    shares = np.repeat(rng.uniform(0.1, 1.0, (40, 2)), 20, axis=0)
    text = sailed(shares, lambda share: 40.0 * share**power, rng, "share_left,share_right")
    ship = SHIP.replace('"thrust"', '"share"')
    for name, told in {"boat.toml": ship, "p.toml": SHARES, "a.csv": text}.items():
        (tmp_path / name).write_text(told, encoding="utf-8")
    done = run(pipeline_file.load(tmp_path / "p.toml")).findings
    assert (done.verdict.effect == "thrusters_linear") == named, done.verdict.sentence
    assert named or done.verdict.effect is None


def test_a_boat_without_sway_says_that_her_track_holds_no_drift(folder: Path) -> None:
    """Of an outsider's 16 boats the truth was within the range of her track in three."""
    write(run(pipeline_file.load(folder / "p.toml")), folder / "out")
    (folder / "orders.csv").write_text(
        "t[s],left[N],right[N]\n0,9,9\n20,12,6\n40,9,9\n", encoding="utf-8"
    )
    model = finished_model(folder / "out", silent)
    known = quantities_of(pipeline_file.load(folder / "p.toml"))
    words = predict_orders(model, read_orders(folder / "orders.csv", known), "orders").words
    assert any(word.startswith("No sway is simulated: the track goes where") for word in words)
