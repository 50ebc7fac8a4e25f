"""What a fitted ship is said to do holds what she does with all usual forces at once, too."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from s175q import MODEL, ROOT, SHAFT
from test_bad_input import trialid_
from test_usual_forces import drawn, sailed

from trialid.accuracy.ranges import USUAL_FORCES
from trialid.design.following import vessel_of
from trialid.design.helm import vessel
from trialid.design.standard import predict
from trialid.progress import silent
from trialid.workflow.use.finished_model import finished_model
from trialid.workflow.use.hand_over import UNTOLD, WRITERS
from trialid.workflow.use.kept_standing import FILE
from trialid.workflow.use.orders import named_manoeuvre, read_orders
from trialid.workflow.use.predict import predict_manoeuvre, predict_orders
from trialid.workflow.use.steering import Wishes

SEED = 21
"""Of a ship of which both usual hulls arrive."""
SIGNALS = """\
[trial.signals]
delta = { channel = "rudder", unit = "rad", positive = "starboard" }
r = { channel = "rot", unit = "rad/s" }
phi = { channel = "heel", unit = "rad" }
u = { channel = "stw", unit = "m/s" }
"""
PIPELINE = f"""\
ship = "ship.toml"
imo = true
[[trial]]
name = "zigzag-10"
logs = ["zigzag-10.csv"]
{SIGNALS}
[[trial]]
name = "zigzag-20"
logs = ["zigzag-20.csv"]
{SIGNALS}
[align]
period = 0.5
[model]
states = ["v", "p", "r", "phi"]
effects = ["linear_hull", "linear_rudder", "linear_roll", "centripetal_added_mass"]
[identify]
free = ["Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM"]
priors = "ship"
outputs = ["r", "phi"]
nuisance = ["initial_state"]
[diagnose]
candidates = "none"
"""
UNCERTAIN = "[uncertainty]\ndefault = 0.3\nGM = 0.1\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The run of a drawn ship's zig-zags by a linear model, nothing tried."""
    place = tmp_path_factory.mktemp("beside")
    for trial in sailed(drawn(SEED), SEED):
        signals = trial.signals
        columns = {"t[s]": trial.t, "rudder[rad]": signals["delta"], "rot[rad/s]": signals["r"]}
        columns |= {"heel[rad]": signals["phi"], "stw[m/s]": signals["u"]}
        pd.DataFrame(columns).to_csv(place / f"{trial.name}.csv", index=False)
    ship = (ROOT / "sample_data" / "ships" / "s175q.toml").read_text(encoding="utf-8")
    (place / "ship.toml").write_text(ship.partition("[uncertainty]")[0] + UNCERTAIN)
    (place / "used.toml").write_text(PIPELINE)
    told = trialid_("run", str(place / "used.toml"), "--quiet", "--out", str(place / "run"))
    assert told.exit_code == 0, told.stderr
    return place / "run"


@pytest.fixture(scope="module")
def model(folder):
    return finished_model(folder, silent)


@pytest.mark.study(turn=9)
def test_the_folder_keeps_both_hulls(folder, model):
    """Taken up from the folder or worked out anew, it is the same to the search's precision."""
    assert [what for what, _ in model.done.others] == [USUAL_FORCES] * 2
    kept = (folder / FILE).read_bytes()
    (folder / FILE).unlink()
    try:
        anew = finished_model(folder, silent)
    finally:
        (folder / FILE).write_bytes(kept)
    asked = named_manoeuvre(["zigzag", "20"])
    for one, other in zip((model, *model.others), (anew, *anew.others), strict=True):
        assert one.fit.estimates == pytest.approx(other.fit.estimates, rel=1e-6)
        assert one.fit.model.effects == other.fit.model.effects
    mine, theirs = (predict_manoeuvre(m, asked).motion.numbers for m in (model, anew))
    for name, (value, ends) in theirs.items():
        assert mine[name][0] == pytest.approx(value, rel=1e-6)
        assert mine[name][1] == pytest.approx(ends, rel=1e-4)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    "words",
    [
        ("circle", "35"),
        ("zigzag", "20"),
        pytest.param(("zigzag", "10"), marks=pytest.mark.study(turn="each")),
    ],
)
def test_a_manoeuvre_s_ranges_hold_what_both_do(model, words):
    asked = named_manoeuvre([*words])
    whole, *others = (predict_manoeuvre(m, asked).motion for m in (model, *model.others))
    for name, (_, (low, high)) in whole.numbers.items():
        for other in others:
            assert low <= other.numbers[name][1][0] <= other.numbers[name][1][1] <= high
    for other in others:
        n = min(len(whole.t), len(other.t))
        assert np.all(whole.ranges["r"][0][:n] <= other.ranges["r"][0][:n] + 1e-12)
        assert np.all(whole.ranges["r"][1][:n] >= other.ranges["r"][1][:n] - 1e-12)


def test_one_number_has_one_range(model):
    """The report's measures are those of `simulate`, and hold the true ship's."""
    asked = {row.name: row for row in model.result.imo.measures}
    numbers = predict_manoeuvre(model, named_manoeuvre(["zigzag", "20"])).motion.numbers
    for name in ("first overshoot 20/20", "second overshoot 20/20"):
        assert numbers[f"{name} [deg]"][1] == pytest.approx(asked[name].interval, rel=1e-4)
    gear = vessel_of(model.fit).rudder_rate
    truth = vessel(replace(MODEL, ship=drawn(SEED)), 0.5, {"n": SHAFT, "u": 7.33}, gear)
    for one in predict([truth]):
        low, high = asked[one.criterion.name].interval
        assert low <= one.value <= high


@pytest.mark.study(turn="each")
def test_nomoto_s_numbers_hold_for_both_and_say_where_she_may_be_unstable(model):
    def written(one, form):
        return json.loads(WRITERS[form](one, "x", Wishes())[".json"])

    def numbers(one):
        return {n: x["likely"] for n, x in written(one, "nomoto")["at"][0]["numbers"].items()}

    known = numbers(model)
    for other in map(numbers, model.others):
        for name, (low, high) in other.items():
            assert known[name][0] <= low <= high <= known[name][1], name
    loops = [written(one, "pid")["words"] for one in (model, *model.others)]
    assert all(any("overshoots by" in w for w in words) for words in loops)
    levers = model.result.accuracy.stability
    unsure = replace(model.result.accuracy, stability=replace(levers, stable=None))
    doubted = replace(model, result=replace(model.result, accuracy=unsure))
    for form in ("nomoto", "pid"):
        assert written(doubted, form)["words"][0] == UNTOLD
        assert UNTOLD not in written(model, form)["words"]


def test_orders_hold_what_both_do(model, tmp_path):
    path = tmp_path / "weave.csv"
    t = np.arange(0.0, 300.0, 5.0)
    rows = {"t[s]": t, "delta[deg]": 20.0 * np.sin(0.03 * t)}
    pd.DataFrame(rows).to_csv(path, index=False)
    table = read_orders(path)
    whole, *others = (predict_orders(m, table, "weave").motion for m in (model, *model.others))
    for other in others:
        assert np.all(whole.ranges["r"][0] <= other.ranges["r"][0] + 1e-12)
        assert np.all(whole.ranges["r"][1] >= other.ranges["r"][1] - 1e-12)
    alone = [other.motion["r"] for other in others]
    assert max(np.abs(one - whole.motion["r"]).max() for one in alone) > 1e-4
