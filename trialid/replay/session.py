"""A replay from its first sample to its last: pace, keys, loop, and a log that grows."""

import math
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final, Protocol

from trialid.replay import clock
from trialid.replay.clock import Pace
from trialid.replay.follow import Follower
from trialid.replay.playback import Playback

CHUNK: Final = 256
"""Samples between two looks at the keys when there is no pace to keep."""

LONGEST_WAIT: Final = 0.05
"""Longest wait between two looks at the keys [s]."""

SEEK: Final = 10.0
"""Record that an arrow key moves by [s]."""

EARLY: Final = 1e-6
"""Share of a sample by which one may be played early: the rounding of the wall clock's sum."""

Show = Callable[[Playback, Pace, float], None]


class Time(Protocol):
    """A wall clock."""

    def now(self) -> float:
        """Seconds, of which only differences mean anything."""

    def wait(self, seconds: float) -> None:
        """Come back that much later."""


class WallClock:
    """The computer's own."""

    def now(self) -> float:
        """Seconds since some instant."""
        return time.monotonic()

    def wait(self, seconds: float) -> None:
        """Sleep."""
        time.sleep(seconds)


@dataclass(frozen=True)
class Wishes:
    """How to play: seconds of record in a second, from where [s], over and over."""

    speed: float = 1.0
    start: float = 0.0
    loop: bool = False


def play(
    playback: Playback,
    wishes: Wishes,
    time: Time,
    show: Show,
    keys: Callable[[], Iterable[str]] = tuple,
    follower: Follower | None = None,
) -> Playback:
    """Play to the end, or until `q`; what was played.

    Parameters
    ----------
    show
        Told of the playback, its pace and the time [s] after every step.
    keys
        What was pressed since the last look: `space`, `left`, `right`, `q`.
    follower
        Reads a log that grows; the end is where it grows no more.
    """
    period = playback.trial.period
    pace = Pace(wishes.speed, wishes.start, time.now())
    playback.go_to(_sample(wishes.start, period))
    while True:
        now = time.now()
        for key in keys():
            if key == "q":
                return playback
            pace = _pressed(pace, key, now, playback)
            playback.go_to(min(_sample(pace.position, period), playback.available))
        playback = _read_on(playback, follower, now)
        playback.go_to(_next(playback, pace, now))
        show(playback, pace, now)
        ended = pace.running and playback.at >= playback.available
        if ended and playback.growing:
            pace = clock.seek(pace, now, _position(playback))
        elif ended and wishes.loop:
            pace = clock.seek(pace, now, wishes.start)
            playback.go_to(_sample(wishes.start, period))
        elif ended:
            return playback
        _wait(time, pace, playback)


def _next(playback: Playback, pace: Pace, now: float) -> int:
    """Samples that are to be played by now."""
    if not pace.running:
        return playback.at
    position = clock.position_at(pace, now)
    if math.isinf(position):
        return min(playback.at + CHUNK, playback.available)
    return min(_sample(position, playback.trial.period), playback.available)


def _sample(position: float, period: float) -> int:
    """Samples played where the replay stands at a position: the one at zero is the first."""
    return max(math.floor(position / period + EARLY), -1) + 1


def _position(playback: Playback) -> float:
    return max(playback.at - 1, 0) * playback.trial.period


def _pressed(pace: Pace, key: str, now: float, playback: Playback) -> Pace:
    """The pace after a key; it goes on from the sample that is shown."""
    here = min(clock.position_at(pace, now), _position(playback))
    if key == "space":
        return clock.toggle(pace, now, here)
    if key in {"left", "right"}:
        step = SEEK if key == "right" else -SEEK
        end = max(playback.available - 1, 0) * playback.trial.period
        return clock.seek(pace, now, min(max(here + step, 0.0), end))
    return pace


def _read_on(playback: Playback, follower: Follower | None, now: float) -> Playback:
    """The playback with what the log has gained, and whether it will gain more."""
    if follower is None or not playback.growing:
        return playback
    trial, over = follower.poll(now)
    if trial is None and not over:
        return playback
    return playback.grown(trial or playback.trial, growing=not over)


def _wait(time: Time, pace: Pace, playback: Playback) -> None:
    """Wait for the next sample, or for a key, or for the log."""
    if pace.running and math.isinf(pace.speed) and playback.at < playback.available:
        return
    if playback.at >= playback.available:
        time.wait(LONGEST_WAIT)
        return
    until = clock.due(pace, playback.at * playback.trial.period) - time.now()
    time.wait(min(max(until, 0.0), LONGEST_WAIT))
