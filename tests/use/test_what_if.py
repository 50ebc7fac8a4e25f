"""The ship with something changed, and with her engine stopped: what she does, what is said."""

from pathlib import Path

import numpy as np
import pytest
import s175q
from test_bad_input import trialid_
from typical import known_by

from trialid.design.following import sailed_ship
from trialid.design.helm import carry_out, vessel
from trialid.design.imo import measures
from trialid.design.manoeuvres import zigzag
from trialid.design.prediction.stopping import sail_stop
from trialid.design.standard import LENGTHS, STEPS, STRAIGHT, in_calm
from trialid.effects import CATALOGUE
from trialid.errors import DesignError, TrialidError
from trialid.progress import silent
from trialid.ship.model import ShipModel
from trialid.workflow.use.finished_model import FinishedModel, finished_model
from trialid.workflow.use.orders import named_manoeuvre, stop_order
from trialid.workflow.use.predict import predict_manoeuvre, spread_of
from trialid.workflow.use.what_if import WhatIf, changed_ship, known_changes, read_changes

FIRST = "first overshoot 20/20 [deg]"
ASKED = named_manoeuvre(["zigzag", "20"])


@pytest.fixture(scope="module")
def model(run_folder: Path) -> FinishedModel:
    return finished_model(run_folder, silent)


# --- another number -----------------------------------------------------------------------------


@pytest.mark.study(turn="each")
def test_another_speed_is_that_of_a_ship_built_so(model: FinishedModel) -> None:
    """In the prime system nothing but the speed changes, and a slower ship is told as unseen."""
    found = predict_manoeuvre(model, ASKED, WhatIf({"speed": 5.0}))
    ship = s175q.SHIP.__class__(
        **{**vars(model.fit.model.ship), "particulars": {**s175q.SHIP.particulars, "U0": 5.0}}
    )
    other = ShipModel(ship, model.fit.model.states, model.fit.model.effects, model.fit.model.values)
    rate = predict_rate(model)
    base = in_calm(vessel(other, 0.5, {"u": 5.0}, rate))
    one = STEPS * base.period
    a = float(np.deg2rad(20.0))
    passage = carry_out(base, zigzag(a, a, 4), STRAIGHT * one, LENGTHS * one)
    expected = float(np.rad2deg(measures.overshoots(passage)[0]))
    assert found.motion.numbers[FIRST][0] == pytest.approx(expected, rel=1e-6)
    plain = predict_manoeuvre(model, ASKED).motion.numbers[FIRST][0]
    assert abs(expected - plain) > 0.2
    [said] = [w for w in found.words if "What if speed" in w]
    assert "5.00 m/s: beyond what the trials hold, 7.33 m/s to 7.33 m/s" in said


def predict_rate(model: FinishedModel) -> float:

    return sailed_ship(model.fit).rudder_rate


@pytest.mark.study(turn="each")
def test_a_number_that_is_stated_is_not_uncertain_and_its_place_is_told(
    model: FinishedModel,
) -> None:
    asked = WhatIf({"GM": 1.4})
    spread = known_changes(spread_of(model), asked)
    assert "GM" in spread_of(model).known
    assert "GM" not in spread.known
    found = predict_manoeuvre(model, ASKED, asked)
    near = predict_manoeuvre(model, ASKED, WhatIf({"GM": model.fit.model.value("GM")}))
    heel = [float(np.abs(x.motion.motion["phi"]).max()) for x in (found, near)]
    assert abs(heel[0] - heel[1]) > 0.05 * heel[1]
    plain = predict_manoeuvre(model, ASKED)
    told = "What if GM = 1.4 m: another ship or loading than the record's"
    assert any(told in words for words in found.words)
    assert any("which the record allows (GM likely" in w for w in near.words)
    assert not any("What if" in w for w in plain.words)
    ratio = 1.4 / model.fit.model.value("GM")
    [told] = [w for w in found.words if "I_xx is held" in w]
    assert f"the ratio alone, which is now {ratio:.3g} times" in told
    [told] = [
        w for w in predict_manoeuvre(model, ASKED, WhatIf({"I_xx": 1.0})).words if "GM is" in w
    ]
    assert f"{model.fit.model.value('I_xx'):.3g} times" in told
    assert not any("is held: of" in w for w in plain.words)


def test_an_effect_is_left_out_and_the_record_speaks_against_it(model: FinishedModel) -> None:
    found = predict_manoeuvre(model, ASKED, WhatIf({}, ("linear_roll",)))
    assert any(
        "without linear_roll: the record speaks against it (GM likely" in w for w in found.words
    )


def test_changes_act_on_orders_of_a_table_too(run_folder: Path, tmp_path: Path) -> None:
    path = tmp_path / "turn.csv"
    path.write_text("t[s],delta[deg]\n0,10\n100,10\n", encoding="utf-8")
    ends = {}
    for changes in ([], ["--what-if", "speed=5"]):
        out = tmp_path / f"turn{len(changes)}.csv"
        told = trialid_("simulate", str(run_folder), str(path), "--out", str(out), *changes)
        assert told.exit_code == 0, told.stderr
        ends[len(changes)] = float(out.read_text().splitlines()[-1].split(",")[1 + 1])
    assert ends[2] != ends[0]
    assert "What if speed" in told.stdout


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (["GM"], "there is no ="),
        (["GM=a"], "expected a name and a number"),
        (["GM=nan"], "expected a finite number"),
        (["GN=1"], "no such parameter or input held; of 31 known the nearest are GM"),
        (["speed=-1"], "expected a speed above 0"),
        (["speed=1e-6"], "expected 0.15 to 366 [m/s]"),
    ],
)
def test_a_wrong_change_is_one_line(changes, words, model: FinishedModel) -> None:
    with pytest.raises(TrialidError) as caught:
        predict_manoeuvre(model, ASKED, read_changes(changes, ()))
    assert words in str(caught.value)


# --- the engine stopped -------------------------------------------------------------------------

EFFECTS = ("linear_hull", "linear_rudder", "surge_resistance", "propeller_thrust")
XUU = -0.0004226


def surging() -> ShipModel:
    model = ShipModel(s175q.SHIP, ("u", "v", "r"), tuple(CATALOGUE[n] for n in EFFECTS))
    return model.with_values({"Xuu": XUU})


def test_a_stopped_ship_runs_on_as_quadratic_resistance_has_it() -> None:
    """M du/dt = -c u^2: a half is left after m / (c U), and m / c ln 2 are run; ranges follow."""
    model = surging()
    p = model.ship.particulars
    ship = vessel(model, 0.5, {"u": p["U0"], "n": 5.0}, 0.05)
    deviation = 0.05 * abs(XUU)
    made = sail_stop(ship, 0.5, known_by("Xuu", deviation), {})
    start = float(made.motion["u"][200])
    mass = (model.value("m") - model.value("Xudot")) * p["L"] / -XUU
    time, time_range = made.numbers["time to that speed [s]"]
    reach, reach_range = made.numbers["head reach [m]"]
    assert time == pytest.approx(mass / start, rel=1e-3)
    assert reach == pytest.approx(mass * np.log(2.0), rel=1e-3)
    assert made.numbers["lateral deviation [m]"][0] == pytest.approx(0.0, abs=1e-6)
    assert made.t[-1] == pytest.approx(time + 200 * ship_period(ship), abs=1.0)
    ends = []
    for side in (1.96, -1.96):
        other = surging().with_values({"Xuu": XUU + side * deviation})
        one = vessel(other, 0.5, {"u": p["U0"], "n": 5.0}, 0.05)
        ends.append(sail_stop(one, 0.5, known_by("Xuu", 0.0), {}).numbers)
    for name, found in (("time to that speed [s]", time_range), ("head reach [m]", reach_range)):
        low, high = sorted(end[name][0] for end in ends)
        assert found == pytest.approx((low, high), abs=0.15 * (high - low))
        assert found[1] > found[0]


def ship_period(ship) -> float:
    return in_calm(ship).period


def test_a_ship_that_is_given_her_speed_is_not_stopped(model: FinishedModel) -> None:
    from trialid.workflow.use.stop import predict_stop

    asked = stop_order(["stop"])
    assert asked is not None
    with pytest.raises(DesignError, match="given its speed and does not simulate it"):
        predict_stop(model, asked)
    plain = vessel(surging() - "propeller_thrust", 0.5, {"u": 7.0}, 0.05)
    with pytest.raises(DesignError, match="no effect of this model reads a shaft"):
        sail_stop(plain, 0.5, known_by("Xuu", 0.0), {})
    for wrong in (["stop", "a"], ["stop", "0"], ["stop", "20", "3"]):
        with pytest.raises(TrialidError):
            stop_order(wrong)


def test_a_shaft_astern_that_no_trial_held_astern_is_a_range() -> None:
    """M du/dt = -c u^2 - T from U to rest runs M / (2 c) ln(1 + c U^2 / T); T is 60 to 100 %."""
    model = surging().with_values({"t_P": 0.0})
    ship = vessel(model, 0.5, {"u": 7.33, "n": 8.0}, 0.05)
    made = sail_stop(ship, 0.0, known_by("Xuu", 0.0), {}, astern=True)
    p = model.ship.particulars
    drag = -XUU * 0.5 * p["rho"] * p["L"] ** 2
    mass = (model.value("m") - model.value("Xudot")) * 0.5 * p["rho"] * p["L"] ** 3
    pull = p["rho"] * (8.0 / (2.0 * np.pi)) ** 2 * model.value("D_P") ** 4 * model.value("KT0")
    start = float(made.motion["u"][200])
    reach, low, high = (
        mass / (2.0 * drag) * np.log(1.0 + drag * start**2 / (share * pull))
        for share in (0.8, 1.0, 0.6)
    )
    found, ends = made.numbers["head reach [m]"]
    assert found == pytest.approx(reach, rel=5e-3)
    assert ends == pytest.approx((low, high), rel=5e-3)
    assert made.numbers["track reach [m]"][0] == pytest.approx(found, rel=1e-6)
    assert "lateral deviation [m]" not in made.numbers
    assert "no trial held the shaft astern" in made.remark


def test_a_shaft_whose_pull_astern_was_fitted_stops_by_that() -> None:
    known = surging() + CATALOGUE["propeller_astern"]
    reaches = []
    for less in (0.0, 1e-8):
        model = known.with_values({"X_ast": less, "N_ast": 4e-10})
        ship = vessel(model, 0.5, {"u": 7.33, "n": 8.0}, 0.05)
        made = sail_stop(ship, 0.0, known_by("X_ast", 1e-9), {}, astern=True)
        assert not made.remark
        assert made.numbers["lateral deviation [m]"][0] != 0.0
        reach, ends = made.numbers["head reach [m]"]
        assert ends[0] < reach < ends[1]
        reaches.append(reach)
    assert reaches[1] > 1.1 * reaches[0]


def test_speed_does_not_change_where_it_is_simulated() -> None:
    ship = vessel(surging(), 0.5, {"u": 7.0, "n": 5.0}, 0.05)
    with pytest.raises(TrialidError, match="follows from the shaft"):
        changed_ship(ship, WhatIf({"speed": 5.0}))
    faster = changed_ship(ship, WhatIf({"n": 6.0}))
    assert faster.constants["n"] == 6.0


def test_what_the_trials_had_beside_her_model_may_be_another(model: FinishedModel) -> None:
    made = predict_manoeuvre(model, ASKED, read_changes(["lost_in_turns=3"], ()))
    [told] = [one for one in made.words if one.startswith("What if")]
    assert told.startswith("What if lost_in_turns = 3: ")
    assert told.endswith(" as in the trials, over all of them.")


def test_an_angle_is_stated_in_degrees() -> None:
    """A rudder a degree off, not a radian."""
    model = (surging() + CATALOGUE["rudder_offset"]).with_values({"delta_0": 0.0})
    ship = vessel(model, 0.5, {"u": 7.0, "n": 5.0}, 0.05)
    changed = changed_ship(ship, WhatIf({"delta_0": 1.0}))
    assert changed.model.value("delta_0") == pytest.approx(np.deg2rad(1.0))
