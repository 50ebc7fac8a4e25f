"""Several runs on one page: what differs, whether beyond the joint errors, and names as text."""

import copy
import math

import pytest
from test_page import HOSTILE, Reader

from trialid.report.pages import side_by_side
from trialid.report.tables import run_tables
from trialid.report.tables.rounded_table import Figure
from trialid.result.json_file import result_of


@pytest.fixture
def other(result):
    """The same ship once more: one parameter elsewhere, one effect more, another verdict."""
    run = copy.deepcopy(result)
    first, second = run["accuracy"]["parameters"][:2]
    first["value"] += 5.0 * math.hypot(first["standard_error"], first["standard_error"])
    second["standard_error"] = None
    run["model"]["effects"] = [*run["model"]["effects"], "yaw_drag_rar"]
    run["verdict"] = {"kind": "nothing missing", "effect": None, "family": [], "sentence": "None."}
    return run


def made(result, other):
    runs = side_by_side.shown_runs({"a": result_of(result), "b": result_of(other)})
    return {table.name: table for table in side_by_side.tables(runs)}


def test_a_parameter_beyond_the_joint_errors_is_told(result, other):
    rows = made(result, other)["parameters"].rows
    first, second, third = rows[:3]
    assert isinstance(first[3], Figure)
    assert first[3].value == pytest.approx(5.0)
    assert (first[2], second[2], third[2]) == ("by more than noise", "cannot tell", "no")
    assert third[3] == Figure(0.0, 2)


def test_a_parameter_of_one_run_only_has_no_difference(result, other):
    gone = other["accuracy"]["parameters"].pop(2)["name"]
    row = next(row for row in made(result, other)["parameters"].rows if row[0] == gone)
    assert row[2] == "in one run"


def test_errors_verdicts_and_models_stand_side_by_side(result, other):
    other["where"] = []  # of the one whose effect is missing
    tables = made(result, other)
    assert tables["errors"].headings[1:] == ("a", "b")
    assert [row[3] for row in tables["verdicts"].rows][1].startswith("Nothing is missing")
    assert tables["models"].rows == (("effect yaw_drag_rar", "no", "yes"),)
    fitted = tables["errors"].rows[0]
    assert fitted[1].value == pytest.approx(100.0 * result["fit"]["eps_rmsn"])


def test_what_is_simulated_fitted_and_which_ship_it_is_stands_in_the_models(result, other):
    other["model"]["states"] = [*other["model"]["states"], "u"]
    result["model"]["outputs"], other["model"]["outputs"] = ["r", "phi"], ["r"]
    result["model"]["ship"], other["model"]["ship"] = "a tanker", "a boat of 2.4 m"
    rows = {row[0]: row[1:] for row in made(result, other)["models"].rows}
    assert rows["simulated u"] == ("no", "yes")
    assert rows["fitted phi"] == ("yes", "no")
    assert rows["ship a boat of 2.4 m"] == ("no", "yes")
    assert rows["ship a tanker"] == ("yes", "no")


def test_a_run_without_a_fit_differs_in_nothing_that_can_be_told(result, other):
    gone = other["accuracy"]["parameters"].pop(2)["name"]
    other["verdict"]["kind"] = "no fit"
    for row in made(result, other)["parameters"].rows:
        if row[0] == gone:  # it has none, and says nothing of it
            assert row[2] == "in one run"
        else:
            assert row[2:4] == ("cannot tell: no fit", Figure(None))


def test_what_was_only_proposed_is_not_shown_as_done(result, other):
    result["history"][-1] |= {"step": "proposed", "added": "cross_flow_drag"}
    other["history"][-1] |= {"step": "added", "added": "cross_flow_drag"}
    done = [row[2] for row in made(result, other)["history"].rows if "cross_flow" in row[2]]
    assert done == ["+ cross_flow_drag (proposed, not in the file)", "+ cross_flow_drag"]


def test_stacked_tables_hold_every_row_of_both(result, other):
    tables = made(result, other)
    for each in run_tables.tables(result_of(result)):
        if each.name in side_by_side.STACKED:
            own = [row for row in tables[each.name].rows if row[0] == "a"]
            assert [row[1 : 1 + len(row)] for row in own] == list(each.rows)


def test_the_page_is_well_formed_and_asks_the_network_for_nothing(result, other):
    html = side_by_side.page(
        side_by_side.shown_runs({"a": result_of(result), "b": result_of(other)})
    )
    read = Reader(html)
    ids = [value for _, name, value in read.attributes if name == "id"]
    assert len(set(ids)) == len(ids)
    links = [value for tag, name, value in read.attributes if (tag, name) == ("a", "href")]
    assert {link.removeprefix("#") for link in links} <= set(ids)
    assert "script" not in read.tags
    assert "://" not in html
    assert "share" in read.text  # the two rest on the same logs
    assert len([c for c in read.tags if c == "section"]) == len(made(result, other))


def test_hostile_names_are_text(result, other):
    other["accuracy"]["parameters"][0]["name"] = HOSTILE
    other["model"]["effects"] = [HOSTILE]
    other["pipeline"] = HOSTILE
    read = Reader(
        side_by_side.page(
            side_by_side.shown_runs({HOSTILE: result_of(result), "b": result_of(other)})
        )
    )
    assert "script" not in read.tags
    assert "img" not in read.tags
    assert read.text.count(HOSTILE) > 3


def test_nothing_known_still_makes_tables(result):
    assert made({}, result)["verdicts"].rows[0][0] == "a"
    assert made({}, {})["verdicts"].rows[1][3] == "No verdict"


MORE = "by more than noise"


@pytest.mark.parametrize(("errors", "word"), [(1.9, "no"), (2.0, MORE), (2.9, MORE)])
def test_values_differ_from_two_joint_errors_on(result, other, errors, word):
    """At 95 % for one pair: 1.96 of the root of both squared; what a model lacks moves them too."""
    first, again = (run["accuracy"]["parameters"][0] for run in (result, other))
    again["value"] = first["value"] + errors * math.hypot(
        first["standard_error"], again["standard_error"]
    )
    row = made(result, other)["parameters"].rows[0]
    assert row[3].value == pytest.approx(errors)
    assert row[2] == word


@pytest.mark.parametrize(("gap", "word"), [(-0.1, MORE), (0.1, "yes")])
def test_they_differ_whatever_is_missing_where_their_ranges_lie_apart(result, other, gap, word):
    first, again = (run["accuracy"]["parameters"][0] for run in (result, other))
    low, high = first["likely"]
    again["value"] = first["value"] + (1.0 + gap) * (high - low)
    again["likely"] = [low + (1.0 + gap) * (high - low), high + (1.0 + gap) * (high - low)]
    assert made(result, other)["parameters"].rows[0][2] == word
