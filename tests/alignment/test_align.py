import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align
from trialid.errors import AlignmentError, LogError, UnitError
from trialid.trial import LogSource

T = np.arange(0, 200, 0.5)
ROLL = SignalSource("phi", "roll", "deg")
RUDDER = SignalSource("delta", "rudder", "deg", "starboard")


def roll(t):
    return 5 * np.sin(0.4 * t) + 2 * np.sin(0.11 * t + 1)


def step(t):
    return 10.0 * np.sign(np.sin(0.05 * t))


@pytest.fixture
def log():
    """Rudder and roll, logged together every 0.5 s."""
    return recording(channel("rudder", T, step), channel("roll", T, roll))


def refused(error, *arguments):
    with pytest.raises(error) as caught:
        align(*arguments)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith("trial 'zigzag'")
    return message


def with_sources(log, *sources, window=None, period=0.5):
    return ("zigzag", "fit", [log], list(sources), period, window)


def test_samples_already_on_the_grid_are_kept_as_they_are(log):
    trial = align("zigzag", "check", [log], [RUDDER, ROLL], 0.5, None)
    assert (trial.name, trial.use, trial.period, trial.samples) == ("zigzag", "check", 0.5, len(T))
    np.testing.assert_allclose(trial.signals["delta"], np.radians(step(T)), rtol=0, atol=1e-15)
    np.testing.assert_allclose(trial.signals["phi"], np.radians(roll(T)), rtol=0, atol=1e-12)
    assert all(mask.all() for mask in trial.valid.values())
    assert trial.logs == (LogSource("trial.log", "0" * 64, "csv"),)


def test_what_the_adapter_noticed_is_in_the_trial():
    log = recording(channel("roll", T, roll), path="x/day.mcap", remarks=("cut short",))
    trial = align("zigzag", "fit", [log], [ROLL], 0.5, None)
    assert "day.mcap: cut short" in trial.remarks
    assert "phi: 400 samples, 2 Hz, column t" in trial.remarks


def test_positive_to_port_is_turned_round():
    log = recording(channel("rudder", T, step), channel("roll", T, roll))
    port = SignalSource("delta", "rudder", "deg", "port")
    trial = align("zigzag", "fit", [log], [port, SignalSource("phi", "roll", "deg", "port")], 0.5)
    np.testing.assert_allclose(trial.signals["delta"], -np.radians(step(T)), atol=1e-15)
    np.testing.assert_allclose(trial.signals["phi"], -np.radians(roll(T)), atol=1e-12)


def test_the_common_clock_and_the_window():
    log = recording(
        channel("rudder", np.arange(10.0, 150, 0.5), step), channel("roll", np.arange(7, 120), roll)
    )
    trial = align("zigzag", "fit", [log], [RUDDER, ROLL], 0.5, None)
    assert trial.duration == 109.0  # from 10 s, where the rudder begins, to the last roll, 119 s
    part = align("zigzag", "fit", [log], [RUDDER, ROLL], 0.5, (20.0, 50.0))
    assert (part.duration, trial.opening, part.opening) == (30.0, 0.0, 20.0)
    np.testing.assert_array_equal(part.signals["phi"], trial.signals["phi"][40:101])
    long = align("zigzag", "fit", [log], [RUDDER, ROLL], 0.5, (20.0, 500.0))
    assert long.duration == 89.0
    assert any("before the window does" in remark for remark in long.remarks)


@settings(max_examples=30, deadline=None, derandomize=True)
@given(st.floats(0.0, 3.0), st.floats(0.3, 4.0), st.floats(-1e9, 1e9))
def test_a_declared_delay_moves_a_channel_back(delay, rate, epoch):
    t = np.arange(0, 100, 1 / rate)
    late = channel("r", t + delay, 0.001 * t, epoch=round(epoch))
    log = recording(channel("phi", t, 0.002 * t, epoch=round(epoch)), late)
    sources = [SignalSource("phi", "phi", "rad"), SignalSource("r", "r", "rad/s", delay=delay)]
    trial = align("zigzag", "fit", [log], sources, 0.5)
    both = trial.valid["phi"] & trial.valid["r"]
    difference = trial.signals["phi"] - 2 * trial.signals["r"]
    assert np.abs(difference[both]).max() < 1e-9


def test_a_window_is_filtered_with_what_lies_around_it():
    t = np.arange(0, 200, 0.05)
    log = recording(channel("roll", t, roll))
    whole = align("zigzag", "fit", [log], [ROLL], 0.5)
    part = align("zigzag", "fit", [log], [ROLL], 0.5, (50.0, 100.0))
    assert part.valid["phi"].all()
    np.testing.assert_allclose(part.signals["phi"], whole.signals["phi"][100:201], atol=1e-12)


def test_signals_from_two_logs_of_one_trial():
    logs = [
        recording(channel("rudder", T, step), path="a.csv"),
        recording(channel("roll", T + 20, roll), path="b.csv"),
    ]
    trial = align("zigzag", "fit", logs, [RUDDER, ROLL], 0.5, None)
    np.testing.assert_allclose(trial.signals["phi"], np.radians(roll(T[40:])), atol=1e-12)
    assert [source.path for source in trial.logs] == ["a.csv", "b.csv"]


def test_a_log_split_by_the_hour_is_one_channel_but_with_a_gap_where_it_was_split():
    logs = [
        recording(channel("roll", T[:200], roll), path="1.csv"),
        recording(channel("roll", T[220:], roll), path="2.csv"),
    ]
    trial = align("zigzag", "fit", logs[::-1], [ROLL], 0.5, None)
    assert trial.samples == len(T)
    assert np.flatnonzero(~trial.valid["phi"]).tolist() == list(range(200, 220))


def test_one_channel_in_two_logs_at_the_same_time(log):
    twin = recording(channel("roll", T, roll), path="twin.log")
    message = refused(AlignmentError, "zigzag", "fit", [log, twin], [ROLL], 0.5, None)
    assert "channel 'roll' is in trial.log or twin.log for the same time" in message


def test_an_unknown_channel_names_the_nearest(log):
    message = refused(LogError, *with_sources(log, SignalSource("phi", "rol", "deg")))
    assert message == (
        "trial 'zigzag', signal 'phi': no channel 'rol' in trial.log; did you mean 'roll'?"
    )


def test_an_unknown_quantity_names_the_nearest(log):
    message = refused(AlignmentError, *with_sources(log, SignalSource("delat", "roll", "deg")))
    assert "signal 'delat': no quantity of that name (did you mean 'delta'" in message


def test_the_sign_of_a_rudder_is_never_guessed(log):
    for quantity in ("delta", "delta_order"):
        message = refused(
            AlignmentError, *with_sources(log, SignalSource(quantity, "rudder", "deg"))
        )
        assert 'add positive = "starboard" or positive = "port"' in message


def test_speed_has_no_side():
    log = recording(channel("stw", T, 5 + 0 * T))
    message = refused(AlignmentError, *with_sources(log, SignalSource("u", "stw", "kn", "port")))
    assert 'has no port or starboard; remove positive = "port"' in message


def test_units():
    log = recording(channel("r", T, roll, "deg/min"), channel("u", T, 0 * T + 10))
    sources = [SignalSource("r", "r"), SignalSource("u", "u", "kn")]
    trial = align("zigzag", "fit", [log], sources, 0.5)
    np.testing.assert_allclose(trial.signals["r"], np.radians(roll(T)) / 60, atol=1e-12)
    np.testing.assert_allclose(trial.signals["u"], 5.144444444, rtol=1e-9)
    same = align("zigzag", "fit", [log], [SignalSource("r", "r", "degree/minute")], 0.5)
    np.testing.assert_array_equal(same.signals["r"], trial.signals["r"])


def test_wrong_units():
    log = recording(channel("r", T, roll, "deg/min"), channel("u", T, roll))
    message = refused(AlignmentError, *with_sources(log, SignalSource("r", "r", "deg/s")))
    assert "the log states 'deg/min' for 'r', the pipeline 'deg/s'" in message
    message = refused(AlignmentError, *with_sources(log, SignalSource("u", "u")))
    assert "neither the log nor the pipeline states the unit of 'u'; add unit = \"m/s\"" in message
    message = refused(UnitError, *with_sources(log, SignalSource("u", "u", "knts")))
    assert "signal 'u': unit 'knts' is not known" in message
    message = refused(UnitError, *with_sources(log, SignalSource("u", "u", "deg")))
    assert "unit 'deg' cannot become 'm/s'; units that can: km/h, kn, m/s" in message


def test_a_signal_given_twice_and_none_at_all(log):
    assert "signal 'phi' is given twice" in refused(AlignmentError, *with_sources(log, ROLL, ROLL))
    assert "no signals; name at least" in refused(AlignmentError, *with_sources(log))


@pytest.mark.parametrize("period", [0.0, -1.0, np.nan, np.inf])
def test_the_period_is_above_zero(log, period):
    assert "period = " in refused(AlignmentError, *with_sources(log, ROLL, period=period))


@pytest.mark.parametrize("window", [(50, 20), (-5, 20), (300, 400), (20, 20)])
def test_windows_outside_of_the_trial(log, window):
    message = refused(AlignmentError, *with_sources(log, ROLL, window=window))
    assert "and lie in the 199.5 s that all channels cover" in message


def test_a_trial_too_short_for_its_period(log):
    message = refused(AlignmentError, *with_sources(log, ROLL, period=100.0))
    assert "199.5 s hold 2 samples 100 s apart, at least 4 are needed" in message


def test_a_channel_without_a_single_value():
    log = recording(channel("roll", T, T * np.nan))
    message = refused(AlignmentError, *with_sources(log, ROLL))
    assert "signal 'phi': not one of 400 values is available, all are NaN" in message


@pytest.mark.parametrize("count", [0, 3])
def test_a_channel_with_too_few_samples(count):
    log = recording(channel("roll", T[:count], roll), channel("rudder", T, step))
    message = refused(AlignmentError, *with_sources(log, ROLL, RUDDER))
    assert f"signal 'phi': {count} values with distinct stamps, at least 4" in message


def test_channels_that_do_not_overlap_say_both_intervals():
    log = recording(channel("rudder", T, step), channel("roll", T + 1000, roll))
    message = refused(AlignmentError, *with_sources(log, RUDDER, ROLL))
    assert "phi (2023-11-14T22:30:00.000 to 2023-11-14T22:33:19.500)" in message
    assert "delta (2023-11-14T22:13:20.000 to 2023-11-14T22:16:39.500)" in message
    other = recording(channel("rudder", T, step, epoch=0), channel("roll", T, roll))
    assert "delta (0.000 s to 199.500 s)" in refused(
        AlignmentError, *with_sources(other, RUDDER, ROLL)
    )


def test_a_wild_stamp_does_not_fill_the_memory():
    log = recording(channel("roll", np.append(T, 1e9), roll(np.append(T, 0))))
    assert "a stamp is wild" in refused(AlignmentError, *with_sources(log, ROLL, period=0.01))


def test_nothing_usable_in_the_window():
    hole = np.concatenate([T[:100], T[300:]])
    log = recording(channel("roll", hole, roll), channel("rudder", T, step))
    message = refused(AlignmentError, *with_sources(log, ROLL, RUDDER, window=(60, 140)))
    assert "nothing of phi is usable in the 80 s of the trial: 0 values there" in message


def test_signals_are_finite_everywhere_whatever_the_log_holds():
    rng = np.random.default_rng(11)
    y = roll(T)
    y[rng.integers(0, len(T), 150)] = np.nan
    y[50:120] = np.inf
    y[:7] = -np.inf
    trial = align("zigzag", "fit", [recording(channel("roll", T, y))], [ROLL], 0.37)
    assert np.isfinite(trial.signals["phi"]).all()
    assert 0 < trial.valid["phi"].mean() < 1
    assert not re.search(r"nan|inf", " ".join(trial.remarks))
