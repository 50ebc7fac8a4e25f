"""To which side a ship begins to turn when her rudder is first laid out of a straight course.

What she does later may tell nothing: a turning circle is one step of the rudder, and an unstable
ship turns against it for minutes. How she begins is the same for all of them.
"""

from typing import Final

import numpy as np

from trialid.alignment.agreement.turning import Turning
from trialid.arrays import Mask, Vector

LEAD: Final = 10
"""Samples that the rudder must lie still before it is laid."""

STILL, LAID, LEFT = 0.1, 0.5, 0.25
"""Shares of its first way by which a rudder lies still, is laid, and has left that side again."""

CLEAR: Final = 3.0
"""Times the most by which the rate of turn strayed before that it must then leave its mean: of 1200
records (`tests/grow/test_first_turn.py`: 60 ships, calm, in gusts, in a swell, by a drifting gyro)
1009 tell the side with it, all rightly. With half 1194 do, one of them wrongly, with twice 709."""


def first_turn(rudder: Vector, rate: Vector, both: Mask) -> Turning:
    """How she answers the rudder at its first way; sign 0.0 where that does not show.

    Parameters
    ----------
    rudder, rate
        On one clock; (N,).
    both
        Where both were measured; (N,).
    """
    nothing = Turning(0.0, 0.0, "")
    if len(rudder) <= 2 * LEAD or not both.all():
        return nothing
    off = rudder - np.median(rudder[:LEAD])
    begun, laid = (int(np.argmax(np.abs(off) >= x * np.abs(off).max())) for x in (STILL, LAID))
    if begun < LEAD:
        return nothing
    side = float(np.sign(off[laid]))
    gone = np.flatnonzero(side * off[laid:] < LEFT * side * off[laid])
    end = laid + int(gone[0]) if len(gone) else len(off)
    turned = rate - np.median(rate[:begun])
    strayed = float(np.abs(turned[:begun]).max())
    clear = begun + np.flatnonzero(np.abs(turned[begun:end]) > CLEAR * strayed)
    if not len(clear) or not strayed:
        return nothing
    sign = side * float(np.sign(turned[clear[0]]))
    seen = slice(0, min(2 * int(clear[0]) - begun + LEAD, end))
    correlation = float(np.corrcoef(off[seen], turned[seen])[0, 1])
    told = Turning(sign, correlation, "r, as it is first laid")
    return told if sign * correlation > 0.0 else nothing
