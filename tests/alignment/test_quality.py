import numpy as np
import pytest
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align

T = np.arange(0, 200, 0.1)


def remarks_on(t, y, quantity="r", unit="rad/s", **more):
    log = recording(channel("x", t, y, **more))
    side = "starboard" if quantity.startswith("delta") else None
    return align("t", "fit", [log], [SignalSource(quantity, "x", unit, side)], 0.5).remarks


def swing(t):
    return np.sin(0.5 * t)


def test_a_clean_channel_says_rate_clock_and_filter_only():
    assert remarks_on(T, swing, clock="header stamp") == (
        "r: 2000 samples, 10 Hz, header stamp",
        "all signals low-pass filtered alike, half amplitude at 0.6 Hz; "
        "2.5 s at each end and beside each gap masked",
    )


def test_gaps_are_counted_and_placed():
    kept = ~(((T > 50) & (T < 62.5)) | ((T > 100) & (T < 110)))
    assert "r: 2 gaps, 22.5 s in all, at 50.0-62.5 s, 100.0-110.0 s; masked" in remarks_on(
        T[kept], swing
    )


def test_missing_values_at_both_ends_are_gaps():
    y = swing(T)
    y[T < 20] = np.nan
    y[T > 180] = np.nan
    found = remarks_on(T, y)
    assert "r: 399 of 2000 values not available" in found
    assert "r: 2 gaps, 39.5 s in all, at 0.0-20.0 s, 180.0-199.5 s; masked" in found


def test_duplicates_and_steps_back():
    t = np.concatenate([T[:1000], T[990:]])
    found = remarks_on(t, swing)
    assert "r: time steps back 1 time, by up to 0.9 s; sorted" in found
    assert "r: 10 samples with the stamp of another one dropped" in found


@pytest.mark.parametrize(("back", "told"), [(3599.5, True), (3605.0, True), (1800.0, False)])
def test_a_clock_set_back_by_an_hour_is_asked_for(back, told):
    t = np.arange(0.0, 4000.0, 0.5)
    found = remarks_on(np.concatenate([t, t[-1] - back + t]), swing)
    words = next(one for one in found if "steps back" in one)
    assert f"by up to {back:.4g} s" in words
    assert ("a local clock set back by an hour" in words) == told


def test_of_two_samples_with_one_stamp_the_first_logged_stays():
    t = np.arange(0, 100, 0.5)
    log = recording(channel("x", np.repeat(t, 2), np.tile([1.0, 9.0], len(t))))
    trial = align("t", "fit", [log], [SignalSource("u", "x", "m/s")], 0.5)
    np.testing.assert_array_equal(trial.signals["u"], 1.0)


@pytest.mark.parametrize(("spread", "remarked"), [(0.01, False), (0.04, True)])
def test_jitter(spread, remarked):
    t = T + np.random.default_rng(8).uniform(-spread, spread, len(T))
    assert any("stamps jitter" in remark for remark in remarks_on(t, swing)) == remarked


def test_a_dead_sensor_and_a_rudder_that_stays_are_remarked_not_refused():
    assert "r: constant at 0.25 rad/s throughout; is the sensor alive?" in remarks_on(
        T, 0.25 + 0 * T
    )
    assert "delta: constant at 0.1 rad throughout; is the sensor alive?" in remarks_on(
        T, 0.1 + 0 * T, "delta", "rad"
    )


def test_a_motion_that_freezes_for_a_while():
    y = swing(T)
    y[(T > 60) & (T < 100)] = 0.3
    assert "r: does not change from 60.1 to 99.9 s; stuck?" in remarks_on(T, y)
    rudder = remarks_on(T, y, "delta", "rad")
    assert not any("stuck" in remark for remark in rudder)


@pytest.mark.parametrize(("noise", "told"), [(0.002, True), (0.0, False)])
def test_a_rudder_is_stuck_where_its_noise_rests(noise: float, told: bool) -> None:
    """A zig-zag's order rests at each angle, a feedback that freezes does so once."""
    y = 0.2 * np.sign(np.sin(0.3 * T)) + noise * np.random.default_rng(5).standard_normal(len(T))
    y[(T > 60.0) & (T < 100.0)] = 0.15
    said = remarks_on(T, y, "delta", "rad")
    assert any(one.endswith("s; stuck?") for one in said) == told


def test_signals_by_different_clocks():
    log = recording(
        channel("a", T, swing, clock="header stamp"), channel("b", T, swing, clock="log")
    )
    sources = [SignalSource("r", "a", "rad/s"), SignalSource("p", "b", "rad/s")]
    assert (
        "different clocks, the delay between them is not known: r by header stamp; p by log"
        in align("t", "fit", [log], sources, 0.5).remarks
    )


def test_what_rounding_adds_is_told_as_a_share_of_the_motion():
    """Against the rounding itself: whole tenths of a motion of one, seen without a filter."""
    t = np.arange(0, 200, 0.5)
    y = np.round(5.0 * swing(t)) / 5.0
    (said,) = (word for word in remarks_on(t, y) if "an error of" in word)
    share = float(said.partition("an error of ")[2].partition("%")[0]) / 100.0
    assert share == pytest.approx(np.std(y - swing(t)) / np.std(y), rel=0.1)


def test_what_is_wrong_outside_a_trials_window_is_not_told_of_it():
    t = np.arange(0.0, 200.0, 0.1)
    heading = 0.3 * np.sin(0.05 * t) + 1e-3 * np.random.default_rng(3).normal(size=len(t))
    log = recording(channel("psi", t, np.where(t < 80.0, heading, heading + 0.2)))
    told = [
        align("t", "fit", [log], [SignalSource("psi", "psi", "rad")], 0.5, window).remarks
        for window in ((0.0, 70.0), (0.0, 90.0))
    ]
    before, across = (sum("jumped" in words for words in each) for each in told)
    assert (before, across) == (0, 1)


@pytest.mark.parametrize(("senders", "told"), [(1, False), (2, True), (3, True)])
def test_two_compasses_by_turns_in_a_channel_are_asked_for(senders, told):
    noise = np.random.default_rng(4100).normal(0.0, 0.002, len(T))
    y = 0.3 * swing(T) + noise + 0.03 * (np.arange(len(T)) % senders == 0)
    found = [one for one in remarks_on(T, y, "psi", "rad") if "in turn" in one]
    assert bool(found) == told
    if told:
        assert f"psi: {senders} series in turn, " in found[0]
        assert "deg apart: as many sensors in one channel?" in found[0]


@pytest.mark.parametrize("noise", [0.0, 0.05, 3.0])
def test_a_sensor_that_is_noisy_or_coarse_is_one(noise):
    y = swing(T) + noise * np.random.default_rng(4101).normal(size=len(T)).clip(-0.5, 0.5)
    for step in (1e-6, 0.1, 1.0):
        assert not any("in turn" in one for one in remarks_on(T, step * np.round(y / step)))
    dithers = 0.1 * (np.arange(len(T)) % 2)  # between two counts, as roll at rest is
    assert not any("in turn" in one for one in remarks_on(T, dithers))
