"""The pace of a replay: where in the record it stands at a moment of the wall clock.

The position is reckoned from the last change of pace, never summed up from step to step, so that
it does not drift however long it runs and however late a step comes.
"""

import math
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Pace:
    """How a replay runs since its last change.

    Parameters
    ----------
    speed
        Seconds of record in a second; infinite for as fast as possible.
    position
        Where in the record it stood at the last change [s].
    since
        When that was, by the wall clock [s].
    """

    speed: float
    position: float
    since: float
    running: bool = True


def position_at(pace: Pace, now: float) -> float:
    """Where in the record a replay stands [s].

    >>> position_at(Pace(10.0, 5.0, 100.0), 102.0)
    25.0
    """
    if not pace.running:
        return pace.position
    return math.inf if math.isinf(pace.speed) else pace.position + (now - pace.since) * pace.speed


def due(pace: Pace, position: float) -> float:
    """When a place of the record is reached [s, wall clock]; never while it is paused.

    >>> due(Pace(10.0, 5.0, 100.0), 25.0)
    102.0
    """
    if not pace.running:
        return math.inf
    return pace.since + (position - pace.position) / pace.speed


def toggle(pace: Pace, now: float, position: float) -> Pace:
    """Paused if it was running, else running on from where it stands."""
    return replace(pace, position=position, since=now, running=not pace.running)


def seek(pace: Pace, now: float, position: float) -> Pace:
    """At another place, running or paused as before."""
    return replace(pace, position=position, since=now)
