"""The track as drawn: to scale, north up, the ship on it; and as kept in a run's folder."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sailed_tracks import CURRENTS, SETTINGS, SHIP, noisy, sailed, trials

from trialid.errors import LogError
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.report.pages.page import environment
from trialid.report.pictures.track_picture import track_picture
from trialid.result.track_series import TrackSeries, Way, read_track_csv, write_track_csv
from trialid.trial import Trial
from trialid.workflow.track_prediction import track_of, true_wind

SIZE = {"L": 100.0, "B": 20.0}


def eastward(current: tuple[float, float] | None = (0.0, 1.0)) -> TrackSeries:
    """1000 m to the east, then 500 m to the north, with a gap; the model goes 50 m beside it."""
    t = np.arange(16.0)
    x, y = np.maximum(t - 10.0, 0.0) * 100.0, np.minimum(t, 10.0) * 100.0
    psi = np.where(t < 10.0, np.pi / 2.0, 0.0)
    measured = Way(np.where(t == 5.0, np.nan, x), y, psi)
    return TrackSeries(
        trial="east",
        t=t,
        measured=measured,
        predicted=Way(x - 50.0, y, psi),
        current=current,
        over_ground=True,
    )


def points(text: str) -> np.ndarray:
    return np.array([[float(x) for x in pair.split(",")] for pair in text.split()])


def test_one_scale_north_up_and_east_to_the_right() -> None:
    drawn = track_picture(eastward(), SIZE)
    assert drawn is not None
    assert [line.times for line in drawn.measured] == ["0,1,2,3,4", "6,7,8,9,10,11,12,13,14,15"]
    assert len(drawn.measured) == 2  # a gap is none of the track
    first, second = (points(line.points) for line in drawn.measured)
    scale = drawn.scale / 200.0
    assert drawn.scale_words == "200 m"
    assert first[-1] - first[0] == pytest.approx([400.0 * scale, 0.0], abs=0.2)
    assert second[-1] - second[0] == pytest.approx([400.0 * scale, -500.0 * scale], abs=0.2)
    [model] = (points(line.points) for line in drawn.predicted)
    assert model[0] - first[0] == pytest.approx([0.0, 50.0 * scale], abs=0.2)
    assert points(" ".join(line.points for line in drawn.measured)).min() > 0.0
    assert (
        points(" ".join(line.points for line in drawn.measured)).max(axis=0)[1]
        < drawn.height - 40.0
    )


def test_the_ship_is_drawn_to_scale_with_her_bow_ahead() -> None:
    drawn = track_picture(eastward(), SIZE)
    assert drawn is not None
    hull, scale = points(drawn.outlines[0]), drawn.scale / 200.0
    assert np.ptp(hull, axis=0) == pytest.approx([100.0 * scale, 20.0 * scale], abs=0.2)
    middle = points(drawn.measured[0].points)[0]
    assert hull[0] - middle == pytest.approx([50.0 * scale, 0.0], abs=0.2)
    north = points(drawn.outlines[-1])
    assert north[0][1] == north[:, 1].min()
    line = track_picture(eastward(), {"L": 100.0})
    assert line is not None
    assert len(points(line.outlines[0])) == 2  # her beam is not stated, and not made up


def test_the_arrow_goes_where_the_water_goes() -> None:
    words = {}
    for name, current in {"east": (0.0, 1.0), "south": (-0.5, 0.0)}.items():
        drawn = track_picture(eastward(current), SIZE)
        assert drawn is not None
        words[name] = (drawn.current, drawn.current_words)
    assert words == {
        "east": (90.0, "current 1.0 m/s to 090°"),
        "south": (180.0, "current 0.50 m/s to 180°"),
    }
    unknown = track_picture(eastward(None), SIZE)
    assert unknown is not None
    assert (unknown.current, unknown.current_words) == (None, "current not known")
    assert track_picture(None) is None


def test_the_wind_is_drawn_where_it_goes_and_called_by_where_it_comes_from() -> None:
    drawn = track_picture(replace(eastward(), wind=(0.0, 8.0)), SIZE)
    assert drawn is not None
    assert (drawn.wind, drawn.wind_words) == (90.0, "mean wind 8.0 m/s from 270°")
    unknown = track_picture(eastward(), SIZE)
    assert unknown is not None
    assert (unknown.wind, unknown.wind_words) == (None, "wind not recorded")


def test_the_true_wind_is_the_one_on_board_less_her_own_way() -> None:
    """Air that comes from the west at 12 m/s, on a ship that goes and looks all round."""
    t = np.arange(0.0, 300.0, 1.0)
    psi = 0.3 + t / 60.0
    x, y = np.cumsum(6.0 * np.cos(psi)), np.cumsum(6.0 * np.sin(psi))
    north, east = -np.gradient(x), 12.0 - np.gradient(y)
    signals = {
        **{"x": x, "y": y, "psi": psi, "V_aw": np.hypot(north, east)},
        "gamma_aw": np.arctan2(-east, -north) - psi,
    }
    trial = Trial("round", "fit", 1.0, signals, {n: np.ones(300, bool) for n in signals})
    assert true_wind(trial) == pytest.approx((0.0, 12.0), abs=1e-9)
    still = {n: x for n, x in signals.items() if n != "V_aw"}
    assert true_wind(replace(trial, signals=still)) is None


def test_what_a_folder_keeps_is_what_was_drawn(tmp_path: Path) -> None:
    file = tmp_path / "track.csv"
    whole = replace(eastward(), wind=(-6.0, 8.0))
    unknown = replace(eastward(None), trial="x", over_ground=False)
    write_track_csv(file, [whole, unknown])
    found = read_track_csv(file)
    assert track_picture(found["east"], SIZE) == track_picture(whole, SIZE)
    assert track_picture(found["x"], SIZE) == track_picture(unknown, SIZE)
    assert read_track_csv(tmp_path / "none.csv") == {}
    file.write_text(file.read_text()[:-40])
    with pytest.raises(LogError, match="cannot be read as the tracks"):
        read_track_csv(file)


def test_the_model_goes_over_the_ground_or_says_that_it_does_not() -> None:
    """With positions among the outputs the current is in it; without, it is through the water."""
    fit = identify(trials(0), SHIP, SETTINGS)
    over = track_of(fit, fit.scores[0])
    assert over is not None
    assert over.over_ground
    assert over.current == pytest.approx(CURRENTS["circle"], abs=0.05)
    off = np.hypot(over.measured.x - over.predicted.x, over.measured.y - over.predicted.y)
    assert float(np.sqrt(np.mean(off**2))) < 2.0  # of which noise is 1.4 m
    states = tuple(s for s in SHIP.states if s not in ("x", "y", "psi"))
    blind = identify(
        [noisy(sailed("zigzag", CURRENTS["zigzag"]), np.random.default_rng(1))],
        replace(SHIP, states=states),
        Settings(("Nv", "Nr", "Ndelta"), ("r",)),
    )
    through = track_of(blind, blind.scores[0])
    assert through is not None
    assert not through.over_ground
    assert through.current is None
    last = (through.measured.columns - through.predicted.columns)[:2, -1]
    told = np.array(CURRENTS["zigzag"]) * through.t[-1]
    assert last == pytest.approx(told, abs=0.15 * float(np.hypot(*told)))


def test_the_picture_is_sound_and_escapes_the_name() -> None:
    drawn = track_picture(replace(eastward(), trial='<b>"x"'), SIZE)
    text = environment().from_string(
        '{% from "sections/track.html.j2" import draw_track %}{{ draw_track(each) }}'
    )
    page = text.render(each=drawn)
    assert "<b>" not in page
    assert "NaN" not in page
    assert "nan" not in re.sub(r"[a-z]nan[a-z]", "", page)


def test_a_file_from_before_there_was_a_wind_is_read(tmp_path: Path) -> None:
    """Its two columns come last, so that what was written without them is the same but for them."""
    one = replace(eastward(), current=(0.1, -0.2), wind=(3.0, 4.0), over_ground=True)
    file = tmp_path / "track.csv"
    write_track_csv(file, [one])
    assert read_track_csv(file)["east"].wind == (3.0, 4.0)
    lines = file.read_text(encoding="utf-8").splitlines()
    file.write_text("\n".join(line.rsplit(",", 2)[0] for line in lines) + "\n", encoding="utf-8")
    found = read_track_csv(file)["east"]
    assert (found.current, found.wind, found.over_ground) == ((0.1, -0.2), None, True)
