from statistics import NormalDist

import pytest

from trialid.report.pictures import bars
from trialid.result.fit_rows import ParameterRow
from trialid.result.json_file import result_of


def test_an_error_bar_is_divided_as_the_squares_are(result):
    total, r, phi = bars.split_bars(result_of(result))
    assert total.noise_share == pytest.approx(100 * (0.0841 / 0.1264) ** 2)
    assert total.whisker == pytest.approx((40.26, 48.58), abs=0.01)
    assert phi.length == 100
    assert r.length == pytest.approx(100 * 0.1083 / 0.1422)
    assert r.rms == "0.0454 deg/s"


def test_an_error_not_told_apart_has_no_division():
    run = result_of({"fit": {"eps_rmsn": 0.1}, "split": {"noise": None, "why": "no quiet stretch"}})
    (total,) = bars.split_bars(run)
    assert (total.noise_share, total.whisker, total.length) == (None, None, 100)


def test_ranges_stop_at_the_ends_of_their_track(result):
    rows = result_of(result).physical
    end, drawn = bars.range_bars(rows)
    assert end == bars.WIDEST
    assert all(0.0 <= x <= 100.0 for bar in drawn for x in (*bar.likely, *bar.noise))
    open_ended = {row.name: bar.beyond for row, bar in zip(rows, drawn, strict=True)}
    assert {n: b for n, b in open_ended.items() if any(b)} == {"Yp": (True, True)}


def test_a_range_lies_about_its_value_less_to_the_left(result):
    """Of Yv, a negative number: from 9.72 % below to 6.48 % above; noise 0.82 % to each side."""
    row = result_of(result).physical[0]
    _, [bar] = bars.range_bars([row])
    end = row.may_be_off
    assert end == pytest.approx(1.2 * 0.081)
    assert bar.likely == pytest.approx((0.0, 50.0 + 50.0 * 0.8 / 1.2))
    wide = NormalDist().inv_cdf(0.975)
    assert bar.noise == pytest.approx(
        (50.0 - 50.0 * wide * 0.0042 / end, 50.0 + 50.0 * wide * 0.0042 / end)
    )


def test_what_nobody_knows_has_no_range():
    rows = [
        ParameterRow(name="Nv", value=0.0, likely=(-1.0, 1.0)),
        ParameterRow(name="Nr", value=1.0),
    ]
    assert bars.range_bars(rows) == (1.0, [None, None])


def test_changes_share_one_scale(result):
    rows = bars.changes(result_of(result).before_after)
    assert [row.label for row in rows] == [
        "fitted trials",
        "held out",
        "yaw rate r",
        "roll angle \N{GREEK SMALL LETTER PHI}",
    ]
    assert max(row.before_length for row in rows) == 100
    assert rows[0].after_length == pytest.approx(100 * 0.0871 / 0.1437)
