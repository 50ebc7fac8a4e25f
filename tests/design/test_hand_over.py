"""What the crew is handed: pages, orders and the pipeline for the log that comes back."""

import csv
import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from test_plan import HEAD, STAIRS, ZIGZAG

from trialid.design import signals
from trialid.own_files import LIST
from trialid.pipeline_file import load
from trialid.pipeline_file.design_file import load_design
from trialid.toml_text import quote
from trialid.workflow import history
from trialid.workflow.design.design_folder import write
from trialid.workflow.design.design_run import plan

ROOT = Path(__file__).parents[2]
ODD = "<script>alert('a & b \N{SHIP}')</script>\n[[trial]]"
WRITTEN = """
[limits]
heel = 20.0
room = [9000.0, 5000.0, 5000.0]
"""


@pytest.fixture
def handed(tmp_path):
    """Plan a file and hand it over: the plan, the folder, and its data."""
    shutil.copy(ROOT / "sample_data" / "ships" / "s175q.toml", tmp_path)

    def hand(*parts):
        path = tmp_path / "design.toml"
        path.write_text("\n".join(parts), encoding="utf-8")
        done = plan(load_design(path))
        folder = tmp_path / "out" / "deep"
        return done, folder, write(done, folder)

    return hand


class Reader(HTMLParser):
    """Tags of a page, and its text."""

    def __init__(self):
        super().__init__()
        self.tags, self.text = [], []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)

    def handle_data(self, data):
        self.text.append(data)


def read(page):
    reader = Reader()
    reader.feed(page.read_text(encoding="utf-8"))
    return {*reader.tags}, " ".join(reader.text)


def test_every_file_is_there_and_says_the_same(handed):
    _, folder, data = handed(HEAD, WRITTEN, ZIGZAG, STAIRS)
    names = {f.name for f in folder.iterdir() if f.name != LIST}
    assert names == {
        "design.json", "bridge.html", "zig-zag.csv", "zig-zag.toml", "stairs.csv", "stairs.toml",
    }  # fmt: skip
    text = (folder / "design.json").read_text(encoding="utf-8")
    assert json.loads(text, parse_constant=pytest.fail) == json.loads(json.dumps(data))


def test_the_orders_read_back_are_those_that_were_sailed(handed):
    done, folder, _ = handed(HEAD, ZIGZAG, STAIRS)
    for rated in done.rated:
        trial = rated.outcome.passages[0].trial
        with (folder / f"{rated.name}.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        t = [float(row["t[s]"]) for row in rows]
        angles = np.deg2rad([float(row["rudder_order[deg]"]) for row in rows])
        np.testing.assert_allclose(
            signals.steps(trial.t, t, angles), trial.signals["delta_order"], atol=1e-6
        )
        assert rows[0]["order"] == "midships"


def test_the_pipeline_loads_once_log_and_channels_are_named(handed):
    done, folder, _ = handed(HEAD, ZIGZAG)
    path = folder / "zig-zag.toml"
    text = path.read_text(encoding="utf-8")
    assert text.count("NAME IT") == 4
    (folder / "log-of-zig-zag.mcap").write_bytes(b"")
    path.write_text(text.replace("NAME IT", "channel"), encoding="utf-8")
    recipe = load(path)
    asked = done.pipeline
    assert recipe.ship.resolve() == asked.ship.resolve()
    assert recipe.model.effects == asked.model.effects
    assert recipe.model.states == asked.model.states
    assert recipe.identify == asked.identify
    assert [t.name for t in recipe.trials] == ["zig-zag"]
    assert {*recipe.trials[0].signals} == {"delta", "r", "phi", "u"}
    assert recipe.trials[0].signals["delta"].positive == "starboard"


def test_what_is_identified_and_given_by_hand_comes_along(handed):
    head = HEAD.replace(
        "nuisance = []",
        'nuisance = ["bias"]\nweights = { r = 2.0 }\nbounds = { Nr = [-0.01, 0.0] }\n'
        'priors = { Nv = { mean = -0.003, std = 0.001 } }\nloss = "huber"',
    ).replace(
        "[identify]", 'values = { Yv = -0.012, GM = { value = 30.0, unit = "cm" } }\n[identify]'
    )
    done, folder, _ = handed(
        "together = true", head, "[at_sea.constant]\nn = 70.0\n", ZIGZAG, STAIRS
    )
    path = folder / "programme.toml"
    for log in ("zig-zag", "stairs"):
        (folder / f"log-of-{log}.mcap").write_bytes(b"")
    path.write_text(path.read_text().replace("NAME IT", "channel"), encoding="utf-8")
    recipe = load(path)
    assert recipe.identify == done.pipeline.identify
    assert recipe.model.values == done.pipeline.model.values
    assert [t.name for t in recipe.trials] == ["zig-zag", "stairs"]
    assert "n" in recipe.trials[1].signals


def test_what_a_fitted_sensor_reads_is_named_too(handed):
    """A heading parts a current from a speed over ground; without it the pipeline did not run."""
    over_ground = HEAD.replace('"heel_roll"]', '"heel_roll", "drift_in_speed_record"]')
    over_ground = over_ground.replace("nuisance = []", 'nuisance = ["current"]')
    _, folder, _ = handed(over_ground, ZIGZAG)
    text = (folder / "zig-zag.toml").read_text(encoding="utf-8")
    assert 'psi = { channel = "NAME IT", unit = "deg" }' in text
    _, folder, _ = handed(HEAD, ZIGZAG)
    assert "psi" not in (folder / "zig-zag.toml").read_text(encoding="utf-8")


def test_names_are_text_wherever_they_stand(handed):
    parts = [HEAD.replace('"small"', quote(ODD)), WRITTEN,
             ZIGZAG.replace('"zig-zag"', quote(ODD)),
             STAIRS.replace('"stairs"', quote('"quoted" \\ name'))]  # fmt: skip
    _, folder, _ = handed(*parts)
    tags, text = read(folder / "bridge.html")
    assert "script" not in tags
    assert text.count(ODD) >= 2  # the plan's and the test's
    assert "<script>" not in (folder / "bridge.html").read_text(encoding="utf-8")
    plain_names = {re.sub(r"\.[a-z]+$", "", f.name) for f in folder.iterdir() if f.name != LIST}
    assert all(re.fullmatch(r"[a-z0-9-]+", name) for name in plain_names)
    path = folder / "script-alert-a-b-script-trial.toml"
    (folder / "log-of-script-alert-a-b-script-trial.mcap").write_bytes(b"")
    path.write_text(path.read_text().replace("NAME IT", "channel"), encoding="utf-8")
    assert load(path).trials[0].name == ODD


def test_names_that_become_the_same_file_do_not_overwrite_each_other(handed):
    twin = ZIGZAG.replace('"zig-zag"', '"zig zag"').replace("angle = 10.0", "angle = 20.0")
    _, folder, _ = handed(HEAD, ZIGZAG, twin)
    names = {f.name for f in folder.iterdir() if f.name != LIST}
    assert {"zig-zag.csv", "zig-zag-2.csv", "zig-zag.toml", "zig-zag-2.toml"} <= names
    assert '"zig-zag"' in (folder / "zig-zag.toml").read_text()
    assert '"zig zag"' in (folder / "zig-zag-2.toml").read_text()


def test_the_page_says_when_to_break_off_and_draws_what_to_expect(handed):
    done, folder, _ = handed(HEAD, WRITTEN, ZIGZAG, STAIRS)
    tags, text = read(folder / "bridge.html")
    assert {"svg", "table"} <= tags
    assert not {"img", "iframe", "link"} & (tags - {"link"})
    assert "heel beyond 20 deg" in text
    assert "more than 9000 m ahead, 5000 m to either side or 5000 m astern" in text
    heel = max(np.abs(r.outcome.passages[0].trial.signals["phi"]).max() for r in done.rated)
    assert f"{np.rad2deg(heel):.1f} deg" in text


def test_a_test_that_may_not_be_run_is_not_handed_over(handed):
    _, folder, data = handed(
        HEAD, "[limits]\nrudder = 9.0", ZIGZAG, STAIRS.replace("20.0]", "8.0]").replace("-20", "-8")
    )
    names = {f.name for f in folder.iterdir() if f.name != LIST}
    assert "stairs.csv" in names
    assert not names & {"zig-zag.csv", "zig-zag.toml"}
    _, text = read(folder / "bridge.html")
    assert "zig-zag" not in text
    assert data["best"] == "stairs"


@pytest.mark.parametrize(("joined", "grown"), [("heel_roll", True), ("cross_flow_drag", False)])
def test_a_model_that_has_grown_is_a_grown_one_for_the_log_to_come(handed, tmp_path, joined, grown):
    effects = ["linear_hull", "linear_rudder", "linear_roll", "heel_roll"]
    steps = [
        {"step": "as written", "effects": effects[:-1], "eps_rmsn": 0.2, "logs": ["a"]},
        {"step": "added", "added": joined, "effects": effects, "eps_rmsn": 0.1, "logs": ["a"]},
        {"step": "proposed", "added": "static_list", "effects": effects, "eps_rmsn": 0.09},
    ]
    made = {"accuracy": {"parameters": []}, "model": {"effects": effects}, "history": steps}
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "result.json").write_text(json.dumps(made), encoding="utf-8")
    _, folder, _ = handed('run = "run"', HEAD, ZIGZAG)
    read_back, torn = history.read(folder / "zig-zag.toml")
    assert [step.added for step in read_back] == [None, joined]
    assert torn == ""
    assert history.has_joined(read_back, effects) == grown
