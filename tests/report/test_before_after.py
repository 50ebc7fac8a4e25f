"""An effect added or dropped, on the page and on a terminal."""

import copy
from dataclasses import replace

import pytest
from rich.console import Console
from test_page import known_without

from trialid.report.pages.page import page
from trialid.report.terminal.before_after import before_after
from trialid.report.terminal.steps import line, rows
from trialid.result.change_rows import StepRow
from trialid.result.json_file import result_of
from trialid.result.schema import Result

WANTED = {"effect", "equation", "by_output", "by_output_check", "parameters", "verdict", "named",
          "taken_out"}  # fmt: skip
"""Of a change, what the schema wants; the rest may be unknown."""


def _row(name, before, after, move, foreseen):
    both = before is not None and after is not None
    return {
        "name": name, "unit": "rad", "before": before, "after": after,
        "standard_error": 0.01, "standard_error_before": 0.02 if before is not None else None,
        "move": move, "move_in_errors": move / 0.02 if both else None,
        "move_foreseen": foreseen if both else None,
        "after_foreseen": foreseen if before is None else None,
    }  # fmt: skip


@pytest.fixture
def changed(result):
    """The made-up run with a change of its model before it."""
    run = copy.deepcopy(result)
    run["change"] = {
        "step": "added", "effect": "static_list", "equation": "K = rho g nabla a_0.",
        "eps_rmsn": [0.2, 0.1264], "eps_rmsn_check": [0.3, 0.31],
        "by_output": {"r": [0.18, 0.1083], "phi": [0.22, 0.1422]},
        "by_output_check": {"r": [0.28, 0.29]}, "noise": [0.084, 0.0841],
        "undermodelling": [0.18, 0.0944], "undermodelling_interval": None,
        "verdict": ["missing", "nothing missing"], "named": ["static_list", None],
        "eps_rmsn_foreseen": 0.1311, "not_foreseen": None, "taken_out": ["model.values.a_0 = 2.0"],
        "parameters": [_row("GM", 0.1, 0.2, 0.1, 0.08), _row("a_0", None, 0.3, None, 0.25)],
    }  # fmt: skip
    return run


def shown(run, width=80):
    console = Console(width=width, color_system=None)
    with console.capture() as capture:
        console.print(before_after(result_of(run)))
    return capture.get()


def test_what_was_done_comes_before_what_is_proposed(changed, series):
    text = page(result_of(changed), series[:1])
    done, ahead = text.index("Before and after adding"), text.index("What adding this would change")
    assert done < ahead
    for words in ("static_<wbr>list", "+5.0", "model.values.a_0 = 2.0", "nothing missing"):
        assert words in text[done:ahead]
    changed["change"]["step"] = "dropped"
    assert "Before and after dropping" in page(result_of(changed), series[:1])


def test_a_change_of_which_little_is_known(changed, series):
    for key in changed["change"]:
        run = copy.deepcopy(changed)
        run["change"][key] = None
        known = known_without(run, key)
        assert (known is None) == (key in WANTED), key
        if known is not None:
            assert "None" not in page(known, series[:1]), key
            assert "None" not in shown(run), key
    for key in changed["change"]["parameters"][0]:
        run = copy.deepcopy(changed)
        for row in run["change"]["parameters"]:
            row[key] = None
        known = known_without(run, key)
        assert (known is None) == (key in ("name", "unit")), key
        if known is not None:
            assert "None" not in page(known, series[:1]), key
            assert "None" not in shown(run), key


@pytest.mark.parametrize("width", [80, 120])
def test_side_by_side_fits_a_terminal(changed, width):
    text = shown(changed, width)
    assert max(map(len, text.splitlines())) <= width
    words = " ".join(text.split())
    for part in (
        "static_list added", "fitted trials all 20.0 % 12.6 %", "held-out trials all 30.0 % 31.0 %",
        "Verdict: missing (static_list) -> nothing missing; the held-out error does not fall",
        "foreseen by linearisation: error 13.1 %, fitted 12.6 %; a_0 14.3, fitted 17.2 deg",
        "+5.0 +4.0", "new",
    ):  # fmt: skip
        assert part in words


@pytest.mark.parametrize(
    ("after", "said"),
    [(0.305, "does not fall"), (0.2999, "hardly falls"), (0.29, None)],
)
def test_of_what_changes_nothing_no_trial_speaks(changed, after, said):
    """An outsider's useless effect took 5.040 % to 5.039, and no word was said."""
    run = copy.deepcopy(changed)
    run["change"]["eps_rmsn_check"] = [0.3, after]
    words = " ".join(shown(run).split())
    assert (f"; the held-out error {said}: no trial speaks for this effect" in words) is bool(said)
    assert ("no trial speaks" in words) is bool(said)


def test_a_long_history_shows_its_end():
    step = StepRow(step="added", added="x", eps_rmsn=0.1, verdict="cannot tell")
    run = Result(history=tuple(replace(step, added=f"e{k}") for k in range(20)))
    lines = list(rows(run))
    assert len(lines) == 10
    assert lines[1] == "... 12 earlier steps"
    assert lines[-1].startswith("+ e19 ")
    tried = replace(step, step="proposed")
    assert list(rows(Result(history=(step, tried)))) == [lines[0], line(step)]
    own = Result(history=(step, replace(step, logs=("another",))))
    assert list(rows(own))[1] == "... 1 earlier step on other logs"


def test_what_to_do_next_stands_below_the_verdict(changed):
    """After `trialid add` nobody was told of the next effect."""
    changed["verdict"] |= {"kind": "missing", "effect": "roll_cubic", "sentence": "it is missing"}
    console = Console(width=80, color_system=None)
    with console.capture() as capture:
        console.print(before_after(result_of(changed), "p.toml"))
    assert "Next: trialid add p.toml roll_cubic" in capture.get()
    assert "Next: " not in shown(changed)
