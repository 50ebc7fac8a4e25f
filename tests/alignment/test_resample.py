import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align, resample
from trialid.alignment.clocks import Grid, Series
from trialid.names.quantities import SIGNALS

PERIOD = 0.5
START = 1_700_000_000_000_000_000


def series(quantity, t, y):
    return Series(SIGNALS[quantity], START + np.rint(np.asarray(t) * 1e9).astype(np.int64), y, "")


def grid(duration, period=PERIOD, start=0.0):
    return Grid(START + round(start * 1e9), period, int(duration / period) + 1)


def motion(t):
    """Two waves of a ship's roll, 10 s and 25 s."""
    return np.sin(2 * np.pi * 0.1 * t) + 0.3 * np.sin(2 * np.pi * 0.04 * t + 1)


def jittered(rate, jitter, seed=0, duration=300):
    """Stamps [s] that scatter by up to `jitter` of a period, starting at an odd instant."""
    rng = np.random.default_rng(seed)
    count = int(duration * rate)
    return 0.0137 + (np.arange(count) + rng.uniform(-jitter, jitter, count)) / rate


@pytest.mark.parametrize(
    ("rate", "jitter", "error"),
    [
        (50, 0.0, 6e-4),
        (50, 0.3, 6e-4),
        (20, 0.3, 6e-4),
        (10, 0.0, 6e-4),
        (10, 0.3, 6e-4),
        (4, 0.3, 1e-3),
        (2, 0.0, 2e-3),
        (1, 0.0, 0.02),
        (1, 0.3, 0.04),
    ],
)
def test_a_known_motion_from_any_rate(rate, jitter, error):
    """Rms error as a share of the motion's rms, beside a channel that calls for the filter."""
    log = recording(
        channel("fast", np.arange(0, 300, 0.02), motion),
        channel("x", jittered(rate, jitter), motion),
    )
    sources = [SignalSource("p", "fast", "rad/s"), SignalSource("r", "x", "rad/s")]
    trial = align("t", "fit", [log], sources, PERIOD)
    start = max(log.channels["fast"].t[0], log.channels["x"].t.min()) / 1e9 - 1.7e9
    true = motion(trial.t + start)
    for name in ("p", "r"):
        valid = trial.valid[name]
        assert valid.mean() > 0.98
        found = np.sqrt(np.mean((trial.signals[name] - true)[valid] ** 2)) / np.std(true)
        assert found < (error if name == "r" else 6e-4)


def test_vibration_does_not_fold_into_the_motion():
    """50 Hz with 12.4 Hz vibration, to 2 Hz: taking every 25th sample would leave all of it."""
    t = np.arange(0, 300, 0.02)
    vibration = np.sin(2 * np.pi * 12.4 * t)
    y, valid = resample.resample(series("r", t, vibration), grid(299), smooth=True)
    assert np.abs(y[valid]).max() < 1e-4
    assert np.abs(vibration[::25]).max() > 0.9
    y, valid = resample.resample(series("r", t, motion(t) + vibration), grid(299), smooth=True)
    assert np.abs(y - motion(t[::25][: len(y)]))[valid].max() < 2e-3


def test_the_filter_is_the_one_the_docstrings_state():
    """Gain over frequency as a share of the grid's Nyquist frequency, up to the fine grid's."""
    steps = resample.FINEST
    t = np.arange(-resample.HALF_LENGTH * steps, resample.HALF_LENGTH * steps + 1) / steps
    frequency = np.linspace(0, steps, 2001)
    gain = np.cos(np.pi * np.outer(frequency, t)) @ resample.kernel(steps)
    assert np.abs(gain[frequency < 0.27] - 1).max() < 0.003
    assert np.interp(resample.CUT_OFF, frequency, gain) == pytest.approx(0.5, abs=0.01)
    assert np.abs(gain[frequency > 0.95]).max() < 0.003


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    st.sampled_from([1.0, 2.0, 4.0, 10.0, 12.5, 50.0]),
    st.floats(0.0, 0.4),
    st.floats(-5.0, 5.0),
    st.integers(0, 99),
)
def test_a_static_relation_survives(rate, jitter, gain, seed):
    """The same filter on input and output: y = gain u before is y = gain u after, noise and all."""
    t = jittered(rate, jitter, seed, duration=100)
    u = np.random.default_rng(seed).normal(size=len(t))
    on = grid(90, start=3.0)
    for smooth in (True, False):
        y, _ = resample.resample(series("p", t, u), on, smooth=smooth)
        other, _ = resample.resample(series("r", t, gain * u), on, smooth=smooth)
        assert np.abs(other - gain * y).max() < 1e-9


def test_a_static_relation_between_rudder_and_turn_survives_on_a_common_clock():
    """Sampled in step with the grid, linear and PCHIP interpolation give the same."""
    t = np.arange(0, 100, 0.02)
    u = np.random.default_rng(2).normal(size=len(t))
    rudder, _ = resample.resample(series("delta", t, u), grid(99), smooth=True)
    turn, _ = resample.resample(series("r", t, 2 * u), grid(99), smooth=True)
    assert np.abs(turn - 2 * rudder).max() < 1e-9


def test_the_filter_is_without_delay_and_the_same_for_a_slow_channel():
    """A symmetric pulse stays where it is, at 50 Hz and at 1 Hz alike."""
    for rate in (50.0, 1.0):
        t = np.arange(0, 100, 1 / rate)
        y, _ = resample.resample(
            series("r", t, np.exp(-(((t - 40) / 8) ** 2))), grid(99), smooth=True
        )
        instants = np.arange(len(y)) * PERIOD
        assert np.sum(instants * y) / np.sum(y) == pytest.approx(40.0, abs=1e-3)


def test_nobody_is_filtered_when_nobody_is_faster_than_the_grid():
    rng = np.random.default_rng(4)
    t = np.arange(0, 100, 0.5)
    noise = rng.normal(size=len(t))
    log = recording(channel("r", t, noise), channel("slow", t[::4], noise[::4]))
    sources = [SignalSource("r", "r", "rad/s"), SignalSource("p", "slow", "rad/s")]
    trial = align("t", "fit", [log], sources, 0.5)
    np.testing.assert_allclose(trial.signals["r"], noise[: trial.samples], atol=1e-9)
    assert not any("low-pass" in remark for remark in trial.remarks)
    assert "p: one sample in 2 s, interpolated to 0.5 s" in trial.remarks


def test_everybody_is_filtered_when_somebody_is_faster():
    t = np.arange(0, 100, 0.1)
    log = recording(channel("r", t, motion), channel("slow", t[::10], motion))
    sources = [SignalSource("r", "r", "rad/s"), SignalSource("p", "slow", "rad/s")]
    trial = align("t", "fit", [log], sources, 0.5)
    for name in ("r", "p"):
        assert np.flatnonzero(~trial.valid[name][:100]).tolist() == [0, 1, 2, 3, 4]
    assert np.flatnonzero(~trial.valid["p"][100:]).tolist() == [94, 95, 96, 97, 98]
    assert any("low-pass filtered alike, half amplitude at 0.6 Hz" in r for r in trial.remarks)


@pytest.mark.parametrize("smooth", [True, False])
@pytest.mark.parametrize("rate", [2.0, 10.0])
def test_a_gap_is_masked_and_never_bridged(smooth, rate):
    """What follows the gap plays no part before it; inside there is a straight line."""
    t = np.arange(0, 100, 1 / rate)
    kept = (t <= 40) | (t >= 60)
    on = grid(99)
    first, valid = resample.resample(series("r", t[kept], motion(t)[kept]), on, smooth=smooth)
    second, _ = resample.resample(
        series("r", t[kept], np.where(t > 50, 100 - t, motion(t))[kept]), on, smooth=smooth
    )
    margin = 2.5 if smooth else 0.0
    inside = (on.t > 40 - margin) & (on.t < 60 + margin)
    np.testing.assert_array_equal(valid[5:-5], ~inside[5:-5])
    np.testing.assert_array_equal(first[on.t <= 40], second[on.t <= 40])
    line = first[(on.t >= 40) & (on.t <= 60)]
    assert np.abs(np.diff(line, 2)).max() < 1e-9


def test_missing_values_are_a_gap_like_missing_stamps():
    t = np.arange(0, 100, 0.5)
    y = motion(t)
    y[(t > 40) & (t < 60)] = np.nan
    kept = np.isfinite(y)
    for smooth in (True, False):
        by_value = resample.resample(series("r", t, y), grid(99), smooth=smooth)
        by_stamp = resample.resample(series("r", t[kept], y[kept]), grid(99), smooth=smooth)
        np.testing.assert_array_equal(by_value[0], by_stamp[0])
        np.testing.assert_array_equal(by_value[1], by_stamp[1])


def test_what_is_a_gap():
    """More than 3 periods of the channel and more than 2 of the grid."""
    on = 0.5
    for rate, missing, is_gap in [(10, 9, False), (10, 10, True), (2, 2, False), (2, 3, True)]:
        t = np.arange(0, 60, 1 / rate)
        hole = np.delete(t, np.arange(20, 20 + missing))
        one = series("r", hole, motion(hole))
        step = resample.longest_step(one, on)
        assert (len(resample.stretches(hole, step)) > 1) == is_gap


def test_before_the_first_and_after_the_last_value_the_value_is_held():
    t = np.arange(0, 100, 0.5)
    y = motion(t)
    y[t < 20] = np.nan
    y[t > 80] = np.nan
    value, valid = resample.resample(series("r", t, y), grid(99), smooth=False)
    assert not valid[:40].any()
    assert valid[40:161].all()
    assert not valid[161:].any()
    assert np.ptp(value[:41]) == 0
    assert np.ptp(value[160:]) == 0


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.floats(-0.2, 0.2), st.sampled_from([1.0, 4.0, 20.0]), st.booleans())
def test_heading_is_unwrapped_before_anything_else(turn, rate, smooth):
    t = np.arange(0, 120, 1 / rate)
    heading = 6.0 + turn * t
    y, valid = resample.resample(series("psi", t, heading % (2 * np.pi)), grid(119), smooth=smooth)
    expected = heading[0] % (2 * np.pi) + turn * np.arange(len(y)) * PERIOD
    assert np.abs(y - expected)[valid].max() < 1e-9


def test_an_unwrapped_heading_survives_a_missing_value():
    t = np.arange(0, 60, 0.5)
    heading = 6.0 + 0.1 * t
    logged = heading % (2 * np.pi)
    logged[5] = np.nan
    y, _ = resample.resample(series("psi", t, logged), grid(59), smooth=False)
    np.testing.assert_allclose(y, heading[: len(y)], atol=1e-9)


def test_a_rudder_step_does_not_overshoot():
    t = np.arange(0, 60, 1.0)
    y, _ = resample.resample(series("delta", t, np.where(t < 30, 0.0, 0.2)), grid(59), smooth=False)
    assert y.min() >= 0.0
    assert y.max() <= 0.2
    np.testing.assert_allclose(y[58:61], [0.0, 0.1, 0.2])


def test_a_single_sample_between_two_gaps():
    t = np.concatenate([np.arange(0, 20, 0.5), [40.0], np.arange(60, 80, 0.5)])
    for smooth in (True, False):
        value, valid = resample.resample(series("r", t, motion(t)), grid(79), smooth=smooth)
        assert np.isfinite(value).all()
        assert valid[80] == (not smooth)


def test_a_rudder_moves_in_ramps_and_never_beyond_its_samples():
    """Sampled once a second, with corners between; half a second later it is half way."""
    t = np.arange(0.0, 40.0)
    ramp = np.clip((t - 10.0) * 0.04, 0.0, 0.2)
    (y, valid), (turning, _) = (
        resample.resample(series(name, t, ramp), grid(39.0), smooth=False)
        for name in ("delta", "r")
    )
    lines = np.clip((grid(39.0).t - 10.0) * 0.04, 0.0, 0.2)
    np.testing.assert_allclose(y, lines, atol=1e-12)
    assert valid.all()
    assert np.abs(turning - lines).max() > 1e-3  # a motion has no corners


def test_half_of_the_filter_is_not_believed_at_either_end_of_a_stretch():
    """Five periods of half a second at both ends of the record and on both sides of its gap."""
    t = np.delete(np.arange(0.0, 100.0, 0.1), np.s_[400:600])
    _, valid = resample.resample(series("r", t, motion(t)), grid(99.5), smooth=True)
    at = grid(99.5).t
    expected = ((at >= 2.5) & (at <= 37.4)) | ((at >= 62.5) & (at <= 97.4))
    np.testing.assert_array_equal(valid, expected)
