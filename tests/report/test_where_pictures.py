import math
from dataclasses import asdict, fields, replace

import pytest

from trialid.errors import TrialidError
from trialid.report.pictures.where_pictures import FLOOR, LEFT, RIGHT, WIDTH, picture
from trialid.result.json_file import result_of, row_of
from trialid.result.schema import FindingRow


@pytest.fixture
def bars(result):
    return result_of(result).where[0].picture


@pytest.fixture
def spectrum(result):
    return result_of(result).where[1].picture


def test_bars_are_as_tall_as_their_squares_and_as_wide_as_their_bins(bars):
    drawn = picture(bars)
    squares = drawn.boxes[:3]
    heights = [box.height for box in squares]
    assert heights[2] / heights[0] == pytest.approx(3.1 / 0.3)
    assert FLOOR - drawn.average == pytest.approx(heights[0] / 0.3)
    widths = [box.width + 2.0 for box in squares]
    assert widths[1] / widths[0] == pytest.approx(1.5)
    assert sum(widths) == pytest.approx(WIDTH - LEFT - RIGHT)
    assert tuple(box.standing for box in squares) == bars.standing
    assert "62 % of the squared error" in squares[2].title.replace("\u202f", " ")


def test_whiskers_stay_in_the_picture_and_means_have_a_scale(bars):
    """They left it at the top; and how much a mean is was nowhere to read."""
    drawn = picture(bars)
    assert min(line.y2 for line in drawn.whiskers) > 1.0
    far = picture(replace(bars, high=tuple(100.0 * x for x in bars.high)))
    tallest = max(bars.mean_square)
    assert max(box.height for box in far.boxes[:3]) == pytest.approx(0.46 * (FLOOR - 8.0))
    assert far.whiskers[bars.mean_square.index(tallest)].y2 == 1.0
    reach = max(abs(m) + 1.96 * e for m, e in zip(bars.mean, bars.error, strict=True))
    words = [word for _, word in drawn.left]
    assert words[2:] == [f"{reach:.2g} deg/s", "mean", f"\N{MINUS SIGN}{reach:.2g} deg/s"]


def test_means_stand_above_the_zero_line_where_measured_exceeds_predicted(bars):
    drawn = picture(bars)
    up, _, down = drawn.boxes[3:]
    assert up.y + up.height == pytest.approx(drawn.zero)
    assert down.y == pytest.approx(drawn.zero)
    assert down.height / up.height == pytest.approx(60.0)


def test_points_of_the_compass_fit_under_narrow_bins(bars):
    points = ["north", "north-east", "east", "south-east", "south", "south-west", "west"]
    lists = {each.name: getattr(bars, each.name) for each in fields(bars)}
    seven = {k: (v[0],) * 7 for k, v in lists.items() if isinstance(v, tuple) and v}
    wide = {"names": tuple(points), "edges": tuple(range(8)), "unit": ""}
    drawn = picture(replace(bars, **(seven | wide)))
    assert [tick.word for tick in drawn.ticks][:3] == ["north", "NE", "east"]


def test_what_follows_the_rudder_lies_inside_the_spectrum(spectrum):
    drawn = picture(spectrum)
    heights = [[FLOOR - float(point.split(",")[1]) for point in path.split(" L")[1:-1]]
               for path in (drawn.density, drawn.coherent)]  # fmt: skip
    assert all(b == pytest.approx(0.5 * a, abs=0.11) for a, b in zip(*heights, strict=True))
    assert all(math.isfinite(x) for path in heights for x in path)


NOTHING = {"frequency": [], "density": [], "coherent": [], "coherence": [], "threshold": 0.3}


@pytest.mark.parametrize("given", [None, {}, {"form": "bars"}, {"form": "spectrum", "density": []},
                                   {"form": "pie"}, {"form": "spectrum", **NOTHING}])  # fmt: skip
def test_a_picture_without_numbers_is_none(given):
    """What is no whole picture is refused with its key; one that holds no number is not drawn."""
    row = {"output": "r", "finding": "frequency", "picture": given}
    if given is None or "threshold" in given:
        assert picture(row_of(FindingRow, row).picture) is None
    else:
        with pytest.raises(TrialidError, match=r"^picture"):
            row_of(FindingRow, row)


def test_a_picture_of_which_anything_is_missing_is_none(bars):
    for each in fields(bars):
        if isinstance(getattr(bars, each.name), tuple):
            cut = replace(bars, **{each.name: getattr(bars, each.name)[:-1]})
            assert picture(cut) is None or each.name == "names", each.name
    for key in [each.name for each in fields(bars) if each.name not in ("mean", "error")]:
        with pytest.raises(TrialidError, match=rf"^picture(\.bars\.{key})?: "):
            row_of(
                FindingRow, {"output": "r", "finding": "f", "picture": asdict(bars) | {key: None}}
            )
    for key in ("mean", "error"):
        assert picture(replace(bars, **{key: None})) is None or key == "mean", key
