"""Every way a position goes wrong, in every format that has positions: found, and said.

The ship turns to starboard at 6 m/s; what she did is known in metres, and every file is written by
the library of its format. Positions are held against the truth through the whole way: read, turned
into the plane, cleaned, put on a clock.
"""

from dataclasses import replace

import numpy as np
import pytest
from position_logs import CENTIMETRES, FORMATS, Positions

from trialid.alignment import SignalSource, align
from trialid.alignment.track.position import FLATTENING, RADIUS
from trialid.errors import AlignmentError
from trialid.ingest import read
from trialid.recording import Channel
from trialid.trial import Trial

N = 240
STAMPS = 1_700_000_000 * 10**9 + np.arange(N) * 10**9
SPEED, RATE = 6.0, np.deg2rad(1.5)
PSI = RATE * np.arange(N)
NORTH, EAST = SPEED / RATE * np.sin(PSI), SPEED / RATE * (1.0 - np.cos(PSI))
pytestmark = pytest.mark.study(turn="each")
EACH = pytest.mark.parametrize("form", FORMATS, ids=lambda form: form.name)


def geographic(north, east, lat=56.3, lon=11.2):
    """[deg] by the radii of curvature at the start."""
    phi, e2 = np.deg2rad(lat), FLATTENING * (2.0 - FLATTENING)
    w = np.sqrt(1.0 - e2 * np.sin(phi) ** 2)
    meridian, normal = RADIUS * (1.0 - e2) / w**3, RADIUS / w
    at = lon + np.rad2deg(east / (normal * np.cos(phi)))
    return lat + np.rad2deg(north / meridian), (at + 180.0) % 360.0 - 180.0


def through(form: Positions, path, lat, lon, swapped=False) -> Trial:
    """The trial of a file with these positions, and the speed beside it."""
    form.write(path, STAMPS, lat, lon)
    log = read(path)
    t, clock = (getattr(log.channels[form.lat], one) for one in ("t", "clock"))
    speed = Channel("stw", t, np.full(len(t), SPEED), "m/s", clock)
    log = replace(log, channels={**log.channels, "stw": speed})
    units = [None if log.channels[c].unit else "deg" for c in (form.lat, form.lon)]
    names = (form.lon, form.lat) if swapped else (form.lat, form.lon)
    sources = [SignalSource(*one) for one in zip(("lat", "lon"), names, units, strict=True)]
    return align("turn", "fit", [log], [*sources, SignalSource("u", "stw")], 1.0)


def words(trial: Trial) -> str:
    return " | ".join(r for r in trial.remarks if "position" in r or "track" in r)


def off(trial: Trial) -> float:
    """Furthest from the truth where the position is to be believed [m]."""
    n = trial.samples  # a stamp of milliseconds may take the last one
    apart = np.hypot(trial.signals["x"] - NORTH[:n], trial.signals["y"] - EAST[:n])
    return float(apart[trial.valid["x"]].max())


@EACH
def test_the_date_line_is_no_line(form, tmp_path):
    trial = through(form, tmp_path / "log", *geographic(NORTH, EAST, -33.0, 179.999))
    assert off(trial) < 0.1 + CENTIMETRES / 100.0
    assert trial.valid["x"].all()
    assert words(trial) == ""


@EACH
def test_a_jump_of_200_m_and_a_frozen_fix(form, tmp_path):
    north, east = NORTH.copy(), EAST.copy()
    north[[50, 51, 130]] += 200.0
    north[80:95], east[80:95] = north[80], east[80]
    trial = through(form, tmp_path / "log", *geographic(north, east))
    assert "3 fixes further off than she can go, at 50.0, 51.0, 130.0 s; masked" in words(trial)
    assert "14 fixes frozen, at 81.0" in words(trial)
    assert not trial.valid["x"][81:95].any()
    assert off(trial) < 0.5


@EACH
def test_latitude_and_longitude_exchanged(form, tmp_path):
    lat, lon = geographic(NORTH, EAST, 56.0, 121.0)
    with pytest.raises(AlignmentError, match="they are swapped"):
        through(form, tmp_path / "log", lat, lon, swapped=True)
    assert words(through(form, tmp_path / "again", lat, lon)) == ""


@EACH
def test_minutes_written_as_a_fraction_of_a_degree(form, tmp_path):
    lat, lon = (np.trunc(x) + (x - np.trunc(x)) * 0.6 for x in geographic(NORTH, EAST))
    assert "degrees and minutes" in words(through(form, tmp_path / "log", lat, lon))


@pytest.mark.parametrize(
    "form",
    [f for f in FORMATS if not f.name.startswith(("NMEA", "MAV", "data"))],
    ids=lambda form: form.name,
)
def test_degrees_and_minutes_in_one_number(form, tmp_path):
    """56.3 deg as 5618: what formats of integers cannot hold, and NMEA 0183 means by it."""
    lat, lon = (100.0 * (np.trunc(x) + (x - np.trunc(x)) * 0.6) for x in geographic(NORTH, EAST))
    with pytest.raises(AlignmentError, match="ddmm"):
        through(form, tmp_path / "log", lat, lon)
