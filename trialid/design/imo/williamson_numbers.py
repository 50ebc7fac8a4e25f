"""What a Williamson turn of a record comes to: how near she is to her old track, going back."""

from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.recognition import Recognised
from trialid.design.imo.sailed_trial import Track
from trialid.design.imo.track_numbers import TrackReader

DEVIATION: Final = "deviation from the reciprocal course"
OFFSET: Final = "offset from the old track"
UNITS: Final = {DEVIATION: "rad", OFFSET: "m"}


def williamson_reader(one: Recognised, order: float, before: int) -> TrackReader | None:
    """What reads a Williamson turn from a track; None where she was never steady.

    Both numbers are positive to starboard, of the reciprocal course and of the old one: the
    deviation is of the mean heading while she keeps her new course, the offset the mean of her
    positions then. The old track is the line through the positions of the approach.

    Parameters
    ----------
    order
        When the rudder was first put over [s].
    before
        Samples of approach: a ship length.
    """
    if one.steady is None:
        return None
    first = max(one.execute - before, 0)
    out, back = one.execute - first, one.steady - first
    goal = np.pi * float(np.sign(one.rudder))

    def read(track: Track, t: Vector, late: float) -> dict[str, float]:
        start, going = _line(track, t, max(int(np.sum(t[:out] < order + late)), 2))
        old = float(np.arctan2(going[1], going[0]))
        course = float(np.mean(track["psi"][:out]))
        off = np.array([np.mean(track[n][back:]) for n in ("x", "y")]) - start
        return {
            DEVIATION: float(np.mean(track["psi"][back:])) - (course - goal),
            OFFSET: float(off[1] * np.cos(old) - off[0] * np.sin(old)),
        }

    return TrackReader(slice(first, one.end), order, UNITS, read)


def _line(track: Track, t: Vector, count: int) -> tuple[Vector, Vector]:
    """Mean place of the first samples, and the velocity along them; (2,) each."""
    both = np.column_stack([track[n][:count] for n in ("x", "y")])
    going = np.linalg.lstsq(np.vander(t[:count] - np.mean(t[:count]), 2), both, rcond=None)[0][0]
    return np.mean(both, axis=0), going
