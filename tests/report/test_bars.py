import pytest

from trialid.report import bars
from trialid.report.shape import whole


def test_an_error_bar_is_divided_as_the_squares_are(result):
    total, r, phi = bars.split_bars(whole(result))
    assert total.noise_share == pytest.approx(100 * (0.0841 / 0.1264) ** 2)
    assert total.whisker == pytest.approx((40.26, 48.58), abs=0.01)
    assert phi.length == 100
    assert r.length == pytest.approx(100 * 0.1083 / 0.1422)
    assert r.rms == "0.0454 deg/s"


def test_an_error_not_told_apart_has_no_division():
    run = whole({"fit": {"eps_rmsn": 0.1}, "split": {"noise": None, "why": "no quiet stretch"}})
    (total,) = bars.split_bars(run)
    assert (total.noise_share, total.whisker, total.length) == (None, None, 100)


def test_parameter_bars_stop_at_their_axis(result):
    rows = [row for row in result["accuracy"]["parameters"] if row["kind"] == "physical"]
    end, drawn = bars.parameter_bars(rows)
    assert end == bars.WIDEST
    assert all(bar.noise + bar.model <= 100 + 1e-9 for bar in drawn)
    assert [row["name"] for row, bar in zip(rows, drawn, strict=True) if bar.beyond] == ["Yp"]


def test_changes_share_one_scale(result):
    rows = bars.changes(whole(result)["before_after"])
    assert [row.label for row in rows] == [
        "fitted trials",
        "held out",
        "yaw rate r",
        "roll angle \N{GREEK SMALL LETTER PHI}",
    ]
    assert max(row.before_length for row in rows) == 100
    assert rows[0].after_length == pytest.approx(100 * 0.0871 / 0.1437)
