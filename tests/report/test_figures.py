"""Figures as SVG files: well-formed, complete, thinned without losing a peak."""

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from test_page import HOSTILE

from trialid.report.pages.page import page
from trialid.report.pictures.figures import MOST, figures, thin
from trialid.result.json_file import result_of
from trialid.result.series import OutputSeries

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def drawn(result, series):
    run = result_of(result)
    return figures(page(run, series), run, series)


def test_every_figure_of_the_page_and_every_output_has_a_file(drawn, series):
    assert {"history", "accuracy", "error", "ranking", "change"} <= set(drawn)
    assert [name for name in drawn if name.startswith("where")]
    for trial in series:
        for output in trial.outputs:
            assert f"trial-{trial.name}-{output.name}" in drawn


def test_each_is_well_formed_and_asks_for_nothing(drawn):
    for name, text in drawn.items():
        root = ElementTree.fromstring(text)
        assert root.tag == f"{SVG}svg", name
        assert text.count("http") == 1, name  # the name of the format
        assert float(root.get("width")) > 0.0


def test_bars_are_as_long_as_their_numbers(drawn, result):
    rows = [r for r in result["accuracy"]["parameters"] if r["kind"] != "nuisance"]
    rects = list(ElementTree.fromstring(drawn["accuracy"]).iter(f"{SVG}rect"))
    assert len(rects) == 3 * len(rows)  # the likely range, and what noise leaves in its middle
    below, noise, above = (float(rect.get("width")) for rect in rects[:3])
    low, high = (abs(end - rows[0]["value"]) for end in rows[0]["likely"])
    alone = 1.96 * rows[0]["standard_error"]
    assert below / noise == pytest.approx((low - alone) / (2.0 * alone), rel=0.05)
    assert above / noise == pytest.approx((high - alone) / (2.0 * alone), rel=0.05)


def test_a_gap_parts_the_lines(drawn):
    """The made trial zigzag-20 has one gap in its yaw rate."""
    lines = {}
    for each in ElementTree.fromstring(drawn["trial-zigzag-20-r"]).iter(f"{SVG}polyline"):
        lines[each.get("class")] = lines.get(each.get("class"), 0) + 1
    assert lines == {"measured": 3, "predicted": 2, "residual": 3}  # one each is the legend's


def test_thinning_keeps_every_peak():
    t = np.arange(100_000.0)
    x = np.zeros_like(t)
    x[[77, 54_321]] = 3.0, -4.0
    (piece,) = thin(t, x)
    assert len(piece) <= MOST
    assert {(77.0, 3.0), (54_321.0, -4.0)} <= set(map(tuple, piece.tolist()))
    assert (np.diff(piece[:, 0]) > 0.0).all()


def test_nothing_measured_is_no_line():
    assert thin(np.arange(3.0), np.full(3, np.nan)) == []


def test_a_hostile_name_is_text(result, series):
    trial = series[0]
    output = OutputSeries(HOSTILE, trial.t, trial.t, trial.t > 10)
    spoilt = [replace(trial, name=HOSTILE + "\x07", outputs=(output,))]
    run = result_of(result)
    made = figures(page(run, spoilt), run, spoilt)
    for name, text in made.items():
        root = ElementTree.fromstring(text)
        assert "/" not in name
        assert not [e for e in root.iter() if e.tag in (f"{SVG}script", f"{SVG}img")]
    assert HOSTILE in "".join(ElementTree.fromstring(list(made.values())[-1]).itertext())
