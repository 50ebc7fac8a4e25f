"""The design file: what a good one gives, and what every mistake is told."""

import json
import re
import shutil
from pathlib import Path

import pytest

from trialid.effects import CATALOGUE
from trialid.errors import PipelineError
from trialid.pipeline_file.design_file import load_design
from trialid.pipeline_file.finished_run import FinishedRun, finished_run
from trialid.workflow.design import design_ships

ROOT = Path(__file__).parents[2]
GOOD = """
ship = "s175q.toml"
noise = { r = 0.05, phi = { sigma = 0.1, memory = 5.0 } }

[model]
states = ["v", "p", "r", "phi"]
effects = ["linear_hull", "linear_rudder", "linear_roll"]

[identify]
free = ["Nr", "Ndelta"]
outputs = ["r", "phi"]

[at_sea]
rudder_rate = 2.0

[limits]
rudder = 35.0

[[test]]
name = "zig-zag"
kind = "zigzag"
duration = 300.0
set = { angle = 10.0 }
open = { heading = [5.0, 20.0] }
"""
ZIGZAG = """kind = "zigzag"
duration = 300.0
set = { angle = 10.0 }
open = { heading = [5.0, 20.0] }"""


@pytest.fixture
def file(tmp_path):
    shutil.copy(ROOT / "sample_data" / "ships" / "s175q.toml", tmp_path)

    def write(text=GOOD):
        path = tmp_path / "design.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_a_good_file(file):
    recipe = load_design(file())
    assert recipe.noise["phi"].memory == 5.0
    assert recipe.noise["r"].sigma == 0.05
    assert recipe.limits.rudder_rate is None
    assert recipe.search.criterion == "error"
    assert recipe.tests[0].open == {"heading": (5.0, 20.0)}
    assert recipe.ships.count == 1


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        ('kind = "zigzag"', 'kind = "zigzags"', "test[0].kind", "no manoeuvre 'zigzags'; .*zigzag"),
        ("set = { angle", "set = { angel", "test[0].set.angel", "no such number; .*angle"),
        ("open = { heading", "open = { headings", "test[0].open.headings", "no such number"),
        ("{ angle = 10.0 }", "{ angle = [1.0, 2.0] }", "test[0].set.angle", "is one number"),
        ("{ angle = 10.0 }", "{ angle = 10.0, heading = 9.0 }", "test[0].open.heading",
         "is set as well; keep one"),
        ("set = { angle = 10.0 }\n", "", "test[0].set.angle", "missing; give angle here, or leave"),
        ("duration = 300.0\n", "", "test[0].duration", "missing; give it in s, or leave it open"),
        ("[5.0, 20.0]", "[20.0, 5.0]", "test[0].open.heading", "runs backwards"),
        ("rudder = 35.0", "ruder = 35.0", "limits.ruder", "rudder"),
        ("rudder = 35.0", "rudder = -3.0", "limits.rudder", "greater than 0"),
        ("rudder = 35.0", "rudder_rate = 1.0", "at_sea.rudder_rate",
         "2 deg/s are more than limits.rudder_rate allows, 1"),
        ("noise = { r = 0.05,", "noise = { rr = 0.05,", "noise.rr", "unknown quantity"),
        ("rudder_rate = 2.0", "constant = { nn = 70.0 }", "at_sea.constant.nn", "unknown quantity"),
        ("rudder_rate = 2.0", 'constant = { n = { value = 7.0, unit = "kn" } }',
         "at_sea.constant.n.unit", "kn"),
        ("[limits]", '[search]\ncriterion = "best"\n[limits]', "search.criterion", "error"),
        ("[limits]", "[search]\ncandidates = 0\n[limits]", "search.candidates", "equal to 1"),
        ("[limits]", '[separate]\neffects = ["bias_r"]\n[limits]', "separate.effects[1]",
         "missing"),
        ("duration = 300.0", "duration = 30.0", "test[0].duration", "30 s are over with the strai"),
        ("duration = 300.0", "duration = 1e9", "test[0].duration", "more than 200000 samples"),
        (ZIGZAG, 'duration = 90.0\nkind = "square_wave"\nset = { angle = 9.0, period = 0.0 }',
         "test[0].set.period", "must be more than 0, got 0"),
        (ZIGZAG, 'duration = 90.0\nkind = "steps"\nset = { angles = [9.0], lengths = [1.0, -2.0] }',
         "test[0].set.lengths", "must be more than 0, got -2"),
        (ZIGZAG, 'duration = 90.0\nkind = "steps"\nset = { angles = [] }', "test[0].set.angles",
         "is empty"),
        (ZIGZAG, 'duration = 9e1\nkind = "square_wave"\nset.angle = 9.0\nopen.period = [-5.0, 9.0]',
         "test[0].open.period", "must be more than 0, got -5"),
        ("[[test]]", "[[tests]]", "tests", "did you mean 'test'"),
        ('kind = "zigzag"\n', "", "test[0].kind", "missing"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_in_one_line_with_its_key(file, old, new, key, words):
    assert old in GOOD
    path = file(GOOD.replace(old, new, 1))
    with pytest.raises(PipelineError) as caught:
        load_design(path)
    said = str(caught.value)
    assert re.search(words, said), said
    assert said.startswith(f"{path}: {key}")
    assert "\n" not in said


def test_a_name_given_twice(file):
    again = '[[test]]\nname = "zig-zag"\nkind = "turning_circle"\nduration = 9.0\nset.angle = 9.0\n'
    with pytest.raises(PipelineError, match=r"test\[1\]\.name: 'zig-zag' is already the name"):
        load_design(file(GOOD + again))


def test_the_pipeline_lends_ship_model_and_identify(tmp_path):
    hidden = ROOT / "pipelines" / "hidden_effect.toml"
    text = GOOD[GOOD.index("noise =") : GOOD.index("[model]")]
    rest = GOOD[GOOD.index("[[test]]") :]
    path = tmp_path / "design.toml"
    path.write_text(f"pipeline = {json.dumps(str(hidden))}\n{text}{rest}", encoding="utf-8")
    recipe = load_design(path)
    assert recipe.ship.name == "s175q.toml"
    assert "linear_hull" in recipe.model.effects
    assert recipe.identify.free


def test_values_of_a_finished_run(file, tmp_path):
    path = file('run = "out"\n' + GOOD)
    recipe = load_design(path)
    with pytest.raises(PipelineError, match=r"run: .*is no result of a run; give the folder"):
        finished_run(recipe)
    (tmp_path / "out").mkdir()
    rows = [{"name": "Nr", "value": -0.002, "kind": "physical"},
            {"name": "b_r", "value": 0.1, "kind": "nuisance"}]  # fmt: skip
    effects = recipe.model.effects
    result = {"accuracy": {"parameters": rows}, "model": {"effects": effects}}
    (tmp_path / "out" / "result.json").write_text(json.dumps(result), encoding="utf-8")
    found = finished_run(recipe)
    assert (found.values, found.effects) == ({"Nr": -0.002}, tuple(effects))
    result["model"] = {"effects": [*effects, "cross_flow_drag"]}
    (tmp_path / "out" / "result.json").write_text(json.dumps(result), encoding="utf-8")
    with pytest.raises(PipelineError, match=r"of another model \(apart in cross_flow_drag\)"):
        finished_run(recipe)
    assert finished_run(load_design(file())) == FinishedRun()


def test_she_is_sailed_with_the_loss_of_speed_of_her_run(file, monkeypatch):
    lost = FinishedRun(speed_lost={"lost_in_turns": 6.0, "lost_by_rudder": 0.4, "lost_after": 7.0})
    monkeypatch.setattr(design_ships, "finished_run", lambda pipeline: lost)
    [ship] = design_ships.ships_of_design(load_design(file()), CATALOGUE)
    assert "u_off" in ship.vessel.model.all_states
    assert ship.vessel.model.value("lost_in_turns") == 6.0
    stated = GOOD.replace("rudder_rate = 2.0", "rudder_rate = 2.0\nconstant = { u = 7.0 }")
    [ship] = design_ships.ships_of_design(load_design(file(stated)), CATALOGUE)
    assert "u_off" not in ship.vessel.model.all_states
