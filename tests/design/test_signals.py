import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from trialid.design.signals import (
    ALPHA,
    binary,
    collisions,
    lines,
    multisine,
    roll_lines,
    steps,
)


def test_the_papers_integers_collide_nowhere():
    """Eq. 18 and 19 at 80 roll periods: no second-order product of a line falls on a line."""
    made = lines(1200.0, 2 * np.pi / 15.0)
    assert made.numbers == (117, 80, 51, 33, 19, 3, 1)
    assert made.merged == ()
    assert made.collisions == ()


def test_rounding_for_another_duration_may_lose_it():
    """Of whole ratios from 20 to 160 most keep the property; 30, 40 and 81 do not."""
    free = [n for n in range(20, 161) if not lines(n * 15.0, 2 * np.pi / 15.0).collisions]
    assert len(free) == 113
    assert not {30, 40, 81} & {*free}
    assert 80 in free


def test_s175_in_twenty_minutes_has_three_collisions():
    assert len(lines(1200.0, 2 * np.pi * 41.6 / 1200.0).collisions) == 3


def test_lines_that_merge_are_said():
    made = lines(120.0, 2 * np.pi / 15.0)
    assert made.merged == (3,)
    assert len(made.numbers) == 6
    assert roll_lines(1200.0, 2 * np.pi / 15.0) == ALPHA


@given(st.sets(st.integers(1, 60), min_size=2, max_size=7))
@settings(max_examples=60, deadline=None, derandomize=True)
def test_collisions_are_what_squaring_shows(numbers):
    """A line is hit exactly where the square of the other cosines has energy."""
    n = 1024
    t = 2 * np.pi * np.arange(n) / n
    listed = {k for _, _, k in collisions(sorted(numbers))}
    square = np.zeros(n // 2 + 1)
    for i in numbers:
        for j in numbers:
            square += np.abs(np.fft.rfft(np.cos(i * t) * np.cos(j * t)))
    assert listed == {k for k in numbers if square[k] > 1.0}


def test_a_multisine_by_hand():
    t = np.linspace(0.0, 30.0, 61)
    wave = multisine(t, 0.2, [1.0, 0.5], [0.3, 1.1], [0.1, -0.4])
    by_hand = 0.2 * (np.sin(0.3 * t + 0.1) + 0.5 * np.sin(1.1 * t - 0.4))
    np.testing.assert_allclose(wave, by_hand, atol=1e-15)


def test_a_binary_signal_is_never_amidships():
    order = np.sin(np.arange(300) / 7.0)
    found = binary(order, 0.3, 5)
    np.testing.assert_allclose(np.abs(found), 0.3)
    assert np.all(np.flatnonzero(np.diff(found)) % 5 == 4)
    assert np.all(binary(np.zeros(9), 0.3, 1) == 0.0)


def test_steps_need_no_order_before_the_first():
    t = np.arange(0.0, 5.0, 0.5)
    np.testing.assert_array_equal(
        steps(t, [1.0, 2.5], [0.1, 0.0]), [0, 0, 0.1, 0.1, 0.1, 0, 0, 0, 0, 0]
    )


@pytest.mark.parametrize("hold", [1, 3])
def test_a_binary_signal_begins_on_the_side_that_comes(hold):
    assert binary(np.array([0.0, 0.0, 0.0, -1.0, 1.0, 1.0]), 1.0, hold)[0] == -1.0
