"""A predicted manoeuvre drawn: lines where the numbers are, ranges about them, a track to scale."""

import numpy as np
import pytest

from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.report.pictures.prediction_picture import HEIGHT, WIDTH, prediction_picture

T = np.linspace(0.0, 200.0, 101)


def places(points: str) -> np.ndarray:
    return np.array([[float(x) for x in one.split(",")] for one in points.split()])


def made(wide: float = 0.002) -> PredictedMotion:
    """A turn to starboard of 100 m radius, known the worse the later."""
    r = np.full(len(T), 0.02) * np.minimum(T / 20.0, 1.0)
    psi = 0.02 * T
    x, y = 100.0 * np.sin(psi), 100.0 * (1.0 - np.cos(psi))
    off = wide * T / T[-1]
    ranges = {"r": (r - off, r + 2.0 * off)}
    ranges |= {"x": (x - 20.0 * off / wide, x + 20.0 * off / wide), "y": (y - 5.0, y + 5.0)}
    motion = {"r": r, "x": x, "y": y}
    return PredictedMotion(t=T, given={"delta": np.full(len(T), 0.3)}, motion=motion, ranges=ranges)


def test_a_panel_holds_its_line_within_its_range() -> None:
    picture = prediction_picture(made())
    order, rate = picture.panels
    assert (order.title, order.band, order.unit) == ("rudder angle δ", "", "deg")
    line, band = places(rate.line), places(rate.band)
    assert line[:, 0].tolist() == pytest.approx((WIDTH * T / 200.0).tolist(), abs=0.06)
    lower, upper = band[: len(T)], band[len(T) :][::-1]
    assert (upper[1:, 1] < line[1:, 1]).all()  # down the page is less
    assert (lower[1:, 1] > line[1:, 1]).all()
    below, above = lower[-1, 1] - line[-1, 1], line[-1, 1] - upper[-1, 1]
    assert above == pytest.approx(2.0 * below, abs=0.2)
    assert band[:, 1].min() >= 0.0
    assert band[:, 1].max() <= HEIGHT
    assert float(rate.high) == pytest.approx(np.rad2deg(0.024), rel=1e-2)
    assert picture.seconds == "200 s"


def test_the_track_is_to_scale_ahead_upwards_to_starboard_on_the_right() -> None:
    track = prediction_picture(made()).track
    assert track is not None
    line = places(track.line)
    metre = track.scale / float(track.scale_words.removesuffix(" m"))
    moved = (line - line[0]) / metre
    now = made().motion
    assert moved[:, 0].tolist() == pytest.approx(now["y"].tolist(), abs=0.1 / metre)
    assert moved[:, 1].tolist() == pytest.approx((-now["x"]).tolist(), abs=0.1 / metre)
    last = places(track.boxes[-1])
    assert np.ptp(last, axis=0) / metre == pytest.approx([10.0, 40.0], abs=0.2 / metre)
    assert np.all((last.min(axis=0) < line[-1]) & (line[-1] < last.max(axis=0)))
    assert track.times[-1] == "200 s"
    inside = np.vstack([line, *(places(b) for b in track.boxes)])
    assert inside.min() >= 0.0
    assert inside[:, 0].max() <= WIDTH
    assert inside[:, 1].max() <= track.height


def test_what_nobody_knows_has_no_range() -> None:
    """A motion whose range is not known is drawn without one; a ship that lies still has no way."""
    one = made()
    nothing = np.full(len(T), np.nan)
    still = {"r": one.motion["r"], "x": np.zeros(len(T)), "y": np.zeros(len(T))}
    unknown = dict.fromkeys(still, (nothing, nothing))
    picture = prediction_picture(PredictedMotion(t=T, given={}, motion=still, ranges=unknown))
    [panel] = picture.panels
    assert panel.band == ""
    assert len(places(panel.line)) == len(T)
    assert picture.track is None
