import copy
from dataclasses import replace

import pytest

from trialid.names.wording import percent
from trialid.report.pictures.error_history import (
    FLOOR,
    MOST,
    OWN,
    error_history,
    interval,
    step_words,
)
from trialid.report.words.fall import fell
from trialid.result.change_rows import StepRow
from trialid.result.json_file import result_of


def grown(result, steps):
    """A history of so many steps, each a tenth better than the one before."""
    run = copy.deepcopy(result)
    first = run["history"][0] | {"undermodelling_interval": None}
    rows = [first]
    for k in range(1, steps):
        rows.append(
            first
            | {"step": "added", "added": f"an_effect_with_number_{k}"}
            | {key: first[key] * 0.9**k for key in ("eps_rmsn", "undermodelling")}
        )
    run["history"] = rows
    return result_of(run)


def height(bar):
    return FLOOR - bar.y


def test_bars_are_as_tall_as_their_parts_and_dots_stand_at_the_errors(result):
    drawn = error_history(result_of(result))
    before, after = drawn.columns
    assert height(before.model) / height(before.noise) == pytest.approx(0.0944 / 0.0841)
    assert height(after.model) / height(before.model) == pytest.approx(0.0237 / 0.0944)
    assert height(before) / height(before.noise) == pytest.approx(0.1264 / 0.0841)
    assert (FLOOR - after.check) / height(after.noise) == pytest.approx(0.0912 / 0.0838)
    assert (before.noise.number, before.error, before.check_error) == ("8.41", "12.6", "14.4")


def test_whiskers_are_the_interval_of_the_model_part(result):
    before, after = error_history(result_of(result)).columns
    top, bottom = (FLOOR - y for y in before.model.whisker)
    assert top / bottom == pytest.approx(0.0979 / 0.0907)
    assert after.model.whisker[1] == FLOOR
    assert before.noise.whisker is None


def test_an_older_history_takes_intervals_from_the_run(result):
    given = copy.deepcopy(result)
    given["before_after"]["undermodelling_interval"] = [0.0, 0.04]
    for row in given["history"]:
        row["undermodelling_interval"] = None
    run = result_of(given)
    present, proposed = run.history
    assert interval(present, run) == (0.0907, 0.0979)
    assert interval(proposed, run) == (0.0, 0.04)
    run = replace(run, history=(replace(present, eps_rmsn=0.2), *run.history))
    assert interval(run.history[0], run) is None


@pytest.mark.parametrize("steps", [1, 2, 13, 20])
def test_any_number_of_steps_is_drawn_within_the_page(result, steps):
    drawn = error_history(grown(result, steps))
    assert len(drawn.columns) == min(steps, MOST)
    assert drawn.left_out == max(steps - MOST, 0)
    assert drawn.width <= 1132
    assert drawn.width > drawn.columns[-1].x >= drawn.columns[0].x > 52
    step = (drawn.width - 64) / len(drawn.columns)
    assert all(6.7 * len(w) <= step for column in drawn.columns for w in column.words)
    assert bool(drawn.line) == (steps > 1)
    assert [OWN in column.words for column in drawn.columns].count(True) == 1


def test_an_error_not_told_apart_is_one_bar(result):
    run = copy.deepcopy(result)
    run["history"][0] |= {"noise": None, "undermodelling": None}
    first, second = error_history(result_of(run)).columns
    assert (first.noise, first.model) == (None, None)
    assert height(first.whole) == pytest.approx(height(first))
    assert second.whole is None


def test_without_errors_there_is_no_picture(result):
    given = copy.deepcopy(result)
    for row in given["history"]:
        row["eps_rmsn"] = None
    run = result_of(given)
    assert error_history(run) is None
    assert fell(run) == "No step has an error."
    assert error_history(result_of({})) is None


def test_an_error_of_zero_is_drawn(result):
    run = copy.deepcopy(result)
    keys = ("eps_rmsn", "eps_rmsn_check", "noise", "undermodelling")
    for row in run["history"]:
        row.update(dict.fromkeys(keys, 0.0), undermodelling_interval=[0.0, 0.0])
    assert {height(column) for column in error_history(result_of(run)).columns} == {0.0}


def test_what_the_picture_shows_is_said(result):
    words = fell(result_of(result)).replace("\N{NARROW NO-BREAK SPACE}", " ")
    assert "from 12.6 % to 8.71 %, held out from 14.4 % to 9.12 %" in words
    assert "the model part from 9.44 % to 2.37 %" in words
    assert "holds zero" in words
    assert "a model error below 4.12 % would not be seen" in words
    run = copy.deepcopy(result)
    run["history"][-1]["undermodelling_interval"] = [0.01, 0.04]
    assert "holds zero" not in fell(result_of(run))


def test_what_was_done_is_told_by_sign():
    known = StepRow(step="added", added="a", dropped="b")
    assert step_words(known) == "+ a"
    assert step_words(replace(known, step="dropped")) == "\N{MINUS SIGN} b"
    assert step_words(replace(known, step="as written")) == "as written"
    assert step_words(StepRow(step="added")) == "added"
    held = replace(known, added="Yv, Nvdot", effects=("a",), free=("Nr", "Yv", "Nvdot"))
    assert step_words(held) == "free Yv, Nvdot"
    assert step_words(replace(held, free=("Nr", "Yv"))) == "+ Yv, Nvdot"


def test_a_sign_stays_with_its_name(result):
    run = grown(result, 13)
    first, *others = run.history
    named = (replace(row, added="righting_arm_cubic") for row in others)
    run = replace(run, history=(first, *named))
    assert error_history(run).columns[1].words == ("+\N{NO-BREAK SPACE}righting_", "arm_cubic")


def test_errors_of_other_logs_are_not_held_against_these(result):
    run = grown(result, 4)
    first, second, third, last = run.history
    ours = [replace(row, logs=("b", "a")) for row in (third, last)]
    run = replace(run, history=(first, replace(second, logs=("c",)), *ours))
    assert run.comparable == run.history[2:]
    words = fell(run)
    assert f"goes from {percent(third.eps_rmsn)} to {percent(last.eps_rmsn)}" in words
    assert words.endswith("2 earlier steps had other logs, and other errors for it.")
    assert len(error_history(run).columns) == 2
    proposed = replace(run, history=(replace(last, step="proposed"),))
    assert proposed.comparable == ()  # an edited file: of what it is proposed nobody knows
    other_way_round = replace(run, history=(replace(third, logs=("a", "b")), ours[1]))
    assert len(other_way_round.comparable) == 2
