"""Pace over a minute of the wall clock: a study, because it takes the minutes."""

import time

import pytest
from test_clock import PERIOD, FakePlayback

from trialid.replay.session import Wishes, play


class WallClock:
    """The real one."""

    now = staticmethod(time.monotonic)
    wait = staticmethod(time.sleep)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("speed", [1.0, 10.0])
def test_pace_within_one_per_cent_over_a_minute(speed):
    """By the clock on the wall, from the first sample to the last, and at every sample between."""
    samples = round(60.0 * speed / PERIOD) + 1
    shown = {}

    def show(playback, pace, now):
        shown.setdefault(playback.at - 1, time.monotonic())

    play(FakePlayback(samples), Wishes(speed), WallClock(), show)
    taken = shown[samples - 1] - shown[0]
    late = max(t - shown[0] - k * PERIOD / speed for k, t in shown.items())
    print(f"\n{speed:g} times: {taken:.3f} s for 60 s, at most {1e3 * late:.1f} ms late")
    assert taken == pytest.approx(60.0, rel=0.01)
    assert late < 0.6
