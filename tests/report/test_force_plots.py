"""A missing force is drawn from the result and its series; a run without one has no section."""

import numpy as np
import pytest

from trialid.report.pages.page import page
from trialid.report.pictures.force_plots import BINS, WIDTH, pictures
from trialid.report.pictures.series_plot import HEIGHT
from trialid.result.force_series import ForceSeries
from trialid.result.json_file import result_of

T = np.arange(0.0, 300.0, 0.5)
PHI = 0.1 * np.sin(2.0 * np.pi * T / 40.0)
TERM = {
    "name": "K_phi_phi_phi", "term": "phi^3", "coefficient": -0.002, "standard_error": 1e-4,
    "share": 0.4, "p_value": 1e-9, "symmetry": "odd", "rivals": ["phi |phi|"],
}  # fmt: skip
SAID = {
    "equations": [
        {"equation": "K", "unit": "N m", "explains": 0.5, "log_likelihood_ratio": 90.0,
         "p_value": 1e-9, "shape": [TERM], "signals": ["phi"], "terms_tried": 77,
         "sentence": "it follows phi^3"},
        {"equation": "N", "unit": "N m", "explains": 0.0, "log_likelihood_ratio": 0.0,
         "p_value": 1.0, "shape": []},
    ],
    "named": "K", "possible": ["K"], "sentence": "a roll moment K is missing <here>",
}  # fmt: skip


@pytest.fixture
def forces():
    force = -3e9 * PHI**3
    error, rest = np.full(len(T), 2e5), np.zeros(len(T))
    return (
        ForceSeries("zigzag-10", T, {"K": force, "N": rest}, {"K": error, "N": error},
                    {"K": force, "N": rest}, {"phi": PHI, "delta": np.cos(T / 9.0), "u": rest}),
    )  # fmt: skip


def test_force_over_time_lies_in_its_band_and_box(forces):
    [picture] = pictures(result_of({"missing_force": SAID}), forces)
    assert (picture.row, picture.top) == ("K", "3.4 MN m")
    [course] = picture.courses
    for points in (course.band, course.force, course.terms):
        x, y = np.array([p.split(",") for p in points.split()], dtype=float).T
        assert x.min() >= 0.0
        assert x.max() <= WIDTH
        assert y.min() >= -0.1
        assert y.max() <= HEIGHT + 0.1


def test_the_signal_that_is_followed_stands_first_and_what_rests_is_left_out(forces):
    [picture] = pictures(result_of({"missing_force": SAID}), forces)
    assert [(a.signal, a.followed) for a in picture.against] == [("φ", True), ("δ", False)]
    bins = picture.against[0].bins
    assert len(bins) == BINS
    assert np.all(np.diff([b.y for b in bins]) > -1e-9)  # the force falls, the picture's y grows


def test_the_page_shows_it_and_takes_no_markup(result, series, forces):
    html = page(result_of({**result, "missing_force": SAID}), series, forces)
    assert 'id="missing-force"' in html
    assert "A roll moment K is missing &lt;here&gt;" in html
    assert "phi^3" in html
    assert 'id="missing-force"' not in page(result_of(result), series)


def test_a_result_without_its_series_still_has_its_words(result, series):
    html = page(result_of({**result, "missing_force": SAID}), series)
    assert "roll moment K is missing" in html
    assert "<svg" not in html.split('id="missing-force"')[1].split("</section>")[0]
