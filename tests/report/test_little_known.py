"""Pages of runs of which little is known: one effect, no fit, her roll alone, two names at once."""

import copy
import html
import re
from dataclasses import replace

import pytest

from trialid.names.wording import THIN
from trialid.report.pages.page import page
from trialid.report.pictures.error_history import LINE, error_history
from trialid.report.tables.use_tables import commands, kinds_of
from trialid.report.words.advice import first_step
from trialid.report.words.doubt import trust
from trialid.report.words.fall import fell
from trialid.result.fit_rows import ModelPart
from trialid.result.json_file import result_of


def words_of(run):
    """A page as text, blanks alike."""
    body = page(result_of(run), ()).partition("<body>")[2].partition("<script>")[0]
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", body)).replace(THIN, " ").split())


def changed(result, **parts):
    run = copy.deepcopy(result)
    for key, part in parts.items():
        run[key] = run[key] | part if isinstance(part, dict) else part
    return run


NO_FIT = {"kind": "no fit", "effect": None, "sentence": "no fit: she never moves; check the logs"}


def test_one_is_one_wherever_it_is_counted(result):
    step = result["history"][0] | {"effects": ["linear_roll"], "free": ["Kp"]}
    signals = [{"trial": "a", "signal": "r", "channel": "rot"}]
    run = changed(result, history=[step], missing=result["missing"][:1], signals=signals)
    said = words_of(run)
    for one in ("1 effect, 1 free parameter", "1 effect of the catalogue", "1 signal, and the"):
        assert one in said
    assert not re.search(
        r"(?<![\d.,])1 (effects|signals|free parameters|remarks|questions)\b", said
    )


def test_no_fit_says_nothing_of_the_ship(result):
    run = changed(result, verdict=NO_FIT, missing=[])
    said = words_of(run)
    assert "Directional stability" not in said
    assert "No effect of the catalogue" in said
    assert trust(result_of(run)) == ""


def test_she_is_stable_or_not_as_far_as_the_record_tells(result):
    run = copy.deepcopy(result)
    levers = run["accuracy"]["stability"]
    levers |= {"stable": True, "likely": [0.0312, 0.21]}
    assert "Stable." in words_of(run)
    assert "likely 0.031 to 0.21" in words_of(run)
    levers["stable"] = False
    assert "Unstable." in words_of(run)
    levers |= {"stable": None, "likely": None}
    assert "to 0.21" not in words_of(run)
    assert "Stable or not: this record does not tell" in words_of(run)


def test_best_known_is_nothing_that_may_be_off_by_all(result):
    run = result_of(result)
    assert trust(run).startswith("Best known is ")
    wide = [replace(r, likely=(-9.0, 9.0)) for r in run.accuracy.parameters if r.kind != "nuisance"]
    spoilt = replace(run, accuracy=replace(run.accuracy, parameters=tuple(wide)))
    assert not trust(spoilt).startswith("Best known")


@pytest.mark.parametrize(
    ("model", "has", "lacks"),
    [
        (ModelPart(states=("p", "phi"), inputs=("u",)), "--as ship", ("simulate", "nomoto", "pid")),
        (
            ModelPart(states=("v", "r"), inputs=("rudder_port", "rudder_starboard", "u")),
            "simulate . orders.csv",
            ("zigzag", "nomoto", "ardupilot"),
        ),
        (ModelPart(states=("v", "r"), inputs=("delta", "u")), "zigzag 20 20", ("stop",)),
    ],
)
def test_commands_are_those_that_the_model_answers(result, model, has, lacks):
    """Of a roll decay a zig-zag and an autopilot's gains were offered, and refused."""
    given = " ".join(row.command for row in commands(replace(result_of(result), model=model)))
    assert has in given
    assert not [word for word in lacks if word in given]
    assert ("pid" in kinds_of(model)) == ("pid" in given)


@pytest.mark.parametrize(("test", "said"), [("circle", "Next trial"), (None, "No next trial")])
def test_the_first_screen_has_the_command_and_the_next_trial(result, test, said):
    """`Run this trial next: no feasible test separates a from b` was said."""
    planned = {"sentence": "turning circle at 35 deg: a and b come apart", "test": test}
    run = changed(result, verdict={"kind": "missing", "effect": "b", "next_trial": planned})
    first = words_of(run).partition("How well the model fits")[0]
    assert "Next: trialid add container_ship.toml b" in first
    assert f"{said}: turning circle at 35 deg" in first
    assert ("No next trial" in first) == (test is None)
    assert first_step(result_of(run)).command == "trialid add container_ship.toml b"


def test_two_that_are_named_together_are_not_called_none(result):
    both = {"kind": "cannot tell", "effect": None, "together": ["rudder_cubic", "wind_yaw"]}
    said = words_of(changed(result, verdict=both, before_after=None))
    assert "no effect is named" not in said
    assert "none alone; together rudder_ cubic , wind_ yaw" in said


def test_a_fall_proves_no_more_than_what_is_known(result):
    assert "leaves the noise part as it was" in fell(result_of(result))
    run = copy.deepcopy(result)
    for row in run["history"]:
        row |= {"noise": None, "undermodelling": None}
    assert fell(result_of(run)).endswith("The right effect lowers the held-out error too.")
    for row in run["history"]:
        row["eps_rmsn_check"] = None
    assert "a fall alone does not prove" in fell(result_of(run))
    assert "noise part" not in fell(result_of(run))
    assert "noise: the sea and the sensors" not in words_of(run)


def test_numbers_stand_where_no_line_runs(result):
    """Of two that are near the upper one gives way; the one line comes from the upper left."""
    run = copy.deepcopy(result)
    first, last = run["history"][0], run["history"][-1]
    last["eps_rmsn_check"] = last["eps_rmsn"] + 0.001
    before, after = error_history(result_of(run)).columns
    assert not before.to_the_left
    assert not after.to_the_left
    assert after.label_x > after.x
    assert after.error_y - after.check_y >= LINE
    first["eps_rmsn"] = 0.5 * last["eps_rmsn"]
    before, _ = error_history(result_of(run)).columns
    assert before.to_the_left
    assert before.label_x < before.x


def test_what_is_hatched_is_explained(result):
    run = copy.deepcopy(result)
    assert "not told apart" not in words_of(run)
    run["split"] |= {"noise": None, "undermodelling": None, "by_output": {}}
    assert "not told apart error" in words_of(run)
