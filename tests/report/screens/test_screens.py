"""The pages on screens of any width and on paper, before the system's chromium."""

import copy
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from trialid.report.pages import side_by_side
from trialid.report.pages.page import page as page_of
from trialid.result.json_file import result_of

WIDTHS = (390, 800, 1024, 1366)
"""A phone, a tablet upright and across, a laptop."""

OUTSIDE = """() => {
  const width = document.documentElement.clientWidth;
  const cut = (box, edge) => box.left < edge.left - 1 || box.right > edge.right + 1;
  return [...document.querySelectorAll(".panel:not([hidden])")].flatMap((panel) =>
    [...panel.querySelectorAll(".top b, .u-series")]
      .filter((each) => cut(each.getBoundingClientRect(), panel.getBoundingClientRect()))
      .map((each) => each.textContent));
}"""
"""Names of panels and of lines that reach beyond their panel."""

BESIDE = """() => Math.min(...[...document.querySelectorAll(".u-wrap")].map((plot) => {
  const over = plot.querySelector(".u-over").getBoundingClientRect();
  return plot.getBoundingClientRect().right - over.right;
}))"""
"""px right of the plots, for half of the last time."""

EMPTY = """() => [...document.querySelectorAll(".cards article")].map((card) => {
  const box = card.getBoundingClientRect();
  const last = card.lastElementChild.getBoundingClientRect();
  return (box.bottom - last.bottom) / box.height;
})"""
"""Share of each card that is empty below what stands in it."""


@pytest.fixture
def report(result, series) -> str:
    run = copy.deepcopy(result)
    run["pipeline"] = "a container ship with a long name, zig-zags and a binary test of 2026"
    run["fit"]["band"] = {"r": 0.001, "phi": 0.02}
    return page_of(result_of(run), series)


@pytest.fixture
def comparison(result, series) -> str:
    """Three runs: the second predicts something else, the third saw other samples."""
    other = [_shifted(trial, 0.01) for trial in series]
    strange = [_measured_otherwise(trial) for trial in series]
    found = {"a run": series, "another run": other, "a third": strange}
    results = {label: result_of(result) for label in found}
    return side_by_side.page(side_by_side.shown_runs(results, found))


def _shifted(trial, by):
    outputs = tuple(
        type(o)(o.name, o.measured.copy(), o.predicted + by, o.compared.copy())
        for o in trial.outputs
    )
    return replace(trial, outputs=outputs)


def _measured_otherwise(trial):
    outputs = tuple(
        type(o)(o.name, o.measured + 1.0, o.predicted.copy(), o.compared.copy())
        for o in trial.outputs
    )
    return replace(trial, outputs=outputs)


def tops(page: Any, *selectors: str) -> list[float]:
    return [page.locator(each).first.bounding_box()["y"] for each in selectors]


# --- everything is there, whole ---------------------------------------------------------------


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_cut_on_a_screen(opened, report, width):
    page = opened(report, width)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(OUTSIDE) == []
    assert page.evaluate(BESIDE) >= 20
    title = page.locator("h1")
    assert title.evaluate("e => e.scrollWidth <= e.clientWidth && e.scrollHeight <= e.clientHeight")
    order = tops(page, "h1", ".verdict .sentence", ".cards", ".panels")
    assert order == sorted(order)


@pytest.mark.parametrize("width", WIDTHS)
def test_no_card_is_half_empty(opened, report, width):
    shares = opened(report, width).evaluate(EMPTY)
    assert len(shares) == 3
    assert max(shares) < 0.2


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_cut_side_by_side(opened, comparison, width):
    page = opened(comparison, width)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(OUTSIDE) == []


# --- cursor, signals, picture -----------------------------------------------------------------


def hover(page: Any, share: float) -> None:
    area = page.locator("#trial-0 .panel:not([hidden]) .u-over").first
    area.scroll_into_view_if_needed()
    box = area.bounding_box()
    page.mouse.move(box["x"] + share * box["width"], box["y"] + 10)


def test_the_cursor_shows_time_and_values_in_all_panels(opened, report, series):
    page = opened(report, 1366)
    hover(page, 0.5)
    said = page.locator("#trial-0 .panel .u-legend").all_inner_texts()
    assert len(said) == 6
    trial = series[0]
    k = round(float(said[0].split("s")[0]) / 0.1)
    assert abs(k - len(trial.t) // 2) < 0.03 * len(trial.t)
    rate = trial.outputs[0]
    for value in (rate.measured[k], rate.predicted[k]):
        shown = f"{abs(np.rad2deg(value)):.3g}"[:4]
        assert shown in said[2].replace("\N{MINUS SIGN}", "-"), (shown, said[2])


def test_the_signals_to_see_are_chosen_for_all_trials(opened, report):
    page = opened(report, 1366)
    names = page.locator("#trial-0 .panel .top b").all_inner_texts()
    page.locator("#trial-0 .signals summary").click()
    assert page.locator("#trial-0 .signals label").all_inner_texts() == names
    for name in ("residual of r", names[0]):
        page.locator(f'#trial-0 [data-signal="{name}"]').uncheck()
    for trial in ("#trial-0", "#trial-2"):
        seen = page.locator(f"{trial} .panel:visible .top b").all_inner_texts()
        assert seen == [name for name in names if name not in ("residual of r", names[0])]
    clocks = page.locator("#trial-0 .panel:visible").evaluate_all(
        "all => all.map((each) => each.offsetHeight)"
    )
    page.locator('#trial-0 [data-signal="residual of r"]').check()
    again = page.locator("#trial-0 .panel:visible").evaluate_all(
        "all => all.map((each) => each.offsetHeight)"
    )
    assert len(again) == len(clocks) + 1
    assert clocks[-3] > again[-4]  # the time stood under the yaw rate, and stands below it again
    page.keyboard.press("Escape")
    assert page.locator("#trial-0 .menu-box").is_hidden()
    assert page.locator("#trial-0 .panel:visible canvas").count() == len(again)


@pytest.mark.parametrize("width", [390, 1366])
@pytest.mark.study(turn=6)
def test_what_is_seen_is_saved_as_a_picture(opened, report, tmp_path, width):
    page = opened(report, width)
    heights = []
    for hidden in ((), ("residual of r", "roll angle")):
        page.locator("#trial-1 .signals summary").click()
        for name in hidden:
            page.locator(f'#trial-1 [data-signal="{name}"]').uncheck()
        page.keyboard.press("Escape")
        with page.expect_download() as download:
            page.locator("#trial-1 [data-save]").click()
        assert download.value.suggested_filename == "zigzag-20.png"
        path = tmp_path / "saved.png"
        download.value.save_as(path)
        content = path.read_bytes()
        assert content.startswith(b"\x89PNG\r\n\x1a\n")
        wide, high = (int.from_bytes(content[k : k + 4], "big") for k in (16, 20))
        scale = page.evaluate("devicePixelRatio")
        assert 0.8 * width * scale < wide <= 1300 * scale
        heights.append(high)
        page.locator("#trial-1 .signals summary").click()
        assert len(content) > 10_000
        page.keyboard.press("Escape")
    assert heights[1] < 0.8 * heights[0]


# --- side by side -----------------------------------------------------------------------------


@pytest.mark.study(turn=8)
def test_runs_are_laid_over_one_another_where_they_saw_the_same(opened, comparison):
    page = opened(comparison, 1366)
    assert page.locator("#overlays article").count() == 4
    legends = page.locator("#trial-0 .panel .u-legend").all_inner_texts()
    assert [all(word in legends[2] for word in ("measured", "a run", "another run"))] == [True]
    assert "a third" not in " ".join(legends)
    assert "Not laid over: a third, with other samples" in page.locator("#trial-0").inner_text()
    hover(page, 0.4)
    values = page.locator("#trial-0 .panel").nth(2).locator(".u-value").all_inner_texts()
    measured, first, second = (float(v.replace("\N{MINUS SIGN}", "-")) for v in values[1:])
    assert second - first == pytest.approx(np.rad2deg(0.01), abs=0.002)
    left = page.locator("#trial-0 .panel").nth(3).locator(".u-value").all_inner_texts()
    assert float(left[1].replace("\N{MINUS SIGN}", "-")) == pytest.approx(
        measured - first, abs=0.002
    )


@pytest.mark.study(turn=0)
def test_runs_of_other_trials_are_told_in_tables_alone(result, series):
    other = [replace(t, name=f"{t.name} b") for t in series]
    found = {"a": series, "b": other}
    text = side_by_side.page(
        side_by_side.shown_runs({label: result_of(result) for label in found}, found)
    )
    assert "<script" not in text
    assert 'id="overlays"' not in text


# --- on paper ---------------------------------------------------------------------------------


@pytest.mark.study(turn=2)
def test_paper_has_the_candidates_that_matter_and_no_buttons(opened, result, series):
    run = copy.deepcopy(result)
    run["missing"] += [
        run["missing"][-1] | {"rank": k, "effect": f"effect_of_no_evidence_{k}"}
        for k in range(20, 60)
    ]
    page = opened(page_of(result_of(run), series), 703)
    page.emulate_media(media="print")
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert page.evaluate("document.documentElement.scrollWidth") <= 703  # A4 between its margins
    said = page.locator("#missing").inner_text()
    assert "yaw_damping_cubic" in said
    assert "effect_of_no_evidence" not in said
    assert "more candidates" in said  # that there are more, and how many
    assert page.locator(".tools:visible").count() == 0
    assert page.locator("#fit details, #parameters details").first.locator("table").is_visible()
