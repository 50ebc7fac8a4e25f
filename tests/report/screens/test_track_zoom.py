"""The track beside the plots, before the system's chromium: it shows the stretch that they show."""

from dataclasses import replace

import numpy as np
import pytest

from trialid.report.pages.page import page as page_of
from trialid.result.json_file import result_of
from trialid.result.track_series import TrackSeries, Way

PART = """() => [...document.querySelectorAll("#trial-0 polyline.part")].map((line) =>
  line.getAttribute("points").split(" ").map((pair) => pair.split(",").map(Number)))"""
DRAWN = """() => {
  const way = document.querySelector("#trial-0 .way");
  const line = way.querySelector("polyline.measured").getAttribute("points").split(" ")[0];
  const word = document.querySelector("#trial-0 .scale-words").textContent;
  const bar = document.querySelector("#trial-0 path.scale").getBBox().width;
  const frame = way.viewBox.baseVal;
  return { width: frame.width, x: frame.x, y: frame.y, first: line, metres: parseFloat(word), bar };
}"""


def eastward(trial):
    """4 m/s to the east by the trial's clock; the model 30 m to the north of it."""
    y, still = 4.0 * trial.t, np.zeros(len(trial.t))
    track = TrackSeries(
        trial=trial.name,
        t=trial.t,
        measured=Way(still, y, still + np.pi / 2.0),
        predicted=Way(still + 30.0, y, still + np.pi / 2.0),
    )
    return replace(trial, track=track)


def test_the_track_shows_the_stretch_that_the_plots_show(opened, result, series):
    text = page_of(result_of(result), [eastward(series[0]), *series[1:]])
    page = opened(text, 1366)
    before = page.evaluate(DRAWN)
    assert page.evaluate(PART) == []
    plots = page.locator("#trial-0 .panels")
    for key in ("+", "+", "ArrowRight"):
        plots.press(key)
    told = page.locator("#trial-0 .window").inner_text()
    begin, end = (float(x) for x in told.replace(" s", "").split(" to "))
    assert end - begin == pytest.approx(series[0].t[-1] / 4.0, rel=0.01)
    measured, predicted = page.evaluate(PART)
    after = page.evaluate(DRAWN)
    scale = before["bar"] / before["metres"]  # px a metre of the whole
    first = float(before["first"].split(",")[0])
    ends = [(x - first) / scale / 4.0 for x in (measured[0][0], measured[-1][0])]
    assert ends == pytest.approx([begin, end], abs=0.5)
    assert predicted[0][0] == pytest.approx(measured[0][0], abs=0.05)
    assert predicted[0][1] == pytest.approx(measured[0][1] - 30.0 * scale, abs=0.05)
    assert after["x"] < measured[0][0] < measured[-1][0] < after["x"] + after["width"]
    closer = before["width"] / after["width"]
    assert closer > 2.0
    assert after["bar"] / after["metres"] == pytest.approx(scale * closer, rel=0.02)
    seen = page.locator("#trial-0 .way [data-at]:visible")
    times = [float(each.get_attribute("data-at")) for each in seen.all()]
    assert times
    assert all(begin <= t <= end for t in times)
    plots.press("0")
    assert page.evaluate(PART) == []
    assert page.evaluate(DRAWN) == before
