import math

import pytest

from trialid.report.where_pictures import FLOOR, LEFT, RIGHT, WIDTH, picture


@pytest.fixture
def bars(result):
    return result["where"][0]["picture"]


@pytest.fixture
def spectrum(result):
    return result["where"][1]["picture"]


def test_bars_are_as_tall_as_their_squares_and_as_wide_as_their_bins(bars):
    drawn = picture(bars)
    squares = drawn.boxes[:3]
    heights = [box.height for box in squares]
    assert heights[2] / heights[0] == pytest.approx(3.1 / 0.3)
    assert FLOOR - drawn.average == pytest.approx(heights[0] / 0.3)
    widths = [box.width + 2.0 for box in squares]
    assert widths[1] / widths[0] == pytest.approx(1.5)
    assert sum(widths) == pytest.approx(WIDTH - LEFT - RIGHT)
    assert [box.standing for box in squares] == bars["standing"]
    assert "62 % of the squared error" in squares[2].title.replace("\u202f", " ")


def test_means_stand_above_the_zero_line_where_measured_exceeds_predicted(bars):
    drawn = picture(bars)
    up, _, down = drawn.boxes[3:]
    assert up.y + up.height == pytest.approx(drawn.zero)
    assert down.y == pytest.approx(drawn.zero)
    assert down.height / up.height == pytest.approx(60.0)


def test_points_of_the_compass_fit_under_narrow_bins(bars):
    points = ["north", "north-east", "east", "south-east", "south", "south-west", "west"]
    seven = {k: [v[0]] * 7 for k, v in bars.items() if isinstance(v, list) and v}
    drawn = picture(bars | seven | {"names": points, "edges": list(range(8)), "unit": ""})
    assert [tick.word for tick in drawn.ticks][:3] == ["north", "NE", "east"]


def test_what_follows_the_rudder_lies_inside_the_spectrum(spectrum):
    drawn = picture(spectrum)
    heights = [[FLOOR - float(point.split(",")[1]) for point in path.split(" L")[1:-1]]
               for path in (drawn.density, drawn.coherent)]  # fmt: skip
    assert all(b == pytest.approx(0.5 * a, abs=0.11) for a, b in zip(*heights, strict=True))
    assert all(math.isfinite(x) for path in heights for x in path)


@pytest.mark.parametrize("given", [None, {}, {"form": "bars"}, {"form": "spectrum", "density": []},
                                   {"form": "pie"}])  # fmt: skip
def test_a_picture_without_numbers_is_none(given):
    assert picture(given) is None


def test_a_picture_of_which_anything_is_missing_is_none(bars):
    for key in bars.keys() - {"mean", "error"}:
        assert picture(bars | {key: None}) is None or key == "names", key
