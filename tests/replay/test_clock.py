"""Pace, pause, seek and loop, by a wall clock that jumps and is late."""

import math

import numpy as np
import pytest

from trialid.replay import clock
from trialid.replay.clock import Pace
from trialid.replay.session import SEEK, Wishes, play

PERIOD = 0.5


class FakeTime:
    """A wall clock that comes back late from every wait, by what is drawn."""

    def __init__(self, late=0.004, seed=1):
        self.t, self.late, self.draw = 100.0, late, np.random.default_rng(seed)

    def now(self):
        return self.t

    def wait(self, seconds):
        self.t += seconds + self.late * self.draw.uniform()


class FakeTrial:
    period = PERIOD
    duration = 60.0


class FakePlayback:
    """So many samples and nothing in them."""

    def __init__(self, samples):
        self.trial, self.available, self.at, self.growing = FakeTrial(), samples, 0, False

    def go_to(self, samples):
        self.at = min(max(samples, 0), self.available)


def played(wishes, samples=121, keys=tuple, late=0.004):
    """When each sample was first shown, and the whole course of samples shown."""
    time, first, course = FakeTime(late), {}, []

    def show(playback, pace, now):
        first.setdefault(playback.at - 1, now - 100.0)
        course.append((now - 100.0, playback.at - 1, pace.running))

    play(FakePlayback(samples), wishes, time, show, keys)
    return first, course


@pytest.mark.parametrize("speed", [1.0, 10.0])
def test_pace_is_kept_however_late_each_step_comes(speed):
    samples = round(60.0 * speed / PERIOD) + 1
    first, _ = played(Wishes(speed), samples)
    assert samples - 1 in first
    for sample, when in first.items():
        assert when >= sample * PERIOD / speed - 1e-5
        assert when - sample * PERIOD / speed <= 0.06
    assert first[samples - 1] == pytest.approx(60.0, rel=0.01)


def test_no_sample_is_left_out_by_the_numbers_when_a_step_is_late():
    first, _ = played(Wishes(10.0), 400, late=0.4)
    assert max(first) == 399
    assert first[399] == pytest.approx(399 * PERIOD / 10.0, abs=0.5)


def test_a_pause_is_no_part_of_the_record():
    time_at = iter([*[()] * 100, ("space",), *[()] * 200, ("space",), *[()] * 100000])
    first, course = played(Wishes(1.0), 61, keys=lambda: next(time_at))
    paused = [t for t, _, running in course if not running]
    assert paused
    length = paused[-1] - paused[0]
    shown = {sample for _, sample, running in course if not running}
    assert len(shown) == 1
    assert first[60] == pytest.approx(60 * PERIOD + length, abs=0.7)  # goes on with its sample


def test_seeking_moves_by_ten_seconds_either_way_and_stays_inside():
    pressed = iter([(), ("right",), (), ("left", "left", "left"), *[()] * 100000])
    _, course = played(Wishes(1.0), 121, keys=lambda: next(pressed))
    samples = [sample for _, sample, _ in course[:5]]
    assert samples[0] == 0
    assert samples[1] == round(SEEK / PERIOD)
    assert samples[3] == 0
    assert course[-1][1] == 120


def test_a_loop_begins_again_at_its_start_and_q_ends_it():
    count = 0

    def keys():
        nonlocal count
        count += 1
        return ("q",) if count > 3000 else ()

    _, course = played(Wishes(10.0, start=5.0, loop=True), 41, keys=keys)
    samples = [sample for _, sample, _ in course]
    assert min(samples) == 10
    starts = [i for i in range(1, len(samples)) if samples[i] < samples[i - 1]]
    assert len(starts) > 3
    rounds = np.diff([course[i][0] for i in starts])
    assert rounds == pytest.approx(1.5, abs=0.15)  # 15 s of record at 10 times


def test_as_fast_as_possible_waits_for_nothing():
    first, _ = played(Wishes(math.inf), 5000)
    assert max(first.values()) == 0.0


def test_due_is_the_inverse_of_at():
    pace = Pace(7.0, 3.0, 50.0)
    assert clock.position_at(pace, clock.due(pace, 44.0)) == pytest.approx(44.0)
    assert clock.due(clock.toggle(pace, 51.0, 10.0), 44.0) == math.inf
