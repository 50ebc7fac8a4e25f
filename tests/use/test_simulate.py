"""The fitted ship under orders: the run's own numbers, ranges that follow, words that warn."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from mcap.reader import make_reader
from test_bad_input import trialid_
from typical import known_by

from trialid import ingest
from trialid.design.following import vessel_of
from trialid.design.prediction import predicted_motion
from trialid.design.prediction.predicted_motion import sail_manoeuvre, sail_orders
from trialid.design.prediction.ranged_motion import _possible
from trialid.errors import TrialidError
from trialid.progress import silent
from trialid.trial import Trial
from trialid.workflow.notebook.front import run, simulate
from trialid.workflow.use.finished_model import FinishedModel, finished_model
from trialid.workflow.use.orders import named_manoeuvre, read_orders
from trialid.workflow.use.predict import predict_manoeuvre, predict_orders

ZIGZAG = ("zigzag", "20", "20")


@pytest.fixture(scope="module")
def model(run_folder: Path) -> FinishedModel:
    return finished_model(run_folder, silent)


# --- numbers ------------------------------------------------------------------------------------


def test_a_named_manoeuvre_gives_the_run_s_own_measures(model: FinishedModel) -> None:
    """One number for one ship, and its range, wherever it stands."""
    asked = {row.name: row for row in model.result.imo.measures}
    zigzag = predict_manoeuvre(model, named_manoeuvre(["zigzag", "20"])).motion.numbers
    circle = predict_manoeuvre(model, named_manoeuvre(["circle", "35"])).motion.numbers
    pairs = {
        "first overshoot 20/20": zigzag["first overshoot 20/20 [deg]"],
        "second overshoot 20/20": zigzag["second overshoot 20/20 [deg]"],
        "advance": circle["advance [m]"],
        "tactical diameter": circle["tactical diameter [m]"],
    }
    for name, (value, ends) in pairs.items():
        assert value == pytest.approx(asked[name].value, rel=1e-9), name
        assert ends == pytest.approx(asked[name].interval, rel=1e-4), name


def test_orders_of_a_table_move_the_ship_as_the_model_says(
    model: FinishedModel, tmp_path: Path
) -> None:
    """At the table's own times, whatever the clock; and to the side the rudder says."""
    t = np.arange(0.0, 200.0, 2.0)
    delta = 15.0 * np.sin(0.03 * t)
    path = tmp_path / "weave.csv"
    pd.DataFrame({"t[s]": t, "delta[deg]": delta, "u[m/s]": 7.0}).to_csv(path, index=False)
    found = predict_orders(model, read_orders(path), "weave").motion
    assert found.t == pytest.approx(t)
    fine = np.arange(0.0, 198.1, 0.5)
    signals = {"delta": np.interp(fine, t, delta), "u": np.full(len(fine), 7.0)}
    trial = Trial.from_arrays(
        "w", fine, signals, units={"delta": "deg", "u": "m/s"}, positive={"delta": "starboard"}
    )
    plain = simulate(model.fit.model, trial, ("r", "phi", "v"))
    for name in plain:
        assert found.motion[name] == pytest.approx(plain[name].to_numpy()[::4], abs=1e-9)
    assert found.motion["r"][20] > 0.001
    assert found.motion["y"][20] > 1.0


def test_ranges_are_what_the_parameters_do(
    model: FinishedModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The ship sailed anew with a parameter moved lies at the ends; the helmsman answers her."""
    monkeypatch.setattr("trialid.design.standard.STEPS", 800)
    monkeypatch.setattr("trialid.design.standard.LENGTHS", 20.0)
    monkeypatch.setattr(predicted_motion, "STEPS", 800)
    monkeypatch.setattr(predicted_motion, "LENGTHS", 20.0)
    asked = named_manoeuvre(["zigzag", "10"])
    deviation = 1e-2 * abs(model.fit.model.value("Nr"))
    found = sail_manoeuvre(vessel_of(model.fit), asked, known_by("Nr", deviation), {})
    moved = []
    for side in (1.0, -1.0):
        value = model.fit.model.value("Nr") + side * 1.96 * deviation
        other = vessel_of(model.fit, model.fit.model.with_values({"Nr": value}))
        moved.append(sail_manoeuvre(other, asked, known_by("Nr", 0.0), {}))
    name = "first overshoot 10/10 [deg]"
    ends = sorted(m.numbers[name][0] for m in moved)
    assert found.numbers[name][1] == pytest.approx(ends, abs=0.02 * (ends[1] - ends[0]))
    n = min(len(found.t), *(len(m.t) for m in moved))
    for motion in ("psi", "r", "v", "phi", "x", "y"):
        apart = np.abs(moved[0].motion[motion][:n] - moved[1].motion[motion][:n])
        width = (found.ranges[motion][1] - found.ranges[motion][0])[:n]
        close = np.abs(width - apart) < 0.1 * apart.max()
        assert np.mean(close) > 0.95, motion
        assert apart.max() > 0.0, motion


def test_ranges_of_orders_are_what_the_parameters_do(model: FinishedModel) -> None:
    t = np.arange(0.0, 200.0, 0.5)
    signals = {"delta": 0.2 * np.sign(np.sin(0.05 * t)), "u": np.full(len(t), 7.0)}
    orders = Trial("o", "check", 0.5, signals, {})
    deviation = 1e-3 * abs(model.fit.model.value("Ndelta"))
    found = sail_orders(vessel_of(model.fit), orders, known_by("Ndelta", deviation), {}, every=2)
    value = model.fit.model.value("Ndelta") + 1.96 * deviation
    other = vessel_of(model.fit, model.fit.model.with_values({"Ndelta": value}))
    moved = sail_orders(other, orders, known_by("Ndelta", 0.0), {}, every=2)
    for motion in ("psi", "r", "v", "phi", "y"):
        apart = np.abs(moved.motion[motion] - found.motion[motion])
        half = found.ranges[motion][1] - found.motion[motion]
        assert half == pytest.approx(apart, abs=0.02 * apart.max()), motion


def test_the_wider_of_the_two_counts(model: FinishedModel) -> None:
    """Nothing is given more sure than the run's own band of a trial that was not fitted."""
    found = predict_manoeuvre(model, named_manoeuvre(["zigzag", "10", "10"])).motion
    assert set(model.result.fit.band) == {"r", "phi"}
    for name, wide in model.result.fit.band.items():
        low, high = found.ranges[name]
        assert (low <= found.motion[name] - wide + 1e-12).all()
        assert (high >= found.motion[name] + wide - 1e-12).all()


def test_a_range_ends_where_what_it_is_of_does(model: FinishedModel) -> None:
    """A speed was said to lie from -0.26 m/s on; and no heel is beyond a capsize."""
    told = replace(model.result, fit=replace(model.result.fit, band={"phi": 3.0, "U": 99.0}))
    asked = named_manoeuvre(["zigzag", "10", "10"])
    found = predict_manoeuvre(replace(model, result=told), asked).motion
    low, high = found.ranges["phi"]
    assert (low.min(), high.max()) == (-np.pi / 2, np.pi / 2)
    off = np.array([-1.26, -1.0]), np.array([1.0, 60.0])
    slowest, fastest = _possible("U", {"U": np.array([1.0, 2.0])}, off)
    assert (slowest.tolist(), fastest.tolist()) == ([0.0, 1.0], [2.0, 50.0])
    beyond = _possible("phi", {"phi": np.array([2.0])}, (np.array([-1.0]), np.array([1.0])))
    assert (beyond[0].item(), beyond[1].item()) == (1.0, 2.0)  # what was sailed lies in its range


def test_a_rudder_that_is_ordered_takes_its_time(model: FinishedModel, tmp_path: Path) -> None:
    path = tmp_path / "step.csv"
    path.write_text("t[s],delta_order[deg]\n0,0\n5,0\n5.5,20\n60,20\n", encoding="utf-8")
    found = predict_orders(model, read_orders(path), "step").motion
    steps = np.diff(found.given["delta"]) / np.diff(found.t)
    assert 0.0 < steps.max() < np.deg2rad(20.0)
    assert found.given["delta"][-1] == pytest.approx(np.deg2rad(20.0))


# --- in Python ----------------------------------------------------------------------------------


def test_a_run_in_memory_gives_the_same(run_folder: Path, model: FinishedModel) -> None:
    found = run(run_folder.parents[1] / "used.toml")
    frame = found.simulate("zigzag", 20, 20)
    same = predict_manoeuvre(model, named_manoeuvre(ZIGZAG)).motion
    assert frame["psi"].to_numpy() == pytest.approx(same.motion["psi"], abs=1e-6)
    assert frame["r_to"].to_numpy() == pytest.approx(same.ranges["r"][1], rel=1e-3, abs=1e-6)
    assert set(frame.attrs["numbers"]) == set(same.numbers)
    turn = found.simulate(delta=np.full(400, 0.2), period=0.5)
    assert turn["r"].iloc[-1] > 0.0
    assert len(turn) == 400
    for wrong in ({"delta": [0.1, 0.2]}, {"delta": [0.1], "period": 1.0}, {"helm": [0.1, 0.2]}):
        with pytest.raises(TrialidError):
            found.simulate(**wrong)


# --- words --------------------------------------------------------------------------------------


def test_what_the_trials_do_not_hold_is_said(model: FinishedModel) -> None:
    near = predict_manoeuvre(model, named_manoeuvre(["zigzag", "10", "10"])).words
    far = predict_manoeuvre(model, named_manoeuvre(["circle", "35"])).words
    assert not [word for word in near if "Beyond" in word]
    assert [word for word in far if "rudder angle \u03b4 35.0 deg" in word]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("t[s],delta\n0,0\n1,1\n", "no unit; write its header as delta[deg]"),
        ("t[s],helm[deg]\n0,0\n1,1\n", "inputs such as delta[deg]"),
        ("t[s],delta[m]\n0,0\n1,1\n", "'m' cannot become 'rad'"),
    ],
)
def test_wrong_orders_are_one_line(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(TrialidError) as caught:
        read_orders(path)
    assert words in str(caught.value)


def test_a_gap_is_not_bridged_and_ends_without_numbers_are_left_out(
    model: FinishedModel, tmp_path: Path
) -> None:
    """As `trialid align` writes them; a motion's first number says how she begins."""
    path = tmp_path / "aligned.csv"
    head = "trial,t[s],delta[rad],r[rad/s],u[m/s]\n"
    rows = [f"a,{0.5 * k},0.1,{0.004 if k == 2 else ''},7.0" for k in range(2, 40)]
    whole = head + "\n".join(["a,0.0,,,", "a,0.5,,,7.0", *rows, "a,20.0,,,"])
    path.write_text(whole, encoding="utf-8")
    found = predict_orders(model, read_orders(path), "aligned").motion
    assert (len(found.t), found.t[0], found.motion["r"][0]) == (38, 0.0, 0.004)
    path.write_text(whole.replace("a,10.0,0.1", "a,10.0,"), encoding="utf-8")
    with pytest.raises(TrialidError, match="column delta: row 21 of the orders has no number"):
        predict_orders(model, read_orders(path), "aligned")


def test_sensors_alone_are_refused(run_folder: Path, tmp_path: Path) -> None:
    shutil.copytree(run_folder.parents[1], tmp_path / "copy")
    spoilt = tmp_path / "copy" / run_folder.relative_to(run_folder.parents[1])
    text = json.loads((spoilt / "result.json").read_text(encoding="utf-8"))
    text["model"] |= {"states": []}
    (spoilt / "result.json").write_text(json.dumps(text), encoding="utf-8")
    with pytest.raises(TrialidError, match="compares sensors alone"):
        finished_model(spoilt, silent)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["zigzg", "20"], "did you mean 'zigzag'?"),
        (["zigzag"], "expected zigzag RUDDER [HEADING]"),
        (["zigzag", "a"], "could not convert"),
        (["circle", "0"], "0 is no angle"),
        (["circle", "nan"], "nan is no angle"),
    ],
)
def test_a_wrong_manoeuvre_is_one_line(words: list[str], told: str) -> None:
    with pytest.raises(TrialidError) as caught:
        named_manoeuvre(words)
    assert told in str(caught.value)


# --- the command --------------------------------------------------------------------------------


def test_the_command_writes_what_it_prints(run_folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "zigzag.csv"
    told = trialid_("simulate", str(run_folder), *ZIGZAG, "--out", str(out))
    assert (told.exit_code, told.stderr) == (0, "")
    assert "first overshoot 20/20 [deg]" in told.stdout
    about = json.loads((tmp_path / "zigzag.csv.json").read_text(encoding="utf-8"))
    low, high = about["numbers"]["first overshoot 20/20 [deg]"]["likely"]
    assert low < about["numbers"]["first overshoot 20/20 [deg]"]["value"] < high
    channels = ingest.read(out).channels
    assert channels["r"].unit == "rad/s"
    assert (channels["r_from"].y <= channels["r"].y).all()
    assert (channels["r"].y <= channels["r_to"].y).all()
    for suffix in (".parquet", ".mcap"):
        again = out.with_suffix(suffix)
        assert trialid_("simulate", str(run_folder), *ZIGZAG, "--out", str(again)).exit_code == 0
        assert ingest.read(again).channels
    kept = trialid_("simulate", str(run_folder), "circle", "35", "--out", str(out))
    assert kept.exit_code == 2
    assert "exists" in kept.stderr


def test_what_a_run_was_fitted_to_is_not_replaced(run_folder: Path, tmp_path: Path) -> None:
    """Not with `--force` either, wherever a copy lies; nor are the orders that are sailed."""
    result = json.loads((run_folder / "result.json").read_text(encoding="utf-8"))
    [log] = {run_folder.parents[1] / each["path"] for each in result["trials"][0]["logs"]}
    orders = tmp_path / "o.csv"
    orders.write_text("t[s],delta[deg]\n0,0\n10,5\n60,5\n", encoding="utf-8")
    shutil.copy(log, tmp_path / log.name)
    for out in (orders, tmp_path / log.name):
        kept = out.read_bytes()
        command = ("simulate", str(run_folder), str(orders), "--out", str(out), "--force")
        told = trialid_(*command)
        assert (told.exit_code, out.read_bytes()) == (2, kept)
        assert "is read by this command, or by its run; name another" in told.stderr


def test_a_fit_without_a_verdict_is_refused(run_folder: Path, tmp_path: Path) -> None:
    """Nothing is built on it, unless somebody says so, and then it is marked."""
    shutil.copytree(run_folder.parents[1], tmp_path / "copy")
    spoilt = tmp_path / "copy" / run_folder.relative_to(run_folder.parents[1])
    text = json.loads((spoilt / "result.json").read_text(encoding="utf-8"))
    text["verdict"] |= {"kind": "no fit", "sentence": "no fit: the search did not end"}
    (spoilt / "result.json").write_text(json.dumps(text), encoding="utf-8")
    told = trialid_("simulate", str(spoilt), "circle", "35")
    assert told.exit_code == 2
    assert told.stderr.count("\n") == 1
    assert "no fit: the search did not end; nothing is built on it" in told.stderr
    out = tmp_path / "circle.mcap"
    asked = ("circle", "35", "--anyway", "--out", str(out))
    marked = trialid_("simulate", str(spoilt), *asked)
    assert marked.exit_code == 0
    assert "no fit: the search did not end" in marked.stdout
    with out.open("rb") as stream:
        [about] = make_reader(stream).iter_attachments()
    assert json.loads(about.data)["verdict"] == "no fit"
