"""The Otter stopped and ordered astern by an identified model, against another programme's boat."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import otter
import pytest
from otter_model import ORDERED, TRUTH, fitted, model, record
from test_bad_input import trialid_
from test_start_with_thrusters import log, started
from typical import known_by

from trialid.design.helm import vessel
from trialid.design.prediction import stopping
from trialid.design.prediction.engine_orders import astern_orders, engine_of
from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.design.prediction.stopping import sail_stop
from trialid.design.standard import in_calm
from trialid.effects.actuators import actuator_effects
from trialid.effects.actuators.astern_gains import drives_astern, held_astern
from trialid.errors import DesignError, TrialidError
from trialid.identification.fit import Fit
from trialid.identification.remarks import _held_astern, untold_astern
from trialid.ship.model import ShipModel
from trialid.workflow.use.orders import Stop, stop_order

SPEED = 1.0
KNOWN = known_by("Xu0", 0.0)


def boat(one: ShipModel):
    return vessel(one, 0.1, {"u": SPEED, "left_order": 40.0, "right_order": 20.0}, 0.05)


@pytest.fixture(scope="module")
def identified() -> ShipModel:
    return fitted(record(1050)).model


def of_the_boat(share: float, *, astern: bool) -> tuple[float, float]:
    """Seconds and metres that the true boat takes from her approach until so much is left."""
    ahead = np.sqrt(-otter.XU * SPEED / (2.0 * otter.AHEAD))
    step, begun = 0.05, 160
    t = np.arange(240) * step
    orders = np.where(np.arange(len(t))[:, None] < begun, ahead, -ahead * astern) * np.ones((1, 2))
    u = otter.sail(t, orders).u
    assert u[begun - 1] == pytest.approx(SPEED, rel=2e-3)
    slow = int(np.flatnonzero(u[begun:] <= share * SPEED)[0])
    last = float(np.interp(-share * SPEED, -u[begun : begun + slow + 1], np.arange(slow + 1)))
    return (last + 0.5) * step, float(np.trapezoid(u[begun - 1 : begun + slow])) * step


@pytest.mark.parametrize(("share", "astern"), [(0.0, True), (0.5, False)])
def test_the_identified_boat_stops_as_the_true_one(
    identified: ShipModel, share: float, astern: bool
) -> None:
    """Time and head reach within 3 % and a step, from orders that hold her speed, straight on."""
    made = sail_stop(boat(identified), share, KNOWN, {}, astern=astern)
    time, reach = of_the_boat(share, astern=astern)
    found = {name: value for name, (value, _) in made.numbers.items()}
    assert found["time to that speed [s]"] == pytest.approx(time, rel=0.03, abs=0.03)
    assert found["head reach [m]"] == pytest.approx(reach, rel=0.03, abs=0.03)
    print(share, astern, found, time, reach)
    assert found["lateral deviation [m]"] == pytest.approx(0.0, abs=1e-6)
    assert made.given["left_order"][0] > 0.0
    assert (made.given["left_order"][-1] < 0.0) == astern


def test_no_time_and_no_way_of_a_stop_is_below_zero() -> None:
    """Of an outsider's boat, whose gain astern nobody knew, she stopped in -0.12 to 0.13 s."""
    spread = (-0.12, 0.13)
    numbers = {name: (0.03, spread) for name in (*stopping.FORWARD, stopping.ASIDE)}
    t = np.arange(3.0)
    u = np.array([1.0, 0.6, 0.4])
    made = PredictedMotion(t=t, given={}, motion={"u": u}, ranges={}, numbers=numbers)
    found = stopping._until_slow(made, 0.5, 0).numbers
    assert [found[name][1] for name in stopping.FORWARD] == [(0.0, 0.13)] * 3
    assert found[stopping.ASIDE][1] == spread


def truth() -> ShipModel:
    return model().with_values(TRUTH)


def test_more_is_ordered_astern_than_nothing() -> None:
    """A crash stop is shorter than a stop, as fast astern as ahead, and holds her speed before."""
    base = in_calm(boat(truth()))
    engine = engine_of(base)
    ahead = np.sqrt(-otter.XU * SPEED / (2.0 * otter.AHEAD))
    assert [*engine.approach] == ["left_order", "right_order"]
    assert [*engine.approach.values()] == pytest.approx([ahead, ahead], rel=1e-6)
    assert astern_orders(base, engine) == {n: -x for n, x in engine.approach.items()}
    reach = {
        a: sail_stop(boat(truth()), 0.5, KNOWN, {}, astern=a).numbers["head reach [m]"][0]
        for a in (True, False)
    }
    assert reach[True] < 0.7 * reach[False]


REACH = "head reach [m]"


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("held", [0.1, 9.0, 0.5])
def test_a_thrust_astern_that_nobody_told_goes_by_that_ahead(held: float) -> None:
    """An outsider's was held at nine times that ahead: 0.06 m (0 to 0.25) of a true 0.69.

    What a screw may have is kept, and what it may have beside it counts, too.
    """
    off = truth().with_values({"k_astern": held * otter.AHEAD})
    made = sail_stop(boat(off), 0.0, KNOWN, {}, astern=True, untold={"k_astern": "k_ahead"})
    by_share = [
        sail_stop(
            boat(truth().with_values({"k_astern": x * otter.AHEAD})), 0.0, KNOWN, {}, astern=True
        ).numbers[REACH][0]
        for x in (1.0, 0.8, 0.6)
    ]
    value, ends = made.numbers[REACH]
    told = sail_stop(boat(off), 0.0, KNOWN, {}, astern=True).numbers[REACH][0]
    assert not by_share[0] < told < by_share[2]
    kept = held == 0.5
    assert value == pytest.approx(told if kept else by_share[1])
    assert ends == pytest.approx((by_share[0], told if kept else by_share[2]))


def a_fit(held: float, *, astern: bool = False, free: tuple[str, ...] = ("k_ahead",)) -> Fit:
    """What is read of a fit whose gain astern is so many times that ahead."""
    pushes = np.array([30.0, -20.0 if astern else 20.0])
    known = truth().with_values({"k_astern": held * otter.AHEAD})
    trials = [SimpleNamespace(use="fit", signals=dict.fromkeys(ORDERED, pushes))]
    trials += [SimpleNamespace(use="check", signals=dict.fromkeys(ORDERED, -pushes))]
    unknowns = [SimpleNamespace(name=name) for name in free]
    problem = SimpleNamespace(unknowns=unknowns)
    return cast("Fit", SimpleNamespace(model=known, trials=trials, problem=problem))


def test_which_gains_astern_nobody_told() -> None:
    """Those that are held, where none of what drives her goes astern in a fitted trial."""
    assert untold_astern(a_fit(9.0)) == {"k_astern": "k_ahead"}
    assert untold_astern(a_fit(9.0, astern=True)) == {}
    assert untold_astern(a_fit(9.0, free=("k_ahead", "k_astern"))) == {}
    ship, idle = truth().ship, 0.02 * np.random.default_rng(4).standard_normal(50)
    assert drives_astern(ship, [{"left": np.ones(3), "u": -np.ones(3)}]) == set()
    assert drives_astern(ship, [{"left": np.array([1.0, np.nan, -0.2])}]) == {"left"}
    assert drives_astern(ship, [{"left": idle}, {"left": np.ones(3)}]) == set()


def test_a_gain_of_its_own_is_told_by_its_own_drive_alone() -> None:
    own = tuple(replace(a, own=True) for a in truth().ship.actuators)
    ship = replace(truth().ship, actuators=own)
    made = ShipModel(ship, ("u", "r"), (actuator_effects(ship, ("left", "right"))["thrusters"],))
    assert held_astern(made, (), ("left",)) == {"k_astern_right": "k_ahead_right"}
    assert held_astern(made, ("k_astern_right",), ("left",)) == {}
    assert held_astern(truth(), (), ("left",)) == {}


@pytest.mark.parametrize(("times", "told"), [(9.0, True), (0.8, False), (0.2, True), (1.5, False)])
def test_a_gain_astern_that_no_screw_has_is_told(times: float, told: bool) -> None:
    said = [line.partition(" the k_ahead")[0] for line in _held_astern(a_fit(times))]
    begun = f"no trial goes astern: k_astern stays as it is stated, {times:.2g} times"
    assert said == [begun] * told


def test_what_is_not_known_astern_is_refused() -> None:
    dead = boat(truth().with_values({"k_astern": 0.0}))
    with pytest.raises(DesignError, match="no push astern comes from"):
        sail_stop(dead, 0.0, KNOWN, {}, astern=True)
    mixed = replace(truth().ship.actuators[0], command="thrust", own=True)
    ship = replace(truth().ship, actuators=(mixed, truth().ship.actuators[1]))
    other = boat(truth())
    other = replace(other, model=replace(other.model, ship=ship))
    with pytest.raises(DesignError, match="not driven by one kind of order"):
        engine_of(other)


def test_the_words_of_a_crash_stop() -> None:
    assert stop_order(["stop", "astern"]) == Stop(0.0, True)
    assert stop_order(["stop", "20", "astern"]) == Stop(0.2, True)
    assert Stop(0.0, True).name == "stop 0 astern"
    for wrong in (["stop", "astern", "20"], ["stop", "0"], ["stop", "100", "astern"]):
        with pytest.raises(TrialidError):
            stop_order(wrong)


@pytest.mark.study(turn=12)
def test_a_boat_without_a_rudder_in_use(tmp_path, monkeypatch) -> None:
    """Stopped, ordered astern, handed over with the units of her thrusters; gains by both."""
    done = started(tmp_path, monkeypatch, [log(tmp_path / "a.csv")], "--length 2")
    assert done.exit_code == 0, done.output
    run = "runs/first_trial"
    told = trialid_("simulate", run, "stop", "astern", "--out", "stop.csv")
    assert told.exit_code == 0, told.output
    header, first, *_, last = (tmp_path / "stop.csv").read_text(encoding="utf-8").splitlines()
    place = header.split(",").index("thruster_port[rad/s]")
    ahead, astern = (float(line.split(",")[place]) for line in (first, last))
    assert ahead == pytest.approx(-astern)
    assert ahead > 0.0
    assert "head reach" in told.stdout
    assert "trialid simulate . stop" in (tmp_path / run / "report.html").read_text(encoding="utf-8")
    refused = trialid_("simulate", run, "zigzag", "20", "20")
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert "she has no rudder to steer by; `stop` and orders of your own need" in refused.stderr
    check_gains(tmp_path, run)
    one_side = tuple(replace(a, y=0.4) for a in truth().ship.actuators)
    aside = boat(replace(truth(), ship=replace(truth().ship, actuators=one_side)))
    monkeypatch.setattr("trialid.workflow.use.steering.ready_ship", lambda _: aside)
    for kind in ("pid", "nomoto"):
        refused = trialid_("export", run, "--as", kind, "--out", "none.json")
        assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
        assert "one to starboard; this model has the inputs left_order, right_o" in refused.stderr
    assert trialid_("export", run, "--as", "modelica", "--out", "boat.mo").exit_code == 0
    text = (tmp_path / "boat.mo").read_text(encoding="utf-8")
    assert 'input Real thruster_port(unit="rad/s", start=' in text


def check_gains(folder: Path, run: str) -> None:
    """Files say what is ordered; gains are of a share of the full command, which has to be said."""
    assert trialid_("export", run, "--as", "nomoto", "--out", "nomoto.json").exit_code == 0
    at = json.loads((folder / "nomoto.json").read_text(encoding="utf-8"))["at"][0]
    assert "thruster_port = cruise + delta, thruster_starboard = cruise - delta" in at["order"]
    assert (at["numbers"]["K"]["unit"], at["numbers"]["K"]["value"] > 0.0) == ("1", True)
    command = ("export", run, "--as", "ardupilot", "--out", "boat.param")
    for words, told in (
        ([], "add --full-command 1000 [rpm]"),
        (["--full-rudder", "35"], "say instead their command at full output"),
        (["--full-command", "10"], "of both thrusters that hold"),
        (["--full-command", "nan"], "expected a number above 0"),
    ):
        refused = trialid_(*command, *words)
        assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
        assert told in refused.stderr
    assert trialid_(*command, "--full-command", "1000").exit_code == 0
    text = (folder / "boat.param").read_text(encoding="utf-8")
    values = dict(x.split(",") for x in text.splitlines() if not x.startswith("#"))
    full = 1000.0 * 2.0 * np.pi / 60.0
    assert float(values["ATC_STR_RAT_FF"]) * full * at["numbers"]["K"]["value"] == pytest.approx(
        1.0, rel=1e-5
    )
    assert (values["MOT_THST_EXPO"], "MOT_SPD_SCA_BASE" in values) == ("0", False)
    assert "SERVOn_FUNCTION 73 for thruster_port and 74 for thruster_starboard" in text
    assert max(map(len, text.splitlines())) <= 100
    to = str(folder / "pid.json")
    told = trialid_(*command[:2], "--as", "pid", "--full-command", "1000", *("--out", to))
    assert told.exit_code == 0, told.stderr
    pid = json.loads((folder / "pid.json").read_text(encoding="utf-8"))
    assert pid["range"] == pytest.approx(full)
    assert "thruster_port = cruise + s * range" in pid["order"]
    K, T = (at["numbers"][n]["value"] for n in ("K", "T"))
    natural = pid["bandwidth"] / np.sqrt(1 - 2 * 0.64 + np.sqrt(4 * 0.64**2 - 4 * 0.64 + 2))
    assert pid["Kp"] * full == pytest.approx(natural**2 * T / K)
