"""Gaps of the rudder: short ones are passed, of long ones a stretch beside them is kept."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.alignment.input_gaps import LENGTHS, without_input_gaps
from trialid.identification.fit import identify
from trialid.identification.problem import Settings

SETTINGS = Settings(("Nv", "Nr", "Ndelta"), ("r", "phi"), nuisance=("initial_state",))
LONGEST = LENGTHS * 175.0 / 7.7


def trial_with_gap(begin, end, seed=1):
    """A zig-zag whose rudder is on a straight line from `begin` to `end` [s]."""
    trial = zigzag(10)
    trial = with_noise(trial, *white(np.random.default_rng(seed), trial.samples))
    known = (trial.t < begin) | (trial.t >= end)
    rudder = np.interp(trial.t, trial.t[known], trial.signals["delta"][known])
    return replace(
        trial,
        signals={**trial.signals, "delta": rudder},
        valid={**trial.valid, "delta": known},
    )


def test_a_short_gap_is_passed():
    trial = trial_with_gap(400.0, 400.0 + LONGEST - 1.0)
    assert without_input_gaps(trial, ["delta"], LONGEST) is trial


def test_a_long_gap_ends_the_stretch_and_says_which_window_is_left():
    trial = trial_with_gap(300.0, 400.0)
    part = without_input_gaps(trial, ["delta"], LONGEST)
    assert part.opening == 400.0
    assert part.start == trial.start + 400 * 10**9
    np.testing.assert_array_equal(part.signals["r"], trial.signals["r"][800:])
    assert part.valid["delta"].all()
    assert part.remarks[-1] == (
        "delta not recorded in [300.0, 399.5] s: only [400.0, 1200.0] s is used; "
        "for a trial of their own: window = [0.0, 299.5]"
    )


def test_gaps_of_what_does_not_steer_her_are_no_matter():
    trial = trial_with_gap(300.0, 400.0)
    assert without_input_gaps(trial, ["n"], LONGEST) is trial


def test_gaps_all_over_are_told_and_left():
    trial = trial_with_gap(300.0, 400.0)
    known = (trial.t // 100.0) % 2 == 0
    holed = replace(trial, valid={**trial.valid, "delta": known})
    kept = without_input_gaps(holed, ["delta"], LONGEST)
    assert kept.samples == trial.samples
    assert "it has gaps all over" in kept.remarks[-1]
    assert "[100.0, 199.5], [300.0, 399.5], [500.0, 599.5], ... s" in kept.remarks[-1]


@pytest.mark.parametrize("begin", [300.0, 460.0, 610.0])
def test_parameters_are_those_of_the_ship_beside_a_gap(begin):
    trial = trial_with_gap(begin, begin + 100.0, seed=int(begin))
    fit = identify([without_input_gaps(trial, ["delta"], LONGEST)], MODEL, SETTINGS)
    for name in SETTINGS.free:
        assert fit.value(name) == pytest.approx(MODEL.value(name), rel=0.12)


def test_a_straight_line_through_two_reversals_is_another_rudder():
    trial = trial_with_gap(460.0, 560.0, seed=460)
    kept, bridged = (
        identify([one], MODEL, SETTINGS)
        for one in (without_input_gaps(trial, ["delta"], LONGEST), trial)
    )
    assert bridged.eps_rmsn > 1.2 * kept.eps_rmsn


def test_ends_and_what_a_filter_takes_beside_a_short_gap_are_no_gaps():
    """At its ends nothing is simulated through; a low-pass hides five samples on each side."""
    trial = trial_with_gap(400.0, 400.0 + LONGEST + 4.5)
    assert without_input_gaps(trial, ["delta"], LONGEST) is trial
    ends = trial_with_gap(400.0, 401.0)
    known = (ends.t > 60.0) & (ends.t < 1100.0)
    ended = replace(ends, valid={**ends.valid, "delta": known})
    assert without_input_gaps(ended, ["delta"], LONGEST) is ended
