"""Stamps of evenly paced sensors: what is repaired, how well, and what is left alone."""

import itertools
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align
from trialid.alignment.clocks import Series
from trialid.alignment.stamps.dejitter import repair_stamps
from trialid.names.quantities import SIGNALS

START = 1_700_000_000_000_000_000
P = 0.1
N = np.arange(6000)
TRUE = N * P


def series(t, y=None, true=None):
    t = np.asarray(t, dtype=float)
    y = np.sin(0.3 * (t if true is None else true)) if y is None else np.asarray(y, dtype=float)
    return Series(SIGNALS["phi"], START + np.rint(t * 1e9).astype(np.int64), y, "made")


def mended(t, true):
    """Repaired stamps less the true ones [s], and the remarks; the motion is at the true ones."""
    made, words = repair_stamps(series(t, true=true))
    return (made.t - START) / 1e9 - true, words


def rng(seed=0):
    return np.random.default_rng(seed)


@pytest.mark.parametrize(
    ("name", "t"),
    [
        ("even", TRUE),
        ("even with a late start", TRUE + 0.0137),
        ("in milliseconds", np.round(N * 0.05003, 3)),
        ("with gaps", np.delete(TRUE, np.r_[100:180, 3000:3003, 5000])),
        ("four", TRUE[:4]),
        ("one", TRUE[:1]),
        ("none", TRUE[:0]),
        ("backwards", TRUE[::-1]),
        ("a drift too slow to see", TRUE * (1 + 3e-4)),
    ],
)
def test_a_well_kept_record_comes_back_bit_for_bit(name, t):
    one = series(t)
    made, words = repair_stamps(one)
    assert made is one
    assert words == ()


@pytest.mark.parametrize(
    ("name", "t", "reason"),
    [
        ("poisson", np.cumsum(rng(1).exponential(P, 5000)), "sent on change, at no even pace"),
        ("on change, in whole periods", np.cumsum(P * rng().integers(1, 10, 2000)), "on change"),
        ("any interval", np.cumsum(rng(2).uniform(0.05, 0.15, 5000)), "at no even pace"),
        ("a loop that sleeps", np.cumsum(P + 0.002 * rng(3).standard_normal(5000)), "pace varies"),
        ("true instants", TRUE + 0.02 * rng(4).standard_normal(len(N)), "smoother on the logged"),
        ("one stamp", 0 * TRUE, "the clock stood still"),
        ("by chance", rng(5).uniform(0, 600, 5000), "logged"),
    ],
)
def test_a_sensor_that_is_not_even_is_left_as_it_is(name, t, reason):
    one = series(t)
    made, words = repair_stamps(one)
    assert made is one
    assert all(reason in word for word in words)
    assert words


@pytest.mark.parametrize(
    ("rms", "lost", "left"),
    [
        (0.010, 0.0, 0.0005),
        (0.010, 0.05, 0.0005),
        (0.028, 0.0, 0.0015),
        (0.028, 0.01, 0.006),
        (0.050, 0.0, 0.003),
    ],
)
def test_jitter_goes_and_lost_messages_are_counted(rms, lost, left):
    keep = rng(6).random(len(N)) >= lost
    t = (TRUE + rms * rng(7).standard_normal(len(N)))[keep]
    off, (word,) = mended(t, TRUE[keep])
    print(f"{off.std() * 1e3:.3f} ms; {word}")
    assert off.std() < left
    assert abs(off.mean() - (t - TRUE[keep]).mean()) < left  # the mean latency stays
    assert float(word.split("index, ")[1].split(" Hz")[0]) == pytest.approx(10, rel=1e-4)
    assert float(word.split("Hz: ")[1].split(" ms")[0]) == pytest.approx(rms * 1e3, rel=0.05)
    assert "their mean latency stays as a delay" in word
    counted = int(word.split(" samples lost")[0].split()[-1])
    assert abs(counted - np.sum(~keep[np.argmax(keep) :])) <= 0.02 * np.sum(~keep) + 1


def test_jitter_of_three_periods():
    """A gyro at 100 Hz over a network: no loss could be counted, none is assumed."""
    true = 0.01 * np.arange(20_000)
    off, (word,) = mended(true + 0.028 * rng(23).standard_normal(len(true)), true)
    print(word)
    assert off.std() < 0.001


def test_latency_that_is_never_early():
    late = rng(8).exponential(0.03, len(N))
    off, _ = mended(TRUE + late, TRUE)
    assert off.std() < 0.001
    assert 0.02 < off.mean() < 0.032


def test_delivered_five_at_a_time_the_last_of_each_is_the_one_in_time():
    last = N // 5 * 5 + 4
    off, (word,) = mended(P * last + 0.01 * np.repeat(rng(9).random(len(N) // 5), 5), TRUE)
    assert off.std() < 0.001
    assert 0.0 < off.mean() < 0.01
    assert "the last of those delivered together; their least latency stays" in word


@pytest.mark.parametrize("phase", [0.0, 0.03, 0.08])
def test_whole_seconds_are_taken_as_cut_off(phase):
    off, (word,) = mended(np.floor(TRUE + phase), TRUE + phase)
    assert off.std() < 0.001
    assert abs(off.mean()) <= P / 2 + 1e-9
    assert "taken as cut to 1 s; if they were rounded, they are 0.5 s late" in word


def test_a_clock_set_back_runs_on():
    t = TRUE + 0.005 * rng(10).standard_normal(len(N)) - 3.27 * (N > 4000)
    off, words = mended(t, TRUE)
    assert np.abs(off).max() < 0.02
    assert any("the clock went back 3.2" in w and "as if no sample was lost" in w for w in words)


def test_of_a_clock_set_back_the_longest_stretch_keeps_its_stamps():
    off, _ = mended(TRUE - 3.27 * (N > 1000), TRUE)
    np.testing.assert_allclose(off, -3.27, atol=1e-6)


@pytest.mark.parametrize("turn", [60.0, 65.536, 3600.0])
def test_a_counter_that_begins_again(turn):
    true = TRUE * (turn / 200.0)
    off, words = mended((true + turn / 3) % turn - turn / 3, true)
    assert np.abs(off).max() < 1e-6
    assert f"the counter began again 3 times after {turn:.10g} s" in words[0]


def test_a_counter_begins_again_on_a_channel_that_is_not_even():
    true = np.cumsum(rng(11).uniform(0.05, 0.15, 3000))
    off, words = mended(true % 60.0, true)
    np.testing.assert_allclose(off, off[0], atol=1e-6)
    assert "began again" in words[0]


def test_gaps_stay_where_they_are():
    true = TRUE + 33.337 * (N > 2000) + 7.7 * (N > 4000)
    off, words = mended(true + 0.01 * rng(12).standard_normal(len(N)), true)
    assert np.abs(off).max() < 0.003
    assert not any("went back" in word for word in words)


def test_a_message_delivered_twice_is_one_sample():
    twice = np.sort(np.concatenate([N, rng(13).integers(0, len(N), 60)]))
    noise = 0.01 * rng(14).standard_normal(len(N))
    made, _ = repair_stamps(series((TRUE + noise)[twice], true=TRUE[twice]))
    again = np.diff(twice) == 0
    assert np.mean(np.diff(made.t)[again] == 0) > 0.95


def test_a_stretch_delivered_again_is_no_clock_that_went_back():
    t = TRUE + 0.01 * rng(15).standard_normal(len(N))
    order = np.concatenate([N[:3000], N[2950:]])
    made, words = repair_stamps(series(t[order], true=TRUE[order]))
    assert not any("went back" in word for word in words)
    np.testing.assert_array_equal(made.t[3000:3050], made.t[2950:3000])
    assert np.abs((made.t - START) / 1e9 - TRUE[order]).max() < 0.002


def test_a_minute_delivered_again_is_no_counter_of_seconds():
    t = TRUE + 0.01 * rng(24).standard_normal(len(N))
    order = np.concatenate([N[:3000], N[2401:]])
    made, words = repair_stamps(series(t[order], true=TRUE[order]))
    assert not any("began again" in word for word in words)
    assert np.abs((made.t - START) / 1e9 - TRUE[order]).max() < 0.002


def test_a_counter_of_seconds_with_one_value_and_the_same_stamps_each_minute():
    made, words = repair_stamps(series(TRUE % 60.0, 0 * TRUE))
    np.testing.assert_allclose((made.t - START) / 1e9, TRUE, atol=1e-6)
    assert "began again 9 times after 60 s" in words[0]


def test_single_wild_stamps_are_put_back():
    t = TRUE + 0.01 * rng(16).standard_normal(len(N))
    t[500] += 40.0
    t[700] -= 1000.0
    off, _ = mended(t, TRUE)
    assert np.abs(off).max() < 0.002


def test_a_drift_is_followed():
    true = TRUE * (1 + 1e-4) + 0.3 * np.sin(2 * np.pi * TRUE / 600)
    off, _ = mended(true + 0.028 * rng(17).standard_normal(len(N)), true)
    assert off.std() < 0.004


def test_values_that_are_not_available_move_with_their_neighbours():
    t = TRUE + 0.028 * rng(18).standard_normal(len(N))
    y = np.sin(0.3 * TRUE)
    y[::7] = np.nan
    made, _ = repair_stamps(series(t, y))
    off = (made.t - START) / 1e9 - TRUE
    assert off[np.isfinite(y)].std() < 0.002
    assert np.isnan(made.y).sum() == np.isnan(y).sum()


def test_two_messages_of_one_stamp_are_not_spread_out():
    one = series(np.repeat(TRUE, 2), np.tile([1.0, 9.0], len(N)))
    made, (word,) = repair_stamps(one)
    assert made is one
    assert "two sources, or each delivered twice" in word
    thrice = series(np.repeat(TRUE, 3), np.repeat(np.sin(TRUE), 3))
    made, (word,) = repair_stamps(thrice)
    assert made is thrice
    assert "repeat one value" in word


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    st.floats(0.01, 5.0),
    st.floats(0.02, 0.14),  # above 0.15 a loss next to an end is hidden in the jitter
    st.integers(60, 2000),
    st.floats(0.0, 0.02),
    st.integers(0, 2**32 - 1),
)
def test_whatever_the_pace_the_repair_is_never_worse_than_the_jitter(
    period, share, count, lost, seed
):
    random = rng(seed)
    keep = random.random(count) >= lost
    true = (period * np.arange(count))[keep]
    jitter = share * period * random.standard_normal(len(true))
    made, _ = repair_stamps(series(true + jitter, np.zeros(len(true))))
    off = (made.t - START) / 1e9 - true
    assert off.std() <= 1.05 * jitter.std()
    again, _ = repair_stamps(made)
    assert np.abs(again.t - made.t).max(initial=0) < 0.06 * period * 1e9


def test_in_more_jitter_the_repair_is_seldom_worse():
    """Ours: 2 of 300, by 1.11 times; what is lost next to an end is then off by one period."""
    worse = []
    for seed in range(300):
        random = rng(seed)
        share, count = random.uniform(0.15, 0.3), int(random.integers(60, 400))
        keep = random.random(count) >= random.uniform(0.0, 0.02)
        true = np.arange(count)[keep] * 0.5
        jitter = share * 0.5 * random.standard_normal(len(true))
        made, _ = repair_stamps(series(true + jitter, np.zeros(len(true))))
        worse.append(((made.t - START) / 1e9 - true).std() / jitter.std())
    print(sum(w > 1.05 for w in worse), max(worse))
    assert sum(w > 1.05 for w in worse) <= 6
    assert max(worse) < 2.0


@pytest.mark.parametrize("lost", [2, 3, 7, 9, 56, 61, 62])
@pytest.mark.parametrize("share", [0.06, 0.1, 0.14])
def test_a_loss_next_to_an_end_is_counted(share, lost):
    random = rng(7)
    true = np.delete(np.arange(65), lost) * 0.5
    jitter = share * 0.5 * random.standard_normal(len(true))
    made, words = repair_stamps(series(true + jitter, np.zeros(len(true))))
    off = (made.t - START) / 1e9 - true
    assert off.std() < jitter.std()
    assert "1 samples lost" in words[0]


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.lists(st.integers(-(10**12), 10**12), min_size=0, max_size=120))
def test_any_stamps_are_survived(stamps):
    t = np.array(stamps, np.int64) + START
    made, words = repair_stamps(Series(SIGNALS["phi"], t, np.zeros(len(t)), ""))
    assert made.t.shape == t.shape
    assert made.t.dtype == np.int64
    assert all(word.startswith("phi: ") for word in words)


@pytest.mark.parametrize("lost", [0.0, 0.01])
def test_a_million_samples_in_a_second(lost):
    count = 1_000_000
    random = rng(19)
    keep = random.random(count) >= lost
    t = (P * np.arange(count) + 0.028 * random.standard_normal(count))[keep]
    one = series(t, true=P * np.arange(count)[keep])
    repair_stamps(series(TRUE + 0.01 * random.standard_normal(len(N))))  # imports
    begin = time.process_time()
    made, _ = repair_stamps(one)
    took = time.process_time() - begin
    print(f"{took:.2f} s")
    assert made is not one
    assert took < 3.0  # 0.5 s on a machine that does nothing else


def test_align_repairs_unless_told_not_to():
    t = np.arange(0.0, 300.0, P)
    late = t + 0.03 * rng(20).standard_normal(len(t))
    gyro = channel("gyro", late, np.sin(0.3 * t))
    log = recording(gyro, channel("roll", t, np.sin(0.3 * t)))
    sources = [SignalSource("r", "gyro", "rad/s"), SignalSource("phi", "roll", "rad")]
    off = []
    for repair in (True, False):
        trial = align("t", "fit", [log], sources, 0.5, repair=repair)
        both = trial.valid["r"] & trial.valid["phi"]
        off.append(np.std((trial.signals["r"] - trial.signals["phi"])[both]))
        assert any("stamps repaired" in remark for remark in trial.remarks) == repair
    assert off[0] < 0.2 * off[1]


def with_received(set_by=0.0, drift=0.0):
    """A channel whose clock is set in the middle while the recorder's runs on."""
    t = TRUE * (1 + drift) + set_by * (N > 3000)
    late = TRUE + 0.02 + 0.004 * rng(21).standard_normal(len(N))
    one = channel("gyro", t, np.sin(0.3 * TRUE))
    received = 1_700_000_000 * 10**9 + np.rint(late * 1e9).astype(np.int64)
    return type(one)("gyro", one.t, one.y, "rad/s", "made", received=received)


def of_one(log_channel):
    return align("t", "fit", [recording(log_channel)], [SignalSource("r", "gyro")], 0.5)


@pytest.mark.parametrize("step", [3.2, -3.2])
def test_a_step_that_the_recorder_did_not_make_is_undone(step):
    trial = of_one(with_received(step))
    print(*trial.remarks, sep="\n")
    assert any(f"its clock was set {step:+.1f}" in remark for remark in trial.remarks)
    assert not any("1 gap" in remark or "went back" in remark for remark in trial.remarks[1:])
    assert trial.duration == pytest.approx(599.5, abs=0.6)
    middle = trial.signals["r"][400:800]
    late = np.sin(0.3 * trial.t[400:800])
    np.testing.assert_allclose(middle, late, atol=0.01)


def test_a_gap_of_both_clocks_is_no_step():
    one = with_received()
    keep = (N < 2500) | (N > 2800)
    cut = type(one)("gyro", one.t[keep], one.y[keep], "rad/s", "made", received=one.received[keep])
    trial = of_one(cut)
    assert not any("was set" in remark for remark in trial.remarks)
    assert any("1 gap" in remark for remark in trial.remarks)


def test_health_of_a_clock_that_drifts():
    (word,) = [w for w in of_one(with_received(drift=50e-6)).remarks if "received" in w]
    print(word)
    assert "jitter 4" in word or "jitter 3.9" in word
    assert "ppm fast" in word
    assert float(word.split("runs ")[1].split(" ppm")[0]) == pytest.approx(50, abs=3)
    (even,) = [w for w in of_one(with_received()).remarks if "received" in w]
    assert "received 20" in even or "received 19.9" in even
    assert "ppm" not in even


def test_the_same_every_time():
    t = TRUE + 0.028 * rng(22).standard_normal(len(N))
    runs = [repair_stamps(series(t)) for _ in range(2)]
    for (one, words), (other, again) in itertools.pairwise(runs):
        np.testing.assert_array_equal(one.t, other.t)
        assert words == again
