"""A rate that is not the slope of its angle stays with the trial, with the line that mends it."""

import numpy as np
import pytest
from aligned_records import aligned, healthy, with_values
from real_channels import series
from scipy.signal import lfilter

from trialid.alignment.agreement import checks
from trialid.alignment.agreement.rate_drift import drift_of, late_of
from trialid.trial import Trial


@pytest.fixture(scope="module")
def zigzag():
    """A zig-zag in a calm sea with good sensors."""
    return healthy(155)


@pytest.mark.parametrize("delay", [1.0, 3.0, 8.8])
def test_a_late_rate_of_turn_is_mended_by_a_delay(zigzag, delay):
    one = zigzag["r"]
    late = {**zigzag, "r": series("r", one.t + round(delay * 1e9), one.y)}
    [apart] = aligned(late).contradictions
    assert (apart.rate, apart.angle, apart.factor) == ("r", "psi", 1.0)
    assert apart.late == pytest.approx(delay, abs=0.3)
    assert apart.sentence.endswith(" in r would mend it")


@pytest.mark.parametrize("gain", [0.8, 0.92, 0.95, 1.06, 1.08, 1.12])
def test_a_rate_that_reads_less_than_the_heading_turns_is_mended_by_a_gain(zigzag, gain):
    """No compass is wrong by a factor over whole turns; 1.08 ended in `nothing missing`."""
    less = with_values(zigzag, "r", gain * zigzag["r"].y)
    [apart] = aligned(less).contradictions
    assert (apart.late, apart.factor) == (0.0, pytest.approx(gain, abs=0.01))
    mends = float(apart.sentence.split("; gain = ")[1].removesuffix(" in r would mend it"))
    assert mends == pytest.approx(1.0 / gain, abs=0.01)


@pytest.mark.parametrize("gain", [0.98, 1.0, 1.02])
def test_gyros_as_they_are_contradict_no_heading(zigzag, gain):
    assert aligned(with_values(zigzag, "r", gain * zigzag["r"].y)).contradictions == ()


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_gyro_that_drifts_beside_a_heading_is_told_with_how_far(zigzag, sign):
    """Of 0.3 deg/s in 500 s `displacement_error` was the closest, and no word of the gyro."""
    one = zigzag["r"]
    share = (one.t - one.t[0]) / (one.t[-1] - one.t[0])
    far = sign * 0.5 * float(np.std(one.y))
    [apart] = aligned(with_values(zigzag, "r", one.y + far * share)).contradictions
    assert (apart.late, apart.factor) == (0.0, 1.0)
    assert apart.drift == pytest.approx(far, rel=0.05)
    assert apart.sentence.endswith("which no zero of a sensor does; leave r out, psi tells it")


def test_a_gyro_whose_zero_is_off_or_that_hardly_drifts_is_as_gyros_are(zigzag):
    one = zigzag["r"]
    share, moves = (one.t - one.t[0]) / (one.t[-1] - one.t[0]), float(np.std(one.y))
    for off in (0.5 * moves, 0.05 * moves * share):
        assert aligned(with_values(zigzag, "r", one.y + off)).contradictions == ()


@pytest.mark.parametrize("gain", [0.8, 1.2])
def test_a_gain_is_no_drift_however_she_turns(gain):
    """Of a turn that quickens evenly both leave a parabola: nobody can tell one from the other."""
    t = np.arange(0.0, 100.0, 0.1)
    known = np.ones(len(t), np.bool_)
    assert drift_of(gain * 0.001 * t, 0.0005 * t**2, known, 0.1) == 0.0
    assert drift_of(0.01 * np.sin(t) + 0.001 * t, 0.01 * (1.0 - np.cos(t)), known, 0.1) > 0.09


@pytest.mark.parametrize("times", [-0.3, 0.3, 5.0])
def test_roll_that_goes_with_her_turns_is_not_taken_for_their_rate(zigzag, times):
    """A gyro read a fifth; her roll went with the turns as any does, at another size."""
    c = {**zigzag, "phi": series("phi", zigzag["r"].t, times * zigzag["r"].y)}
    less = with_values(c, "r", 0.2 * zigzag["r"].y)
    [found] = [one for one in checks.of_series(less) if one.severity == "error"]
    assert "exchanged" not in found.sentence


def test_where_the_heading_is_late_the_delay_is_its_own(zigzag):
    one = zigzag["psi"]
    late = {**zigzag, "psi": series("psi", one.t + 3 * 10**9, one.y)}
    [apart] = aligned(late).contradictions
    assert apart.late == pytest.approx(-3.0, abs=0.3)
    assert apart.sentence.startswith("r comes ")
    assert " s earlier than the slope of psi" in apart.sentence
    assert ": psi may be a course over ground, or its clock be late; delay" in apart.sentence
    assert apart.sentence.endswith(" in psi would mend it")
    assert "delay = -" not in apart.sentence


def test_a_rate_that_a_sensor_smooths_is_one_doubt_that_neither_delay_nor_gain_mends(zigzag):
    """A display that damps, by a pole of 25 s."""
    one = zigzag["r"]
    pole = float(np.exp(-np.median(np.diff(one.t)) * 1e-9 / 25.0))
    slow = {**zigzag, "r": series("r", one.t, lfilter([1.0 - pole], [1.0, -pole], one.y))}
    [apart] = aligned(slow).contradictions
    assert 15.0 < apart.late < 25.0
    assert apart.sentence.endswith(", as of a sensor that smooths: the effect lag_r has it")


def circle(lag, rng):
    """A rate of turn [rad/s] behind a low-pass [s], and the heading [rad], each 0.5 s."""
    t = np.arange(0.0, 160.0, 0.5)
    turns = 0.06 * (1.0 - np.exp(-np.clip(t - 20.0, 0.0, None) / 4.0))
    share = 0.5 / (lag + 0.5)
    late = lfilter([share], [1.0, share - 1.0], turns)
    psi = np.cumsum(turns) * 0.5
    return late + 0.001 * rng.standard_normal(len(t)), psi + 0.002 * rng.standard_normal(len(t))


@pytest.mark.parametrize("lag", [2.0, 3.0, 6.5])
def test_a_turning_circle_tells_by_its_angle_how_late_the_rate_is(lag):
    """Of outsiders' circles the slope's parts are too few: 1.4 and 6.5 s were told of none."""
    rate, angle = circle(lag, np.random.default_rng(round(10 * lag)))
    known = np.ones(len(rate), dtype=bool)
    assert late_of(rate, angle, known, 0.5) == pytest.approx(lag, abs=0.3)
    assert late_of(1.02 * rate + 0.001, angle, known, 0.5) == pytest.approx(lag, abs=0.4)
    trial = Trial("circle", "fit", 0.5, {"r": rate, "psi": angle}, {"r": known, "psi": known})
    [finding] = [one for one in checks.of_trial(trial) if one.kind == "lag"]
    assert finding.evidence["lag"] == pytest.approx(lag, abs=0.3)
    assert "by the angle it lacks" in finding.sentence
    assert finding.mend == f"delay = {finding.evidence['lag']:.2g}"


def test_a_circle_with_sensors_in_time_is_told_of_none():
    for seed in range(10):
        rate, angle = circle(0.0, np.random.default_rng(seed))
        known = np.ones(len(rate), dtype=bool)
        assert abs(late_of(rate, angle, known, 0.5)) < 0.2
        trial = Trial("circle", "fit", 0.5, {"r": rate, "psi": angle}, {"r": known, "psi": known})
        assert [one for one in checks.of_trial(trial) if one.kind == "lag"] == []
