import base64
import json
import math
from dataclasses import replace

import numpy as np
import pytest

from trialid.report.pictures.overlays import overlays
from trialid.report.pictures.panels import trial_panels
from trialid.result.json_file import result_of


def decoded(text):
    return np.frombuffer(base64.b64decode(text), "<f4")


def test_panels_hold_shown_units_and_open_gaps(result, series):
    _, trial, *_ = trial_panels(series, result_of(result))
    r = trial["panels"][2]
    output = series[1].outputs[0]
    assert (r["title"], r["unit"]) == ("yaw rate", "deg/s")
    assert np.allclose(
        decoded(r["measured"]), output.observed * 180 / math.pi, rtol=1e-6, equal_nan=True
    )
    assert np.isnan(decoded(r["measured"])).sum() == (~output.compared).sum()


def test_an_ordered_signal_shares_the_panel_of_what_came_of_it(result, series):
    trial, *_ = trial_panels(series, result_of(result))
    rudder, speed = trial["panels"][:2]
    assert [line["label"] for line in rudder["lines"]] == [
        "\N{GREEK SMALL LETTER DELTA}",
        "\N{GREEK SMALL LETTER DELTA}_c",
    ]
    assert speed["unit"] == "m/s"


def test_findings_stand_in_the_panel_they_speak_of(result, series):
    trials = trial_panels(series, result_of(result))
    placed = {
        (trial["name"], panel["title"]): panel["stretches"]
        for trial in trials
        for panel in trial["panels"]
        if panel.get("stretches")
    }
    assert placed == {
        ("zigzag-20", "yaw rate"): [[640.0, 760.0]],
        ("binary", "roll angle"): [[212.5, 398.5]],
    }


def test_noise_lines_stand_at_twice_the_noise(result, series):
    trial, *_ = trial_panels(series, result_of(result))
    levels = {p["title"]: p["noise"] for p in trial["panels"] if p["kind"] == "output"}
    assert levels["yaw rate"] == pytest.approx(2 * 0.0453 * 0.00731 * 180 / math.pi)
    assert levels["roll angle"] == pytest.approx(2 * 0.1103 * 0.0311 * 180 / math.pi)
    bare, *_ = trial_panels(series, result_of({}))
    assert {p["noise"] for p in bare["panels"] if p["kind"] == "output"} == {None}


def test_a_long_trial_costs_a_page_four_bytes_a_number(result, series):
    text = json.dumps(trial_panels(series, result_of(result)))
    numbers = sum(len(t.t) * (len(t.inputs) + 2 * len(t.outputs)) for t in series)
    assert len(text) < 1.02 * numbers * 4 * 4 / 3 + 10_000


def test_a_clock_with_a_step_is_given_sample_by_sample(series):
    from dataclasses import replace

    late = np.where(series[0].t > 50, series[0].t + 1, series[0].t)
    even, uneven = trial_panels([series[0], replace(series[0], t=late)], result_of({}))
    assert even["t"]["samples"] == len(late)
    assert np.allclose(decoded(uneven["t"]["each"]), late)
    json.dumps([even, uneven], allow_nan=False)


def test_the_band_is_in_the_unit_shown(result, series):
    half = {"fit": result["fit"] | {"band": {"r": 0.01}}}
    panels = trial_panels(series, result_of(result | half))[0]["panels"]
    bands = {p["symbol"]: p["band"] for p in panels if p["kind"] == "output"}
    assert bands["r"] == pytest.approx(np.rad2deg(0.01))
    assert [b for s, b in bands.items() if s != "r"] == [None]


def test_runs_are_laid_over_one_another_only_where_they_measured_the_same(series):
    """A millionth apart is the same sample, a hundredth is another record of that name."""

    def with_measured(factor):
        outputs = [replace(o, measured=o.measured * factor) for o in series[0].outputs]
        return [replace(series[0], outputs=outputs)]

    same, other = with_measured(1.0 + 1e-8), with_measured(1.01)
    one, *_ = overlays({"a": series[:1], "b": same, "c": other})
    assert (one.labels, one.elsewhere) == (("a", "b"), ("c",))
    assert overlays({"a": series[:1], "c": other}) == []
