"""What a survey says of logs whose content is known."""

from pathlib import Path

import numpy as np
import pytest

from trialid import ingest, inspection
from trialid.errors import LogError
from trialid.ingest.adapter import Adapter
from trialid.inspection import relations, sketch
from trialid.inspection.disagreements import findings
from trialid.recording import Channel, Recording

START = 1_700_000_000_000_000_000
DATA = Path(__file__).parents[3] / "shared" / "data"


def turning(t):
    """Heading [rad] and its slope [rad/s]."""
    return 0.8 * np.sin(0.02 * t) + 0.01 * t, 0.016 * np.cos(0.02 * t) + 0.01


def csv(path, columns):
    names = ",".join(columns)
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, delimiter=",", header=names, comments="", fmt="%.9g")
    return path


@pytest.fixture
def recorded(monkeypatch):
    """Give a function that makes channels into the one log there is, read in two batches."""

    def use(*channels, remarks=()):
        def read(path, wanted, aids):
            kept = {c.name: c for c in channels if wanted is None or c.name in wanted}
            return Recording(path, "made", "0" * 64, kept, remarks)

        names = [c.name for c in channels]
        adapter = Adapter(
            "made", lambda head: True, read, batches=lambda path, aids: (names[::2], names[1::2])
        )
        monkeypatch.setattr(ingest, "ADAPTERS", (adapter,))
        return inspection.inspect_log(Path(__file__))

    return use


def channel(name, t, y, **more):
    stamps = START + np.rint(np.asarray(t) * 1e9).astype(np.int64)
    return Channel(name, stamps, np.asarray(y, float), clock="made", **more)


def test_rate_range_and_gaps_are_those_of_the_log(recorded):
    t = np.concatenate([np.arange(0, 100, 0.1), np.arange(130, 150, 0.1)])
    (one,) = recorded(channel("rudder", t, np.sin(t), unit="rad")).channels.values()
    assert one.samples == len(t)
    assert one.rate == pytest.approx(10.0)
    assert (one.low, one.high) == pytest.approx((np.sin(t).min(), np.sin(t).max()))
    assert (one.gaps.count, one.gaps.total) == (1, pytest.approx(30.1))
    assert one.missing == 0.0
    assert one.guess.quantity == "delta"
    assert one.clock.jitter < 1e-9


def test_not_available_values_are_a_share_and_a_gap(recorded):
    t = np.arange(0, 100, 0.5)
    y = np.where((t > 20) & (t < 40), np.nan, np.cos(t))
    (one,) = recorded(channel("heel", t, y)).channels.values()
    assert one.missing == pytest.approx(np.isnan(y).mean())
    assert one.gaps.count == 1
    assert one.gaps.longest == pytest.approx(20.0)


def test_a_slow_channel_of_a_table_has_its_own_rate(recorded):
    t = np.arange(0, 100, 0.1)
    y = np.where(np.arange(len(t)) % 10 == 0, t, np.nan)
    (one,) = recorded(channel("stw", t, y)).channels.values()
    assert one.rate == pytest.approx(1.0)
    assert one.gaps.count == 0


def test_a_clock_that_steps_back_jitters_and_drifts_says_so(recorded):
    rng = np.random.default_rng(1)
    t = np.arange(0, 200, 0.1) + rng.uniform(0, 0.03, 2000)
    late = START + np.rint((t * (1 + 1e-3) + 0.25) * 1e9).astype(np.int64)
    swapped = t.copy()
    swapped[[500, 501]] = swapped[[501, 500]]
    found = recorded(channel("yaw_rate", swapped, np.sin(t), received=late))
    clock = found.channels["yaw_rate"].clock
    assert clock.steps_back == 1
    assert clock.jitter == pytest.approx(np.std(np.diff(t)), rel=0.01)
    assert clock.received.drift == pytest.approx(1e-3, rel=0.01)
    assert clock.received.offset == pytest.approx(0.25 + 0.1, abs=0.01)
    assert any("steps back 1 time" in words for words in found.warnings)
    assert any("drifts by 1e+03 ppm" in words for words in found.warnings)


def test_an_unnamed_rate_of_turn_is_told_by_its_heading(recorded):
    t = np.arange(0, 900, 0.2)
    heading, rate = turning(t)
    found = recorded(
        channel("heading", t, np.degrees(heading) % 360, unit="deg"),
        channel("ch7", t, -np.degrees(rate) * 60),
        channel("ch8", t, np.sin(0.3 * t)),
    )
    guess = found.channels["ch7"].guess
    assert (guess.quantity, guess.how) == ("r", "relation")
    assert "relation to psi" in guess.words
    assert found.channels["ch8"].guess is None
    assert relations.unit_of_rate(found.channels["ch7"], found.channels["heading"]) == "deg/min"


def test_a_multiple_that_no_unit_has_is_no_rate_of_turn(recorded):
    t = np.arange(0, 900, 0.2)
    heading, rate = turning(t)
    found = recorded(
        channel("heading", t, np.degrees(heading), unit="deg"),
        channel("ch7", t, 7.0 * np.degrees(rate)),
    )
    assert found.channels["ch7"].guess is None


def test_the_side_of_a_rudder_is_measured_and_never_taken_from_noise(recorded):
    rng = np.random.default_rng(2)
    t = np.arange(0, 1200, 0.5)
    delta = 10 * np.sign(np.sin(0.05 * t) + 0.3 * np.sin(0.013 * t))
    r = np.zeros(len(t))
    for k in range(len(t) - 1):
        r[k + 1] = r[k] + 0.5 * (-0.05 * delta[k] - r[k]) / 15
    found = recorded(
        channel("rudder", t, delta, unit="deg"),
        channel("rot", t, r + 0.005 * rng.normal(size=len(t)), unit="deg/s"),
        channel("rudder_2", t, rng.normal(size=len(t)), unit="deg"),
    ).channels
    side = relations.side(found["rudder"], found["rot"])
    assert side.side == "port"
    assert side.strength < -0.8
    assert relations.side(found["rudder"], found["rot"], "port").side == "starboard"
    assert relations.side(found["rudder_2"], found["rot"]) is None


def test_two_sources_stay_two_and_the_format_goes_before_the_name(recorded):
    t = np.arange(0, 300, 0.1)
    found = recorded(
        channel("rate_of_turn", t, np.sin(t), unit="deg/s"),
        channel("rudder/11:rate", t[::2], np.sin(t[::2]) + 0.5, unit="deg/s", quantity="r"),
        channel("rot_dead", t, 0 * t, unit="deg/s", quantity="r"),
    )
    first, second, last = found.sources("r")
    assert first.name == "rudder/11:rate"
    assert first.guess.how == "format"
    assert second.name == "rate_of_turn"
    assert last.constant


@pytest.mark.parametrize("speed", ["log:speed", "compass:speed"])
def test_a_true_heading_goes_before_a_magnetic_one(recorded, speed):
    """Whatever else its message has: by a magnetic one wind and current come from elsewhere."""
    t = np.arange(0, 300, 0.1)
    found = recorded(
        channel("compass:magnetic_heading", t, np.sin(t), unit="rad", quantity="psi"),
        channel("gyro:heading", t, np.sin(t), unit="rad", quantity="psi"),
        channel(speed, t, 8.0 + 0.1 * np.sin(t), unit="m/s", quantity="u"),
    )
    assert found.sources("psi")[0].name == "gyro:heading"


def test_sources_in_two_units_are_compared_in_one(recorded):
    t = np.arange(0, 300, 0.1)
    found = recorded(
        channel("rot", t, np.sin(t), unit="deg/s"),
        channel("turn_rate", t, 60 * np.sin(t) + 60, unit="deg/min"),
    )
    (finding,) = findings(found)
    assert "+1 deg/s apart" in finding.sentence
    assert set(finding.about) == {"rot", "turn_rate"}


def test_a_wrong_unit_is_told_with_the_line_that_mends_it(recorded):
    t = np.arange(0, 900, 0.2)
    heading, rate = turning(t)
    found = recorded(
        channel("heading", t, np.degrees(heading) % 360, unit="deg"),
        channel("rot", t, 60 * np.degrees(rate), unit="deg/s"),
    )
    (finding,) = findings(found)
    assert (finding.kind, finding.severity) == ("unit", "error")
    assert finding.mend == 'unit = "deg/min"'


def test_a_quaternion_gives_its_angles(recorded):
    t = np.arange(0, 60, 0.1)
    roll = 0.2 * np.sin(t)
    parts = {"x": np.sin(roll / 2), "y": 0 * t, "z": 0 * t, "w": np.cos(roll / 2)}
    found = recorded(*(channel(f"/imu:orientation.{axis}", t, y) for axis, y in parts.items()))
    # the four fields came in two readings: nothing is made up of half a quaternion
    assert set(found.channels) == {f"/imu:orientation.{axis}" for axis in "xyzw"}


def test_ros_messages_are_known_by_their_names(sample_logs):
    found = inspection.inspect_log(sample_logs / "zigzag-20.mcap")
    roll = found.channels["/imu:orientation (roll)"]
    assert (roll.guess.quantity, roll.angle, roll.unit) == ("phi", "roll", "rad")
    turn = found.channels["/imu:angular_velocity.z"]
    assert (turn.guess.positive, turn.unit, turn.unit_in_name) == ("port", "rad/s", None)


@pytest.fixture
def sample_logs():
    return Path(__file__).parents[2] / "sample_data" / "hidden_effect"


def test_the_sample_logs_are_recognised_in_every_format(sample_logs):
    for path in sorted(sample_logs.iterdir()):
        found = inspection.inspect_log(path)
        assert {q for q in ("delta", "r", "phi", "u") if found.sources(q)} == {
            "delta", "r", "phi", "u",
        }, path  # fmt: skip
        assert found.duration == pytest.approx(1200, abs=1)


def test_files_of_a_folder_are_one_log_with_a_gap_between(tmp_path):
    t = np.arange(0, 60, 0.5)
    for place, start in enumerate((0, 100)):
        csv(tmp_path / f"{place}.csv", {"t": t + start, "rudder": np.sin(t), "x": t})
    found = inspection.inspect_log(tmp_path)
    rudder = found.channels["rudder"]
    assert len(found.files) == 2
    assert rudder.samples == 2 * len(t)
    assert (rudder.gaps.count, rudder.gaps.longest) == (1, pytest.approx(40.5))
    assert found.duration == pytest.approx(159.5)
    assert len(rudder.sketch.t) == 2 * len(t)


def test_wild_stamps_and_two_epochs_are_warned_of(tmp_path):
    one = csv(tmp_path / "wild.csv", {"t": [0.0, 1.0, 8e8], "rudder": [1.0, 2.0, 3.0]})
    assert any("more than a year" in words for words in inspection.inspect_log(one).warnings)


def test_a_log_without_a_number_is_refused(tmp_path):
    log = tmp_path / "words.csv"
    log.write_text("t,a\n0,x\n1,y\n")
    with pytest.raises(LogError, match="holds no channel of numbers; column 'a' holds text"):
        inspection.inspect_log(log)


def test_a_damaged_log_is_surveyed_as_far_as_it_goes(tmp_path, sample_logs):
    whole = (sample_logs / "zigzag-10.mcap").read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole[:60_000])
    found = inspection.inspect_log(cut)
    assert found.duration < 200
    assert any("recovered" in remark for remark in found.files[0].remarks)


def test_a_long_channel_is_sketched_not_kept(recorded):
    t = np.arange(0, 20_000, 0.1)
    (one,) = recorded(channel("roll", t, np.sin(0.01 * t))).channels.values()
    assert one.samples == 200_000
    assert len(one.sketch.t) <= 4000
    assert one.sketch.y == pytest.approx(np.sin(0.01 * (one.sketch.t - START) / 1e9), abs=0.01)


@pytest.mark.real_data
@pytest.mark.skipif(not DATA.is_dir(), reason="no real records beside the repository")
def test_a_real_roll_decay():
    found = inspection.inspect_log(DATA / "kvlcc2_roll_decay" / "model_test_21337.csv")
    assert found.channels["phi"].guess.quantity == "phi"
    assert found.channels["phi"].rate == pytest.approx(100, rel=0.01)
    assert found.channels["theta"].guess is None


@pytest.mark.parametrize(("hole", "gaps"), [(0.25, 0), (0.35, 1), (0.9, 1), (2.5, 1)])
def test_a_gap_is_a_step_of_more_than_three_periods(recorded, hole, gaps):
    t = np.arange(0, 100, 0.1)
    t[500:] += hole - 0.1
    (one,) = recorded(channel("rudder", t, np.sin(t), unit="rad")).channels.values()
    assert one.gaps.count == gaps
    assert one.gaps.total == pytest.approx(hole * gaps)


def test_parts_of_a_log_are_sketched_in_the_order_of_time():
    """The later file first: the sketch of both is that of the whole."""
    t = START + np.arange(0, 4000) * 10**8
    y = np.sin(np.arange(4000) / 300.0)
    early, late = (sketch.sketch(t[part], y[part]) for part in (slice(2000), slice(2000, 4000)))
    joined = sketch.join_sketches([late, early])
    assert (np.diff(joined.t) > 0).all()
    assert joined.y == pytest.approx(np.interp(joined.t - START, t - START, y), abs=0.02)
