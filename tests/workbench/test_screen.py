import base64
import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from test_bad_input import PIPELINE
from test_two_rates import PIPELINE as TWO_RATES
from test_two_rates import write_logs
from turn import ADDED, TRIED, WITH_CHECK, opened, turned, write_folder

from trialid.names import wording
from trialid.pipeline_file import load
from trialid.report.pages import page as report
from trialid.result.json_file import plain, result_of
from trialid.workbench import screen
from trialid.workbench.shown import Shown
from trialid.workflow.build_model import available

HOSTILE = "<script>alert(1)</script>"
VOID = {"br", "hr", "img", "input", "link", "meta", "wbr"}
STAGES = ("reading", "opening", "before", "measured", "fitted", "after")


class Reader(HTMLParser):
    """Text, tags and attributes of a part; wrong nesting is an assertion."""

    def __init__(self, html):
        super().__init__(convert_charrefs=True)
        self.open, self.tags, self.attributes, self.words = [], [], [], []
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        names = [name for name, _ in attrs]
        assert len(set(names)) == len(names), (tag, names)
        self.tags.append(tag)
        self.attributes += [(tag, *each) for each in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open, f"</{tag}> closes nothing"
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)

    @property
    def text(self):
        return re.sub(r"[ \n]+", " ", "".join(self.words))

    def values(self, name):
        return [value for _, each, value in self.attributes if each == name]


@pytest.fixture(scope="module")
def turn(tmp_path_factory):
    return turned(write_folder(tmp_path_factory.mktemp("turn"), WITH_CHECK))


def read(shown):
    return {name: Reader(html) for name, html in screen.parts(shown).items()}


def texts(shown):
    return {name: each.text for name, each in read(shown).items()}


def with_result(shown, **changes):
    """The same screen of a result with some keys replaced."""
    result = plain(shown.run.result)
    for key, value in changes.items():
        result[key] = {**result[key], **value} if isinstance(result[key], dict) else value
    result = result_of(result)
    return replace(shown, run=replace(shown.run, result=result))


# --- what the page's policy and its script rely on ----------------------------------------------


@pytest.mark.parametrize("stage", STAGES)
def test_every_stage_keeps_to_the_policy_of_the_page(turn, stage):
    for name, part in read(turn.stages[stage]).items():
        names = {attribute for _, attribute, _ in part.attributes}
        assert "style" not in names, name
        assert not [each for each in names if each.startswith("on")], name
        assert not {"script", "style", "iframe", "img", "link"} & set(part.tags), name


@pytest.mark.parametrize("stage", STAGES)
def test_what_the_script_finds_again_has_one_name(turn, stage):
    parts = read(turn.stages[stage])
    everything = [Reader(screen.page(turn.before)), *parts.values()]
    for attribute in ("id", "data-key"):
        found = [value for part in everything for value in part.values(attribute)]
        assert len(set(found)) == len(found)
    ids = {value for part in everything for value in part.values("id")}
    for part in everything:
        for attribute in ("aria-controls", "aria-labelledby", "for"):
            assert {each for value in part.values(attribute) for each in value.split()} <= ids
        links = [each.removeprefix("#") for each in part.values("href") if each.startswith("#")]
        assert set(links) <= ids


def test_the_page_has_a_place_for_every_part_and_nothing_inline(turn):
    page = screen.page(turn.before)
    read = Reader(page)
    assert set(read.values("data-part")) == set(screen.parts(turn.before)) == set(screen.PARTS)
    assert re.findall(r"<script[^>]*>(.*?)</script>", page, re.DOTALL) == [""] * 2
    assert not {"style", "onclick"} & {name for _, name, _ in read.attributes}
    assert f"<title>{turn.before.pipeline.name}" in page


def test_every_field_and_button_says_what_it_is(turn):
    for shown in (turn.before, turn.after):
        html = "".join(screen.parts(shown).values())
        for field in re.findall(r"<input[^>]*>", html):
            assert "aria-label=" in field or 'id="another"' in field
        for button in re.findall(r"<button[^>]*data-do=[^>]*>", html):
            assert "aria-label=" in button


# --- how far the model is known -----------------------------------------------------------------


def test_each_stage_shows_what_it_knows_and_no_more(turn):
    facts = {stage: screen.facts(turn.stages[stage]) for stage in STAGES}
    known = {stage: {k for k, v in row.items() if v is not None} for stage, row in facts.items()}
    always = {"effects", "free"}
    errors = always | {"eps_rmsn", "eps_rmsn_check"}
    assert known["reading"] == known["opening"] == known["measured"] == always
    assert known["fitted"] == errors
    assert known["before"] == errors | {"verdict", "named"}
    assert known["after"] == errors | {"noise", "undermodelling", "verdict"}
    assert facts["fitted"]["eps_rmsn"] == facts["after"]["eps_rmsn"]
    assert facts["measured"]["effects"] == facts["after"]["effects"]
    assert ADDED in facts["after"]["effects"]
    assert ADDED not in facts["before"]["effects"]
    json.dumps(facts, allow_nan=False)


def test_facts_are_the_result_s(turn):
    result, facts = turn.after.run.result, screen.facts(turn.after)
    assert facts["eps_rmsn"] == result.fit.eps_rmsn
    assert facts["eps_rmsn_check"] == result.fit.eps_rmsn_check
    assert facts["noise"] == result.split.noise
    assert facts["undermodelling"] == result.split.undermodelling
    assert facts["effects"] == list(result.model.effects)
    assert facts["free"] == list(result.model.free)
    assert facts["verdict"] == result.verdict.kind
    assert facts["named"] == result.verdict.effect


def test_what_belongs_to_the_model_before_says_so(turn):
    fitting, fitted, after = (texts(each) for each in (turn.measured, turn.fitted, turn.after))
    for part in ("error", "where", "verdict", "missing"):
        assert "model before" in fitting[part], part
        assert "model before" in fitted[part], part
        assert "model before" not in after[part], part
    old, new = (wording.percent(each.run.result.fit.eps_rmsn)
                for each in (turn.before, turn.after))  # fmt: skip
    assert f"{old} of the model before" in fitting["error"]
    assert f"{old} → {new}" in fitted["error"]
    assert f"{old} → {new}" in after["error"]
    assert "→" not in texts(turn.before)["error"]


def test_estimates_before_the_fit_are_those_of_the_model_before(turn):
    def said(shown):
        rows = shown.run.result.accuracy.parameters
        row = next(row for row in rows if row.name == "Nr")
        return f"{wording.by_error(row.value, row.standard_error)} ± "

    fitting, fitted, after = (
        texts(each)["model"] for each in (turn.measured, turn.fitted, turn.after)
    )
    assert said(turn.before) in fitting
    assert "of the model before" in fitting
    assert " ± " not in fitted
    assert wording.number(turn.fitted.fit.estimates["Nr"]) in fitted
    assert said(turn.after) in after


def test_a_screen_without_anything_known_is_calm(turn):
    reading, opening = texts(turn.reading), texts(turn.opening)
    assert "being read" in reading["error"]
    assert "being fitted" in opening["error"]
    assert "No verdict yet" in opening["verdict"]
    assert "comes with the fit" in reading["missing"]
    for name in ("zigzag", "held-out"):
        assert name in reading["tabs"]
    assert "linear_hull" in reading["model"]


def test_the_step_that_is_computed_stands_below_those_that_are_known(turn):
    for shown, kind in ((turn.measured, "pending"), (turn.fitted, "pending")):
        html = screen.parts(shown)["history"]
        assert re.findall(r'<tr class="(\w+)"', html) == ["step", kind]
    html = screen.parts(turn.after)["history"]
    assert re.findall(r'<tr class="(\w+)"', html)[:2] == ["step", "present"]
    assert re.findall(r'<tr class="(\w+)"', screen.parts(turn.before)["history"])[0] == "present"


# --- the same digits everywhere -----------------------------------------------------------------


def test_numbers_are_written_as_in_the_report(turn):
    run, parts = turn.before.run.result, texts(turn.before)
    assert run.split.noise is None
    for eps in (run.fit.eps_rmsn, run.fit.eps_rmsn_check):
        assert wording.percent(eps) in parts["error"]
    for row in run.missing:
        for key in ("eps_rmsn_predicted", "eps_rmsn_refitted", "eps_rmsn_check"):
            assert wording.percent(getattr(row, key)) in parts["missing"]
        assert wording.number(row.p_value, 2) in parts["missing"]
    for row in run.physical:
        value, wide = wording.by_error(row.value, row.standard_error), np.ptp(row.likely) / 4
        ends = " to ".join(wording.by_error(x, wide) for x in row.likely)
        assert f"{value} ± {wording.number(row.standard_error, 2)}" in parts["model"]
        assert f"likely {ends}" in parts["model"]
    for trial in run.trials:
        for eps in trial.eps_rmsn.values():
            assert wording.percent(eps) in parts["about"]


def test_the_error_of_a_trial_is_that_of_all_its_outputs(turn):
    run, tabs = turn.before.run.result, texts(turn.before)["tabs"]
    check = next(trial for trial in run.trials if trial.use == "check")
    assert f"held out {wording.percent(run.fit.eps_rmsn_check)}" in tabs
    sizes = check.eps_rmsn.values()
    assert math.sqrt(sum(e**2 for e in sizes) / len(sizes)) == pytest.approx(run.fit.eps_rmsn_check)


# --- the rows one acts on -----------------------------------------------------------------------


def test_each_candidate_has_its_add_and_each_effect_its_drop(turn):
    parts = read(turn.before)
    assert {f"Add {name}" for name in TRIED} <= set(parts["missing"].values("aria-label"))
    for name in turn.before.pipeline.model.effects:
        assert f"Drop {name}" in parts["model"].values("aria-label")
    offered = [v for t, n, v in parts["missing"].attributes if (t, n) == ("option", "value")]
    assert set(offered) == set(turn.before.catalogue) - set(turn.before.pipeline.model.effects)


def test_what_is_added_cannot_be_added_again_while_the_ranking_is_old(turn):
    names = read(turn.fitted)["missing"].values("aria-label")
    assert f"Add {ADDED}" not in names
    assert f"Drop {ADDED}" in read(turn.fitted)["model"].values("aria-label")


def test_a_parameter_shows_what_the_pipeline_says_of_it(tmp_path):
    said = "\nbounds = { Nr = [-0.02, inf] }\npriors = { Ndelta = { mean = 0.0015, std = 0.001 } }"
    pipeline = PIPELINE.replace('outputs = ["r"]', f'outputs = ["r"]{said}')
    values = "\n[model.values]\nYv = -0.0125\n[identify]"
    recipe = load(write_folder(tmp_path, pipeline.replace("\n[identify]", values)))
    shown = Shown(recipe, available(recipe))
    part = read(shown)["model"]
    fields = {
        dict(each)["aria-label"]: dict(each).get("value", "")
        for each in _elements(screen.parts(shown)["model"], "input")
    }
    assert fields["Nr, lower bound"] == "-0.02"
    assert fields["Nr, upper bound"] == ""
    assert fields["Yv, value"] == "-0.0125"
    assert fields["Yr, value"] == ""
    assert "given here" in part.text
    assert "prior 0.001500 ± 0.0010" in part.text
    ticked = re.findall(r'aria-label="(\w+) free" checked', screen.parts(shown)["model"])
    assert ticked == ["Nr", "Ndelta"]


def _elements(html, tag):
    found = []

    class Each(HTMLParser):
        def handle_starttag(self, name, attrs):
            if name == tag:
                found.append(attrs)

    Each().feed(html)
    return found


def test_an_effect_nobody_knows_is_told_of(tmp_path):
    recipe = load(write_folder(tmp_path, PIPELINE.replace('"linear_roll"]', '"linear_rol"]')))
    text = texts(Shown(recipe, available(recipe)))["model"]
    assert "The catalogue has no effect of this name." in text


# --- verdicts, and what is not there ------------------------------------------------------------


@pytest.mark.parametrize("kind", report.VERDICTS)
def test_all_four_verdicts(turn, kind):
    effect = ADDED if kind == "missing" else None
    sentence = f"a sentence about {kind}: 5% of it"
    verdict = {"kind": kind, "effect": effect, "sentence": sentence, "family": []}
    shown = with_result(turn.before, verdict=verdict, where=())
    part = screen.parts(shown)["verdict"]
    text = Reader(part).text
    assert report.VERDICTS[kind] in text
    assert wording.prose(sentence) in text
    assert f'class="verdict {kind.replace(" ", "-")}"' in part
    assert screen.facts(shown)["verdict"] == kind
    assert ('class="candidate named"' in screen.parts(shown)["missing"]) == (kind == "missing")


def test_no_trial_held_out(tmp_path):
    shown = opened(write_folder(tmp_path, PIPELINE))
    parts = texts(shown)
    assert "no trial is held out" in parts["error"]
    assert "held out" not in parts["tabs"]
    assert screen.facts(shown)["eps_rmsn_check"] is None
    assert "No effect of the catalogue was tried" in parts["missing"]


def test_sensors_alone(tmp_path):
    pipeline = tmp_path / "two_rates.toml"
    text = TWO_RATES.read_text(encoding="utf-8")
    pipeline.write_text(f'{text}\n[diagnose]\ncandidates = "none"\n', encoding="utf-8")
    write_logs(tmp_path, [])
    shown = opened(pipeline)
    parts = texts(shown)
    assert wording.percent(shown.run.result.fit.eps_rmsn) in parts["error"]
    assert "reference_rate" in parts["model"]
    assert "rigid body" not in parts["model"]
    assert screen.panels(shown, 0)["name"] == "figure of eight"


# --- names are text -----------------------------------------------------------------------------


def test_hostile_names_in_a_pipeline_stay_text(tmp_path):
    pipeline = PIPELINE.replace('name = "zigzag"', f'name = "{HOSTILE}"')
    shown = with_channel(opened(write_folder(tmp_path, f'name = "{HOSTILE}"\n{pipeline}')), HOSTILE)
    parts = read(shown)
    assert {HOSTILE} <= set(parts["tabs"].values("data-trial"))
    for name in ("title", "tabs", "where"):
        assert HOSTILE in parts[name].text, name
    assert all("script" not in part.tags for part in parts.values())
    assert "<script>alert" not in screen.page(shown)
    assert screen.panels(shown, 0)["name"] == HOSTILE


def with_channel(shown, channel):
    """The same, the yaw rate read from another channel: no CSV may hold such a name."""
    trial = shown.pipeline.trials[0]
    source = trial.signals["r"].model_copy(update={"channel": channel})
    trial = trial.model_copy(update={"signals": {**trial.signals, "r": source}})
    return replace(shown, pipeline=shown.pipeline.model_copy(update={"trials": (trial,)}))


def test_hostile_effects_and_words_stay_text(turn):
    """Every word of the result that is no key of the screen's own is set to markup."""
    own = {"schema", "kind", "output", "verdict", "step", "use", "form", "unit", "trial", "signal",
           "method"}  # fmt: skip

    def spoilt(value, key=""):
        match value:
            case dict():
                return {k: spoilt(v, k) for k, v in value.items()}
            case list() | tuple():
                return [spoilt(each, key) for each in value]
            case str() if key not in own:
                return HOSTILE
            case _:
                return value

    own_trials = turn.after.run.result.trials
    result = spoilt(plain(turn.after.run.result)) | {"not_tried": {HOSTILE: HOSTILE}}
    result = replace(result_of(result), trials=own_trials)
    edited = turn.after.pipeline.model.model_copy(update={"effects": (HOSTILE,)})
    recipe = turn.after.pipeline.model_copy(update={"model": edited})
    shown = replace(turn.after, pipeline=recipe, run=replace(turn.after.run, result=result))
    parts = read(shown)
    assert all("script" not in part.tags for part in parts.values())
    assert HOSTILE in parts["missing"].text
    assert f"Drop {HOSTILE}" in parts["model"].values("aria-label")
    assert HOSTILE in parts["verdict"].text


# --- curves -------------------------------------------------------------------------------------


def decoded(text):
    return np.frombuffer(base64.b64decode(text), dtype="<f4")


def test_the_model_before_stands_beside_only_where_the_model_was_changed(turn):
    for index, trial in enumerate(turn.after.series):
        assert not any("before" in p for p in screen.panels(turn.before, index)["panels"])
        outputs = [p for p in screen.panels(turn.after, index)["panels"] if p["kind"] == "output"]
        old = turn.before.series[index]
        assert old.name == trial.name
        for panel, output in zip(outputs, old.outputs, strict=True):
            assert decoded(panel["before"]) == pytest.approx(
                np.rad2deg(output.predicted), rel=1e-6, abs=1e-9
            )
    same = replace(turn.before, before=turn.before.run)
    assert not any("before" in panel for panel in screen.panels(same, 0)["panels"])


def test_curves_of_a_model_that_is_not_fitted_are_open(turn):
    panels = screen.panels(turn.opening, 0)["panels"]
    outputs = [panel for panel in panels if panel["kind"] == "output"]
    assert all(np.isnan(decoded(panel["predicted"])).all() for panel in outputs)
    assert all(panel["stretches"] == [] and panel["noise"] is None for panel in outputs)
    json.dumps(panels, allow_nan=False)


def test_a_tab_knows_the_place_of_its_curves(turn):
    order = [trial.name for trial in turn.before.series]
    part = read(turn.before)["tabs"]
    assert part.values("data-trial") == order
    assert part.values("data-place") == [str(k) for k in range(len(order))]
