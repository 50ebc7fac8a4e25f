"""The recording: what plot tools find in it, and that the layouts name what is there."""

import json
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from s175q import MODEL, OUTPUTS, SETTINGS, white, with_noise, zigzag

from trialid.diagnosis.noise.whitening import colour_of
from trialid.identification.fit import identify
from trialid.identification.output_error import row_scale, stretches
from trialid.replay.alarm import Band, Bands
from trialid.replay.clock import Pace
from trialid.replay.closing_words import summary
from trialid.replay.playback import Playback
from trialid.replay.record import write
from trialid.replay.view import bar, draw
from trialid.ship.model import ShipModel

HALF = {"r": 0.002, "phi": 0.03}
"""Half of the band about the prediction [rad/s, rad]: 1.7 deg of roll."""


@pytest.fixture(scope="module")
def playback():
    """A zig-zag with a roll angle that is 3 degrees off from 700 s on."""
    trial = zigzag(20)
    trial = with_noise(trial, *white(np.random.default_rng(5), trial.samples))
    fit = identify([trial], MODEL, SETTINGS)
    scale, colour = row_scale(fit.problem), colour_of(fit.residual, stretches(fit.problem))
    y = fit.problem.y_rms
    of = tuple(
        Band(c, fit.eps_by_output[c] * y[i], colour[i] * scale[i]) for i, c in enumerate(OUTPUTS)
    )
    off = np.where(trial.t >= 700.0, np.deg2rad(3.0), 0.0)
    late = with_noise(trial, 0.0, off)
    made = Playback(fit, late, Bands(of, "these tests", True), prediction_band=HALF)
    made.go_to(round(900.0 / trial.period))
    return made


@pytest.fixture(scope="module")
def files(tmp_path_factory, playback):
    path = tmp_path_factory.mktemp("record") / "replay.mcap"
    return write(path, playback, "0", start=100.0)


@pytest.fixture(scope="module")
def topics(files):
    read = {}
    with files[0].open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()], validate_crcs=True)
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            read.setdefault(channel.topic, []).append((schema.name, message.log_time, decoded))
    return read


def test_measured_predicted_residual_and_events_are_there_from_the_start_asked_for(
    topics, playback
):
    stem = "/trialid/zigzag-20/"
    assert set(topics) == {
        stem + t
        for t in (
            *("inputs", "measured", "predicted", "predicted_band"),
            *("residual", "band", "alarm", "events"),
        )
    }
    first = round(100.0 / playback.trial.period)
    for role, values in (
        ("measured", playback.measured),
        ("predicted", playback.stream.y),
        ("residual", playback.residual),
    ):
        rows = topics[stem + role]
        assert rows[0][1] == 100_000_000_000
        read = np.array([[m.yaw_rate_radps, m.roll_rad] for _, _, m in rows])
        assert np.array_equal(read, values[first : playback.furthest], equal_nan=True)


def test_events_are_lines_that_foxglove_lists(topics, playback):
    rows = topics["/trialid/zigzag-20/events"]
    assert {schema for schema, *_ in rows} == {"foxglove.Log"}
    warnings = [(t, m) for _, t, m in rows if m.level == 3]
    assert warnings
    t, line = warnings[0]
    assert 700.0 < t / 1e9 <= 710.0
    since = re.match(r"phi left its noise band at ([\d.]+) s, measured above", line.message)
    assert float(since[1]) == pytest.approx(700.0, abs=3.0)
    assert line.timestamp.ToNanoseconds() == t


def test_every_curve_of_both_layouts_is_in_the_recording(files, topics):
    foxglove = json.loads(files[1].read_text(encoding="utf-8"))
    plots = foxglove["configById"]
    paths = [p["value"] for plot in plots.values() for p in plot.get("paths", ())]
    assert len(paths) == 2 * 7 + 2
    for path in paths:
        topic, _, field = path.rpartition(".")
        assert hasattr(topics[topic][0][2], field), path
    assert plots["Log!events"]["topicToRender"] in topics
    assert sorted(_leaves(foxglove["layout"])) == sorted(plots)
    root = ElementTree.fromstring(files[2].read_text(encoding="utf-8"))
    curves = [curve.get("name") for curve in root.iter("curve")]
    assert len(curves) == 2 * 7 + 2
    for name in curves:
        topic, _, field = name.rpartition("/")
        assert hasattr(topics[topic][0][2], field), name
    splitter = next(root.iter("DockSplitter"))
    assert (
        int(splitter.get("count")) == len(list(splitter)) == len(splitter.get("sizes").split(";"))
    )


def _leaves(layout):
    if isinstance(layout, str):
        return [layout]
    return [*_leaves(layout["first"]), *_leaves(layout["second"])]


def test_the_picture_shows_time_signals_bar_and_alarms(playback):
    from rich.console import Console

    console = Console(width=140, force_terminal=False)
    with console.capture() as capture:
        console.print(draw(playback, Pace(10.0, 0.0, 0.0)))
    text = capture.get()
    assert "zigzag-20  899.5 of 1200.0 s  10 times" in text
    assert re.search(r"roll angle φ +-?[\d.]+ deg +-?[\d.]+ deg .*#.* [+-][\d.]+ sigma", text)
    assert "phi left its noise band at" in text
    assert "95 % band of the prediction: r +-0.115 deg/s, phi +-1.72 deg (now outside: phi)" in text
    assert bar(-2.0) == "      ======|            "


def test_seeking_back_keeps_what_was_found(playback):
    before = playback.stream.y.copy(), list(playback.monitor.alarms)
    at = playback.at
    playback.go_to(300)
    assert (playback.at, playback.furthest) == (300, at)
    playback.go_to(at)
    assert np.array_equal(playback.stream.y, before[0], equal_nan=True)
    assert playback.monitor.alarms == before[1]


def test_the_band_is_two_deviations_of_noise_to_either_side(topics, playback):
    _, _, message = topics["/trialid/zigzag-20/band"][0]
    for band, field in zip(playback.bands.of, ("yaw_rate_radps", "roll_rad"), strict=True):
        assert getattr(message, f"{field}_upper") == pytest.approx(2.0 * band.sigma)
        assert getattr(message, f"{field}_lower") == pytest.approx(-2.0 * band.sigma)


def test_the_prediction_lies_in_the_middle_of_its_band(topics):
    predicted = [m for *_, m in topics["/trialid/zigzag-20/predicted"]]
    about = [m for *_, m in topics["/trialid/zigzag-20/predicted_band"]]
    assert len(about) == len(predicted)
    for field, half in (("yaw_rate_radps", HALF["r"]), ("roll_rad", HALF["phi"])):
        middle = np.array([getattr(m, field) for m in predicted])
        upper = np.array([getattr(m, f"{field}_upper") for m in about])
        lower = np.array([getattr(m, f"{field}_lower") for m in about])
        assert np.array_equal(upper, middle + half)
        assert np.array_equal(lower, middle - half)


def test_what_the_closing_words_count_is_what_lies_in_the_band(playback):
    """The roll angle is 3 deg off for the last 200 of 800 s, and of noise hardly ever 1.7."""
    inside = playback.inside(100.0)
    assert inside["phi"] == pytest.approx(0.75, abs=0.01)
    assert inside["r"] > 0.97
    said = summary(playback, 100.0, ())
    assert "95 % band of the prediction: r +-0.115 deg/s, phi +-1.72 deg; inside it r " in said
    assert re.search(r"inside it r \d+%, phi 75%", said)


def test_without_a_band_nothing_is_said_of_it(playback, tmp_path):
    bare = Playback(playback.fit, playback.trial, playback.bands)
    bare.go_to(400)
    assert bare.inside() == {}
    assert "95 %" not in summary(bare, 0.0, ())
    (path, foxglove, _) = write(tmp_path / "bare.mcap", bare, "0")
    assert "predicted_band" not in foxglove.read_text(encoding="utf-8")
    with path.open("rb") as stream:
        channels = make_reader(stream).get_summary().channels.values()
    assert not any("predicted_band" in channel.topic for channel in channels)


def test_what_a_boat_was_doing_is_told_by_less_of_the_record(playback):
    """A reversal is seen in ten seconds of a ship of 175 m, and not in one, of a boat of 1.75 m."""
    found = {}
    for length in (175.0, 1.75):
        model = playback.fit.model
        ship = replace(model.ship, particulars={**model.ship.particulars, "L": length})
        fit = replace(playback.fit, model=ShipModel(ship, model.states, model.effects))
        made = Playback(fit, playback.trial, playback.bands)
        made.go_to(600)
        found[length] = {made.doing(k) for k in range(1, 600, 5)}
    assert any(words.startswith("rudder reversal") for words in found[175.0])
    assert not any(words.startswith("rudder reversal") for words in found[1.75])
