"""What a stop of a record comes to: how far she goes, along her track and ahead, and how long."""

from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.recognition import Recognised
from trialid.design.imo.sailed_trial import Track
from trialid.design.imo.stops import WAY
from trialid.design.imo.track_numbers import TrackReader
from trialid.errors import DesignError

UNITS: Final = {"head reach": "m", "track reach": "m", "lateral deviation": "m", "time": "s"}
SMOOTHED: Final = 1.0
"""Ship lengths, of time at approach speed, over which a parabola takes the noise off: summed from
fix to fix, a track of a ship that hardly moves would be as long as its noise."""


def stop_reader(one: Recognised, order: float, clock: int, samples: int) -> TrackReader | None:
    """What reads a stop from a track; None where it was broken off.

    From the order to a tenth of the approach speed, by the log where there is one, else by the
    track. The head reach is ahead on the old course, the lateral deviation to starboard of it, the
    track reach along the track.

    Parameters
    ----------
    order
        When the shaft left its revolutions ahead [s].
    clock, samples
        Samples in a ship length, and of the trial.
    """
    if one.remark:
        return None
    first, more = max(one.execute - clock, 0), max(clock, (one.end - one.execute) // 2)
    last = min(one.end + more, samples)  # the model may take half as long again
    begin, window = one.execute - first, 2 * max(round(SMOOTHED * clock / 2.0), 2) + 1
    if last - first < window:
        return None
    from scipy.signal import savgol_filter  # half a second, which few runs have a use for

    def read(track: Track, t: Vector, late: float) -> dict[str, float]:
        smooth = {n: savgol_filter(x, window, 2) for n, x in track.items()}
        way = smooth.get("u", _way(smooth, t))
        end = _stopped(way, t, begin)
        return _reaches(smooth, t, (order + late, end), float(np.mean(track["psi"][:begin])))

    return TrackReader(slice(first, last), order, UNITS, read)


def _way(track: Track, t: Vector) -> Vector:
    """The speed ahead by a track [m/s]; (N,)."""
    north, east = (np.gradient(track[n], t) for n in ("x", "y"))
    return np.asarray(north * np.cos(track["psi"]) + east * np.sin(track["psi"]))


def _stopped(way: Vector, t: Vector, begin: int) -> float:
    """When the way first falls to a tenth of what it was before the order [s]."""
    level = WAY * float(np.mean(way[: max(begin, 1)]))
    below = np.flatnonzero(way[begin:] <= level)
    if not len(below) or below[0] == 0:
        raise DesignError("she does not come to a tenth of her speed in this trial")
    k = begin + int(below[0])
    share = (way[k - 1] - level) / (way[k - 1] - way[k])
    return float(t[k - 1] + share * (t[k] - t[k - 1]))


def _reaches(track: Track, t: Vector, ends: tuple[float, float], course: float) -> dict[str, float]:
    inner = t[(t > ends[0]) & (t < ends[1])]
    at = np.array([ends[0], *inner, ends[1]])
    x, y = (np.interp(at, t, track[n]) for n in ("x", "y"))
    north, east = x[-1] - x[0], y[-1] - y[0]
    return {
        "head reach": float(north * np.cos(course) + east * np.sin(course)),
        "track reach": float(np.sum(np.hypot(np.diff(x), np.diff(y)))),
        "lateral deviation": float(east * np.cos(course) - north * np.sin(course)),
        "time": ends[1] - ends[0],
    }
