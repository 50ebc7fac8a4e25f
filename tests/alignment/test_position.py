"""Positions of a log: into the plane, what is no fix, swapped, in minutes; the antenna."""

from dataclasses import replace

import numpy as np
import pytest
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align
from trialid.alignment.track.antenna import at_origin, check_stated_speed
from trialid.alignment.track.position import FLATTENING, RADIUS, plane
from trialid.errors import AlignmentError, ShipError
from trialid.ship.particulars import read_ship
from trialid.trial import Trial

T = np.arange(0.0, 240.0)
LAT, LON = 56.0, 11.0
SPEED, RATE = 6.0, np.deg2rad(1.5)


def circle():
    """North and east of a ship that turns to starboard at 6 m/s, and her heading [rad]."""
    psi = RATE * T
    return SPEED / RATE * np.sin(psi), SPEED / RATE * (1.0 - np.cos(psi)), psi


def geographic(north, east, lat=LAT, lon=LON):
    """[deg] by the radii of curvature at the start, to first order: not the way that is tested."""
    phi = np.deg2rad(lat)
    e2 = FLATTENING * (2.0 - FLATTENING)
    w = np.sqrt(1.0 - e2 * np.sin(phi) ** 2)
    meridian, normal = RADIUS * (1.0 - e2) / w**3, RADIUS / w
    at = lon + np.rad2deg(east / (normal * np.cos(phi)))
    return lat + np.rad2deg(north / meridian), (at + 180.0) % 360.0 - 180.0


def aligned(lat, lon, *more, heading=True):
    _, _, psi = circle()
    channels = [channel("lat", T, lat, "deg"), channel("lon", T, lon, "deg")]
    channels += [channel("hdg", T, np.rad2deg(psi) % 360.0, "deg")] if heading else []
    sources = [SignalSource("lat", "lat"), SignalSource("lon", "lon")]
    sources += [SignalSource("psi", "hdg")] if heading else []
    channels += [one for one, _ in more]
    sources += [source for _, source in more]
    return align("turn", "fit", [recording(*channels)], sources, 1.0)


def words(trial):
    return " | ".join(r for r in trial.remarks if "position" in r or "track" in r)


@pytest.mark.parametrize(("lat", "lon"), [(56.0, 11.0), (-33.0, 179.999), (71.0, -180.0)])
def test_a_circle_comes_back_across_the_date_line_too(lat, lon):
    north, east, _ = circle()
    trial = aligned(*geographic(north, east, lat, lon))
    np.testing.assert_allclose(trial.signals["x"], north, atol=0.1)
    np.testing.assert_allclose(trial.signals["y"], east, atol=0.1)
    assert trial.valid["x"].all()
    assert not {"lat", "lon"} & {*trial.signals}
    assert words(trial) == ""


def test_a_degree_is_as_long_as_tables_have_it():
    """Published lengths of a degree on WGS 84: 110.574 and 111.320 km at 0, 111.132 at 45 deg."""
    small = np.deg2rad(0.01)
    for lat, of_lat, of_lon in ((0.0, 110574.3, 111319.5), (45.0, 111131.8, 78846.8)):
        phi = np.deg2rad(lat)
        north, _ = plane(np.array([phi, phi + small]), np.zeros(2))
        _, east = plane(np.array([phi, phi]), np.array([0.0, small]))
        assert 100.0 * north[1] == pytest.approx(of_lat, abs=12.0)
        assert 100.0 * east[1] == pytest.approx(of_lon, abs=2.0)


def test_a_jump_of_200_m_is_masked_and_told():
    north, east, _ = circle()
    logged = north.copy()
    logged[[50, 51, 130]] += 200.0
    trial = aligned(*geographic(logged, east))
    assert "3 fixes further off than she can go, at 50.0, 51.0, 130.0 s; masked" in words(trial)
    np.testing.assert_allclose(trial.signals["x"], north, atol=0.5)  # two missing are no gap


def test_a_jump_that_stays_is_not_bridged():
    north, east, _ = circle()
    north[100:] += 400.0
    told = words(aligned(*geographic(north, east)))
    assert "stays" in told
    assert "not bridged" in told


def test_a_frozen_fix_and_zeros_are_masked():
    north, east, _ = circle()
    north[60:75], east[60:75] = north[60], east[60]
    lat, lon = geographic(north, east)
    lat[20], lon[20] = 0.0, 0.0
    trial = aligned(lat, lon)
    assert "14 fixes frozen, at 61.0" in words(trial)
    assert not trial.valid["x"][61:75].any()
    assert trial.valid["x"][60]
    assert np.abs(trial.signals["x"]).max() < 300.0


def test_noise_of_a_receiver_is_no_fault():
    north, east, _ = circle()
    rng = np.random.default_rng(3)
    trial = aligned(*geographic(north + rng.normal(0, 2, 240), east + rng.normal(0, 2, 240)))
    assert words(trial) == ""
    assert trial.valid["x"].mean() > 0.98


def test_swapped_channels_are_refused_by_range_and_by_the_heading():
    north, east, _ = circle()
    lat, lon = geographic(north, east, 56.0, 121.0)
    with pytest.raises(AlignmentError, match="they are swapped"):
        aligned(lon, lat)
    lat, lon = geographic(north, east)
    with pytest.raises(AlignmentError, match="only with north and east exchanged"):
        aligned(lon, lat)


def test_degrees_and_minutes_in_one_number_are_found():
    north, east, _ = circle()
    lat, lon = geographic(north, east, 56.3, 11.2)

    def minutes(x, scale):
        return (np.trunc(x) + (x - np.trunc(x)) * 0.6) * scale

    with pytest.raises(AlignmentError, match="ddmm"):
        aligned(minutes(lat, 100.0), minutes(lon, 100.0))
    u = channel("stw", T, np.full(len(T), SPEED), "m/s"), SignalSource("u", "stw")
    assert "degrees and minutes" in words(aligned(minutes(lat, 1.0), minutes(lon, 1.0), u))
    assert words(aligned(lat, lon, u)) == ""


def test_one_without_the_other_and_positions_twice_are_refused():
    north, east, _ = circle()
    lat, lon = geographic(north, east)
    log = recording(channel("lat", T, lat, "deg"), channel("lon", T, lon, "deg"))
    with pytest.raises(AlignmentError, match="'lat' needs 'lon' beside it"):
        align("turn", "fit", [log], [SignalSource("lat", "lat")], 1.0)
    twice = channel("north", T, north, "m"), SignalSource("x", "north")
    with pytest.raises(AlignmentError, match="one position"):
        aligned(lat, lon, twice)


def test_the_antenna_is_taken_back_to_the_origin_with_heading_and_roll():
    """A mast 10 m ahead, 2 m to starboard and 20 m high, heeled to starboard by 10 deg."""
    n = 5
    psi, phi = np.full(n, np.deg2rad(90.0)), np.full(n, np.deg2rad(10.0))
    signals = {"x": np.zeros(n), "y": np.zeros(n), "psi": psi, "phi": phi}
    valid = {c: np.ones(n, dtype=bool) for c in signals}
    trial = Trial("quay", "fit", 1.0, signals, valid)
    moved = at_origin(trial, {"x": 10.0, "y": 2.0, "z": -20.0})
    aside = 2.0 * np.cos(phi[0]) + 20.0 * np.sin(phi[0])  # the mast leans to starboard: south
    np.testing.assert_allclose(moved.signals["y"], -10.0, atol=1e-12)  # the bow is in the east
    np.testing.assert_allclose(moved.signals["x"], aside, atol=1e-12)
    blind = replace(trial, signals={c: x for c, x in signals.items() if c != "psi"})
    with pytest.raises(AlignmentError, match="map psi"):
        at_origin(blind, {"x": 10.0})


@pytest.mark.parametrize("rate", [True, False])
def test_speed_and_course_at_the_antenna_are_those_of_the_origin(rate: bool) -> None:
    """A boat that turns and slides, and by the sea rolls; with a rate of turn or by the heading."""
    t = np.arange(0.0, 60.0, 0.1)
    psi = 0.8 * np.sin(0.3 * t) + 0.1 * t
    r = 0.24 * np.cos(0.3 * t) + 0.1
    phi = 0.1 * np.sin(0.9 * t)
    u, v = 2.0 + 0.3 * np.sin(0.2 * t), -0.4 * np.sin(0.3 * t)
    at = {"x": 1.5, "y": -0.6, "z": -2.0}
    aside = at["y"] * np.cos(phi) - at["z"] * np.sin(phi)
    rolled = (-at["y"] * np.sin(phi) - at["z"] * np.cos(phi)) * 0.09 * np.cos(0.9 * t)
    ahead, side = u - r * aside, v + r * at["x"] + rolled
    signals = {"psi": psi, "phi": phi, "sog": np.hypot(ahead, side)}
    signals |= {"cog": psi + np.arctan2(side, ahead)} | ({"r": r} if rate else {})
    trial = Trial("t", "fit", 0.1, signals, {n: np.ones(len(t), bool) for n in signals})
    moved = at_origin(trial, at)
    assert moved.remarks[-1].startswith("sog, cog: moved from the antenna to the origin")
    inner = slice(1, -1)
    np.testing.assert_allclose(moved.signals["sog"][inner], np.hypot(u, v)[inner], atol=2e-3)
    course = (psi + np.arctan2(v, u))[inner]
    np.testing.assert_allclose(moved.signals["cog"][inner], course, atol=2e-3)
    for lacks, says in (("psi", "which sog, cog needs; map psi"), ("cog", "needs both; map cog")):
        less = {n: x for n, x in signals.items() if n != lacks}
        with pytest.raises(AlignmentError, match=says):
            at_origin(replace(trial, signals=less), at)


def test_a_ship_file_says_where_the_antenna_is(tmp_path):
    from s175q import ROOT

    text = (ROOT / "sample_data" / "ships" / "s175q.toml").read_text(encoding="utf-8")
    file = tmp_path / "ship.toml"
    file.write_text(f"{text}\n[antenna]\nx = -60.0\nz = -25.0\n", encoding="utf-8")
    assert read_ship(file).antenna == {"x": -60.0, "z": -25.0}
    file.write_text(f"{text}\n[antenna]\nahead = 3.0\n", encoding="utf-8")
    with pytest.raises(ShipError, match="write x, y and z"):
        read_ship(file)


def test_a_course_over_ground_is_in_the_turn_of_the_heading():
    north, east, psi = circle()
    course = (np.rad2deg(psi + 0.1) + 180.0) % 360.0 - 180.0
    off = channel("cog", T, course - 360.0, "deg"), SignalSource("cog", "cog")
    trial = aligned(*geographic(north, east), off)
    assert np.abs(trial.signals["cog"] - trial.signals["psi"] - 0.1).max() < 1e-3


@pytest.mark.parametrize(
    ("share", "said"),
    [(1.0, ""), (0.6, "dd.mmmm, degrees and minutes"), (0.4, "a wrong unit"), (1.9, "a strong")],
)
def test_a_track_at_another_speed_than_was_stated(share, said):
    """She loses a third of her speed in the turn: her fastest counts."""
    t = np.arange(0.0, 300.0, 2.0)
    speed = share * np.where(t < 60.0, 7.0, 4.5)
    psi = np.where(t < 60.0, 0.0, 0.02 * (t - 60.0))
    rng = np.random.default_rng(3)
    signals = {
        n: np.cumsum(2.0 * speed * f(psi)) + rng.standard_normal(len(t))
        for n, f in (("x", np.cos), ("y", np.sin))
    }
    trial = Trial("turn", "fit", 2.0, signals, {n: np.ones(len(t), bool) for n in signals})
    found = " ".join(check_stated_speed(trial, 7.0))
    assert said in found
    assert (found == "") == (said == "")
