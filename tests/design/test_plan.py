"""A design file carried out, from its wishes to a plan or to the limit that binds."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from trialid.design.search import score
from trialid.effects import CATALOGUE
from trialid.errors import DesignError, PipelineError
from trialid.pipeline_file.design_file import load_design
from trialid.workflow.design.design_run import largest_error, plan
from trialid.workflow.design.plan_data import plain

ROOT = Path(__file__).parents[2]
SHIPPED = sorted((ROOT / "pipelines").glob("design_*.toml"))
HEAD = """
name = "small"
ship = "s175q.toml"
noise = { r = 0.05, phi = 0.1 }
[model]
states = ["v", "p", "r", "phi"]
effects = ["linear_hull", "linear_rudder", "linear_roll", "heel_roll"]
[identify]
free = ["Nv", "Nr", "Ndelta"]
outputs = ["r", "phi"]
nuisance = []
[at_sea]
approach = 20.0
[search]
candidates = 30
seed = 3
"""
ZIGZAG = """
[[test]]
name = "zig-zag"
kind = "zigzag"
duration = 250.0
set = { angle = 10.0, heading = 10.0 }
"""
STAIRS = """
[[test]]
name = "stairs"
kind = "modified_spiral"
duration = 250.0
open = { angles = [-20.0, 20.0], period = [60.0, 200.0] }
steps = 3
"""


@pytest.fixture
def planned(tmp_path):
    shutil.copy(ROOT / "sample_data" / "ships" / "s175q.toml", tmp_path)

    def run(*parts, progress=lambda words, share: None):
        path = tmp_path / "design.toml"
        path.write_text("\n".join(parts), encoding="utf-8")
        return plan(load_design(path), progress)

    return run


def test_tests_are_rated_and_open_ones_chosen(planned):
    done = planned(HEAD, ZIGZAG, STAIRS)
    fixed, found = done.rated
    assert fixed.found is None
    assert found.found.tried <= 30
    assert len(found.programme[0].values["angles"]) == 3
    assert done.best.name == min(done.rated, key=lambda r: largest_error(r, done.ship.goal)).name
    assert planned(HEAD, ZIGZAG, STAIRS).rated[1].programme == found.programme


@pytest.mark.parametrize("criterion", ["error", "S_imin", "R", "D", "A"])
def test_the_best_is_so_by_the_criterion_asked_for_and_progress_says_it(planned, criterion):
    head = HEAD.replace("[search]", f'[search]\ncriterion = "{criterion}"')
    told = []
    done = planned(head, ZIGZAG, STAIRS, progress=lambda words, share: told.append(words))
    by = {r.name: score(r.outcome.rating, criterion, done.ship.goal.wanted) for r in done.rated}
    assert done.best.name == min(by, key=by.get)
    shown = {"error": "largest error", "S_imin": "least S_imin", "R": "R", "D": "log volume",
             "A": "mean error"}[criterion]  # fmt: skip
    words = told[-1]
    assert words.startswith(f"stairs: {done.rated[1].found.tried} candidates, {shown} ")
    rating = done.rated[1].outcome.rating
    if criterion == "R":
        assert words.endswith(f"R {rating.R:.3g}")
    if criterion == "S_imin":
        assert words.endswith(f"{min(rating.of(n).S_imin for n in done.ship.goal.wanted):.3g}")


def test_together_is_one_programme_better_than_each_of_its_tests(planned):
    [both] = planned("together = true", HEAD, ZIGZAG, STAIRS).rated
    assert [t.name for t in both.programme] == ["zig-zag", "stairs"]
    [alone] = planned(HEAD, ZIGZAG).rated
    for name in ("Nv", "Nr", "Ndelta"):
        assert both.outcome.rating.of(name).error < alone.outcome.rating.of(name).error


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ("rudder = 3.0", "no test of this kind keeps the limits; rudder binds: "),
        ("rudder_rate = 2.5\nheel = 0.1", "heel binds: "),
        ("room = [60.0, 100.0, 100.0]", "room ahead binds: "),
        ("duration = 200.0", "duration binds: it takes 250 s, 200 s are allowed"),
    ],
)
def test_an_impossible_wish_names_its_test_and_the_limit_that_binds(planned, limits, words):
    wish = STAIRS.replace("[-20.0, 20.0]", "[10.0, 20.0]")
    with pytest.raises(DesignError, match=f"design.toml: test 'stairs': .*{words}") as caught:
        planned(HEAD, "[limits]", limits, wish)
    assert "\n" not in str(caught.value)


def test_a_fixed_test_beyond_a_limit_is_not_rated_and_never_the_best(planned):
    done = planned(HEAD, "[limits]\nrudder = 5.0", ZIGZAG)
    assert done.rated[0].outcome.rating is None
    assert done.rated[0].outcome.excesses[0].limit == "rudder"
    assert done.best is None
    told = plain(done)["tests"][0]
    assert told["feasible"] is False
    assert "10 deg of rudder are ordered, 5 are allowed" in told["limits"][0]["sentence"]


def test_a_test_that_moves_nothing_is_told_by_its_name(planned):
    still = ZIGZAG.replace("angle = 10.0", "angle = 0.0")
    with pytest.raises(DesignError, match="test 'zig-zag': the test moves too little to find"):
        planned(HEAD, still)


def test_a_limit_of_a_motion_that_is_not_simulated_is_refused(planned):
    with pytest.raises(PipelineError, match=r"design.toml: limits\.speed_loss: u is not simulated"):
        planned(HEAD, "[limits]\nspeed_loss = 0.3", ZIGZAG)


BUSY = """
[[test]]
name = "busy"
kind = "square_wave"
duration = 250.0
set = { angle = 20.0, period = 12.0 }
"""


def test_a_rudder_rate_the_gear_cannot_do_binds_or_is_said(planned):
    """20 deg to either side every 6 s: 40 deg in 6 s are 6.67 deg/s."""
    [limited] = planned(HEAD, "[limits]\nrudder_rate = 5.0", BUSY).rated
    assert [e.limit for e in limited.outcome.excesses] == ["rudder rate"]
    sentence = limited.outcome.excesses[0].sentence
    assert sentence.startswith("6.67 deg/s of rudder are asked for, 5 are allowed")
    [free] = planned(HEAD, BUSY).rated
    assert free.outcome.rating is not None
    [remark] = free.remarks
    assert remark.startswith("the rudder does not reach 38 of 39 orders before the next")
    [slow] = planned(HEAD, "[limits]\nrudder_rate = 5.0", BUSY.replace("12.0", "60.0")).rated
    assert slow.outcome.excesses == ()
    assert slow.remarks == ()


def test_a_parameter_the_outputs_cannot_see_is_refused(planned):
    head = HEAD.replace('"heel_roll"]', '"heel_roll", "bias_phi"]')
    head = head.replace('"Ndelta"]', '"Ndelta", "b_phi"]').replace('["r", "phi"]', '["r"]')
    with pytest.raises(DesignError, match="test 'zig-zag': outputs r cannot see b_phi beside"):
        planned(head, ZIGZAG)


def test_a_free_parameter_that_nobody_states_is_as_large_as_typical(planned):
    head = HEAD.replace('"heel_roll"]', '"heel_roll", "yaw_cubic_vvv"]')
    rating = planned(head.replace('"Ndelta"]', '"Ndelta", "Nvvv"]'), ZIGZAG).rated[0].outcome.rating
    assert rating.of("Nvvv").value == CATALOGUE["yaw_cubic_vvv"].parameters["Nvvv"].start


def test_effects_and_values_that_do_not_exist_are_told_with_their_key(planned):
    for table, key in (
        ('[full]\neffects = ["heel_yawn"]', r"full\.effects\[0\]"),
        ("[full]\nvalues = { Nrr = 1.0 }", r"full\.values\.Nrr"),
        ('[separate]\neffects = ["bias_r", "steady_winds"]', r"separate\.effects\[1\]"),
    ):
        with pytest.raises(PipelineError, match=rf"design.toml: {key}: .*; "):
            planned(HEAD, table, ZIGZAG)


def test_what_the_ship_has_beyond_the_model_shows_as_bias(planned):
    plain_one = planned(HEAD, ZIGZAG).rated[0].outcome.rating
    full = planned(HEAD, '[full]\neffects = ["yaw_drag_rar"]', ZIGZAG).rated[0].outcome.rating
    assert plain_one.undermodelling < 1e-9
    assert full.undermodelling > 1e-3
    assert abs(full.of("Nr").bias) > 1e-4
    assert full.of("Nr").error > full.of("Nr").noise_error


def test_several_plausible_ships_are_drawn_by_their_seed(planned):
    ships = "[ships]\ncount = 3\nspread = 0.3\nover = {over}\nseed = {seed}\n"
    mean, worst, other = (
        planned(HEAD, ships.format(over=json.dumps(over), seed=seed), STAIRS)
        for over, seed in (("mean", 1), ("worst", 1), ("worst", 2))
    )
    assert worst.rated[0].found.score != other.rated[0].found.score
    assert worst.rated[0].found.score >= mean.rated[0].found.score
    known = planned(HEAD, STAIRS).rated[0]
    assert worst.rated[0].found.score > known.found.score


RIVALS = '[separate]\neffects = ["rudder_offset", "bias_r"]'


def test_rivals_are_told_apart_by_what_is_open_and_compared_with_what_is_not(planned):
    done = planned(HEAD, RIVALS, ZIGZAG, STAIRS)
    found = done.separation
    assert [t.name for t in found.programme] == ["stairs"]
    assert found.before is not None
    assert done.rated[1].programme == found.programme
    assert done.rated[1].found is None
    fixed = planned(HEAD, RIVALS, ZIGZAG).separation
    assert fixed.programme == ()
    assert fixed.after == found.before
    with pytest.raises(DesignError, match=r"design.toml: separate: no test .*; rudder binds: "):
        planned(HEAD, RIVALS, "[limits]\nrudder = 1.0", STAIRS.replace("-20.0,", "10.0,"))


def test_a_plan_is_plain_data(planned):
    told = plain(planned(HEAD, RIVALS, ZIGZAG, STAIRS))
    again = json.loads(json.dumps(told, allow_nan=False))
    assert again["schema"] == "trialid-design/1"
    assert again["separation"]["cosine_before"] == told["separation"]["cosine_before"]
    assert again["tests"][1]["programme"][0]["units"]["angles"] == "deg"
    assert np.abs(again["tests"][1]["programme"][0]["numbers"]["angles"]).max() <= 20.0
    assert again["imo"] == []


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_shipped_design_is_carried_out(path):
    """With fewer candidates than shipped: that it runs, not how good it gets."""
    recipe = load_design(path)
    few = recipe.model_copy(
        update={
            "search": recipe.search.model_copy(update={"candidates": 6}),
            "imo": False,
            "tests": tuple(t.model_copy(update=_shorter(t)) for t in recipe.tests),
        }
    )
    done = plan(few)
    assert done.best is not None
    assert all(r.outcome.rating is not None for r in done.rated)
    assert (done.separation is None) == (recipe.separate is None)


def _shorter(test):
    return {"duration": test.duration / 2.0}
