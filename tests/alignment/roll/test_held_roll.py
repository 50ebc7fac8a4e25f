"""A heel that is held and let go is found by the roll alone, and no free swing is taken for one."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_decays import drawn

from trialid.alignment.held_roll import held_roll, released_at, without_held_roll

SEEDS = range(700, 760)


def test_of_sixty_that_are_held_most_are_told_and_none_is_cut_far_off():
    late = []
    for seed in SEEDS:
        trial, release = drawn(seed, held=True)
        if (held := held_roll(trial)) is not None:
            late.append(trial.t[held.release] - release * trial.period)
    assert len(late) >= 54
    assert np.median(late) >= 0.0
    assert max(late) < 1.2  # a tenth of the longer period


def test_of_sixty_that_are_held_for_a_fifth_of_a_period_most_are_told():
    """3 s of 14.5 were taken for a delay of the roll, and for a tank that damps it."""
    told = 0
    for seed in SEEDS:
        trial, release = drawn(seed, held=True)
        swing = trial.signals["phi"][release:] - np.median(trial.signals["phi"][-50:])
        period = 4 * int(np.argmax(swing * np.sign(swing[0]) < 0.0))
        told += held_roll(trial.part(release - period // 5, trial.samples, "")) is not None
    assert told >= 54


def test_of_sixty_that_are_free_none_is_said_to_be_held():
    assert all(held_roll(drawn(seed, held=False)[0]) is None for seed in SEEDS)


def test_what_lies_before_the_release_is_left_out_and_said():
    trial, release = drawn(7, held=True, r=0.0)
    part = without_held_roll(trial)
    cut = trial.samples - part.samples
    assert release <= cut <= release + 6
    np.testing.assert_array_equal(part.signals["r"], trial.signals["r"][cut:])
    assert part.opening == cut * trial.period
    at = released_at(trial, held_roll(trial))
    assert f"she was held; begin the window at {at:.1f} s: only [" in part.remarks[-1]


def test_a_swing_from_there_on_is_left_as_it_is():
    part = without_held_roll(drawn(7, held=True)[0])
    assert without_held_roll(part) is part


def test_a_rudder_that_goes_over_heels_her_and_no_hand():
    trial, release = drawn(7, held=True, delta=0.0)
    assert held_roll(trial) is not None
    rudder = np.where(np.arange(trial.samples) < release, 0.3, 0.0)
    assert held_roll(replace(trial, signals={**trial.signals, "delta": rudder})) is None


@pytest.mark.parametrize(
    ("name", "size", "moves", "held"),
    [
        ("rudder_port", 0.2, True, False),
        ("rudder_port", 0.02, True, True),
        ("rudder_port", 0.2, False, True),
        ("thruster_bow_order", 400.0, True, False),
        ("thruster_bow_order", 400.0, False, True),
    ],
)
def test_an_actuator_with_a_name_of_its_own_heels_her_where_it_works(name, size, moves, held):
    """Of a ferry with two rudders three quarters of her zig-zags were left out."""
    trial, _ = drawn(7, held=True, delta=0.0)
    order = np.sign(np.sin(2.0 * np.pi * np.arange(trial.samples) / (trial.samples / 3.0)))
    noise = 0.005 * size * np.random.default_rng(3).standard_normal(trial.samples)
    works = size * (order if moves else 1.0) + noise
    moved = replace(trial, signals={**trial.signals, name: works})
    assert (held_roll(moved) is not None) == held


def test_a_steady_turn_heels_her_and_no_hand():
    trial, release = drawn(7, held=True, r=0.0)
    turns = np.where(np.arange(trial.samples) < release, 0.5, 0.0)
    assert held_roll(replace(trial, signals={**trial.signals, "r": turns})) is None


def test_a_straight_line_through_a_gap_is_no_hold():
    trial, release = drawn(7, held=True)
    known = np.ones(trial.samples, np.bool_)
    known[2 : release - 1] = False
    assert held_roll(replace(trial, valid={"phi": known})) is None
