"""What is told beside the parameters: values at a bound, what widens a range, the search."""

import copy
import html

from rich.console import Console

from trialid.report.pages.page import page
from trialid.report.terminal.summary import summary
from trialid.result.json_file import result_of


def words(result):
    """What the terminal shows, unbroken."""
    console = Console(width=80, color_system=None)
    with console.capture() as capture:
        console.print(summary(result_of(result), lines=60))
    return " ".join(capture.get().split())


def test_a_value_at_its_bound_is_told_beside_the_table(result):
    run = copy.deepcopy(result)
    assert "at its bound" not in words(run)
    run["fit"]["remarks"] = ["Kp ended at its bound -6e-06"]
    assert " Kp ended at its bound -6e-06." in words(run)


def test_without_a_fit_no_effect_is_said_to_be_missing(result):
    run = copy.deepcopy(result)
    row = next(r for r in run["accuracy"]["parameters"] if r["kind"] == "physical")
    row |= {"value": 1.0, "likely": [-1e6, 1.2], "widened_by": "static_list"}
    assert "as static_list may be missing" in words(run)
    run["verdict"]["kind"] = "no fit"
    assert "static_list" not in words(run)


def test_what_the_search_did_and_a_value_at_its_bound_are_told(result, series):
    run = copy.deepcopy(result)
    run["fit"] |= {"remarks": ["Kp ended at its bound"], "search": ["one start", "went further"]}
    said = " ".join(html.unescape(page(result_of(run), series)).split())
    assert "Kp ended at its bound" in said
    assert "The search: one start; went further." in said
